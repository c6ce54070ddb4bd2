"""The strategy page: choose one, try it, make a program by hand or import it, set the correction."""

from collections.abc import Mapping

import httpx
import pytest

from app.tracker.programs.examples import ALEXANDRU_TABLE_3
from app.tracker.programs.step_table import to_table
from app.tracker.settings.stepped import ProgramStep, StepFrame
from app.tracker.settings.strategy import Continuous, Interval, IntervalAim, Stepped
from tests.fakes import FakeMachine
from tests.web.filled import filled

PAGE = "/trackers/T1/strategy"
HYBRID = {"threshold": "200", "gain": "1", "bound": "1.5", "decay": "0"}


def kept(machine: FakeMachine) -> object:
    return machine.orders[-1].command.config.strategy


async def sent_program(client: httpx.AsyncClient, typed: Mapping[str, str | list[str]]) -> httpx.Response:
    """Send the form of the step program with this typed."""
    path = f"{PAGE}/program"
    return await client.post(path, data=await filled(client, PAGE, typed, action=path))


async def test_the_page_is_reached_from_the_settings_and_explains_each_strategy(
    client: httpx.AsyncClient,
) -> None:
    assert PAGE in (await client.get("/trackers/T1/settings")).text
    page = (await client.get(PAGE)).text
    for word in ("Deadband", "Deadband in encoder counts", "Continuous", "Interval", "Step program"):
        assert f"<b>{word}</b>" in page


async def test_a_strategy_is_saved_and_shown_again(client: httpx.AsyncClient, machine: FakeMachine) -> None:
    await client.post(
        PAGE, data=await filled(client, PAGE, {"kind": "interval", "minutes": "20", "aim": "now"})
    )
    assert kept(machine) == Interval(20, IntervalAim.NOW)
    assert 'value="interval" required checked' in (await client.get(PAGE)).text
    await client.post(PAGE, data=await filled(client, PAGE, {"kind": "continuous"}))
    assert kept(machine) == Continuous()


@pytest.mark.parametrize(
    ("typed", "sentence"),
    [
        ({"kind": "interval", "minutes": "soon"}, "Minutes: type a number"),
        ({"kind": "deadband", "deadband": "44"}, "Deadband must be between 0.02 and 10"),
        (
            {"kind": "encoder-deadband", "counts": "10", "counts_per_turn": "36"},
            "between 0.02 and 10 degrees",
        ),
        ({"kind": "stepped"}, "save a program in the table below first"),
        ({"kind": "zigzag"}, "choose one from the list"),
    ],
)
async def test_what_cannot_be_comes_back_as_it_was_typed(
    client: httpx.AsyncClient, machine: FakeMachine, typed: dict[str, str], sentence: str
) -> None:
    before = len(machine.orders)
    answer = await client.post(PAGE, data=await filled(client, PAGE, typed))
    assert answer.status_code == 422
    assert sentence in answer.text
    assert len(machine.orders) == before


async def test_a_program_made_by_hand_is_saved(client: httpx.AsyncClient, machine: FakeMachine) -> None:
    head = {"program_name": "Three places", "base": "clock", "offset": "3", "angles": "horizon"}
    rows = {
        "at": ["08:00", "12:30", "16:00", ""],
        "first": ["110", "180", "250", ""],
        "second": ["30", "", "30", ""],
    }
    answer = await client.post(f"{PAGE}/program", data=head | rows, headers={"HX-Request": "true"})
    assert (answer.status_code, answer.text) == (204, ""), "the form must not be swapped for a sentence"
    again = (await client.get(answer.headers["HX-Redirect"])).text
    assert "Three places is saved; the tracker now uses it." in again
    assert 'value="stepped" required checked' in again
    strategy = kept(machine)
    assert isinstance(strategy, Stepped)
    assert strategy.program.steps[1] == ProgramStep(12.5, 180.0, None)
    assert (strategy.program.frame, strategy.program.utc_offset_h) == (StepFrame.HORIZON, 3.0)
    assert (await client.get(f"{PAGE}/program.csv")).text == "\ufeff" + to_table(strategy.program)


async def test_a_wrong_row_is_named_and_what_was_typed_stays(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    before = len(machine.orders)
    rows = {"at": ["08:00", "07:00"], "first": ["110", "north"], "second": ["30", "30"]}
    answer = await sent_program(client, {"program_name": "P"} | rows)
    assert answer.status_code == 422
    assert "Row 2, azimuth_deg: &#39;north&#39; is not a number." in answer.text
    assert 'value="north"' in answer.text
    assert len(machine.orders) == before


@pytest.mark.parametrize(
    ("path", "typed"),
    [
        (PAGE, {"kind": "deadband", "deadband": "0.03"}),
        (f"{PAGE}/program", {"program_name": "P", "at": "08:00", "first": "110", "second": "0.03"}),
        (f"{PAGE}/hybrid", {"bound": "0.03", "threshold": "200", "gain": "1", "decay": "0"}),
    ],
)
async def test_what_the_machine_refuses_comes_back_in_the_form(
    client: httpx.AsyncClient,
    machine: FakeMachine,
    path: str,
    typed: dict[str, str],
) -> None:
    machine.refusal = "The tolerance must not exceed the deadband."
    answer = await client.post(
        path, data=await filled(client, PAGE, typed, action=path), headers={"HX-Request": "true"}
    )
    assert answer.status_code == 422
    assert answer.text.lstrip().startswith("<form")
    assert "The tolerance must not exceed the deadband." in answer.text
    assert 'value="0.03"' in answer.text


async def test_the_table_is_filled_from_csv_an_example_or_with_rows(client: httpx.AsyncClient) -> None:
    table = to_table(ALEXANDRU_TABLE_3)
    imported = await sent_program(client, {"do": "import", "table": table})
    assert 'value="07:52:48"' in imported.text
    example = await sent_program(client, {"do": "example", "example": "alexandru-table-3"})
    assert 'value="07:52:48"' in example.text
    assert (await client.get(PAGE)).text.count('name="at"') == 3
    more = await sent_program(client, {"do": "rows", "at": ["06:00"], "first": ["1"], "second": [""]})
    assert more.text.count('name="at"') == 4
    wrong = await sent_program(client, {"do": "import", "table": "when,where"})
    assert wrong.status_code == 422
    assert "The first row must name three columns" in wrong.text


async def test_the_correction_is_set(client: httpx.AsyncClient, machine: FakeMachine) -> None:
    typed = await filled(client, PAGE, {"enabled": "yes", "cloud": "25"} | HYBRID, action=f"{PAGE}/hybrid")
    await client.post(f"{PAGE}/hybrid", data=typed)
    hybrid = machine.orders[-1].command.config.hybrid
    assert (hybrid.enabled, hybrid.threshold_wm2, hybrid.bound_deg) == (True, 200.0, 1.5)
    assert hybrid.simulated.cloud == 0.25
    assert (await client.post(f"{PAGE}/hybrid", data=typed | {"bound": "90"})).status_code == 422


async def test_the_live_page_shows_program_and_correction_of_the_tracker_that_has_them(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    plain = (await client.get("/trackers/T1")).text
    assert "hybrid.computed" not in plain
    assert "program.step" not in plain
    await client.post(
        f"{PAGE}/hybrid",
        data=await filled(client, PAGE, {"enabled": "yes"} | HYBRID, action=f"{PAGE}/hybrid"),
    )
    rows = {"program_name": "Noon", "at": ["06:00", "12:00"], "first": ["120", "180"], "second": ["30", "60"]}
    await client.post(
        f"{PAGE}/program", data=await filled(client, PAGE, action=f"{PAGE}/program", typed=rows)
    )
    live = (await client.get("/trackers/T1")).text
    for part in ("computed", "correction", "sum"):
        assert f'data-live="hybrid.{part}.azimuth_deg"' in live
        assert f'data-live="hybrid.{part}.elevation_deg"' in live
    assert 'Noon: step <span class="value-live" data-live="program.step"' in live


async def test_today_is_drawn_with_what_it_costs(client: httpx.AsyncClient) -> None:
    part = (await client.get(f"{PAGE}/day", params={"kind": "interval", "minutes": "60"})).text
    assert "Greatest error" in part
    assert part.count("<svg") >= 2
    assert "hour of the day at the site" in part
