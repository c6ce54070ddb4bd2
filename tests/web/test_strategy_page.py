"""The strategy page: choose one, try it, make a program by hand or import it, set the correction."""

import httpx
import pytest

from app.tracker.programs.examples import ALEXANDRU_TABLE_3
from app.tracker.programs.step_table import to_table
from app.tracker.settings.stepped import ProgramStep, StepFrame
from app.tracker.settings.strategy import Interval, IntervalAim, Stepped
from tests.fakes import FakeMachine
from tests.web.filled import filled

PAGE = "/trackers/T1/strategy"
PROGRAM, HYBRID = f"{PAGE}/program", f"{PAGE}/hybrid"
HTMX = {"HX-Request": "true"}
CORRECTION = {"enabled": "yes", "cloud": "25", "threshold": "200", "gain": "1", "bound": "1.5", "decay": "0"}


def kept(machine: FakeMachine) -> object:
    return machine.orders[-1].command.config.strategy


async def sent(client: httpx.AsyncClient, action: str, **typed: str | list[str]) -> httpx.Response:
    """Send one of the forms with this typed."""
    form = await filled(client, PAGE, typed, action=action)
    return await client.post(action, data=form, headers=HTMX)


async def test_a_strategy_is_saved_and_shown_again(client: httpx.AsyncClient, machine: FakeMachine) -> None:
    await sent(client, PAGE, kind="interval", minutes="20", aim="now")
    assert kept(machine) == Interval(20, IntervalAim.NOW)
    assert 'value="interval" required checked' in (await client.get(PAGE)).text


@pytest.mark.parametrize(
    ("typed", "sentence"),
    [
        ({"kind": "interval", "minutes": "soon"}, "Minutes: type a number"),
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
    answer = await sent(client, PAGE, **typed)
    assert answer.status_code == 422
    assert sentence in answer.text
    assert not machine.orders


async def test_a_program_made_by_hand_is_saved(client: httpx.AsyncClient, machine: FakeMachine) -> None:
    head = {"program_name": "Three places", "base": "clock", "offset": "3", "angles": "horizon"}
    rows = {
        "at": ["08:00", "12:30", "16:00", ""],
        "first": ["110", "180", "250", ""],
        "second": ["30", "", "30", ""],
    }
    answer = await client.post(PROGRAM, data=head | rows, headers=HTMX)
    assert (answer.status_code, answer.text) == (204, ""), "the form must not be swapped for a sentence"
    again = (await client.get(answer.headers["HX-Redirect"])).text
    assert "Three places is saved; the tracker now uses it." in again
    assert 'value="stepped" required checked' in again
    strategy = kept(machine)
    assert isinstance(strategy, Stepped)
    assert strategy.program.steps[1] == ProgramStep(12.5, 180.0, None)
    assert (strategy.program.frame, strategy.program.utc_offset_h) == (StepFrame.HORIZON, 3.0)
    assert (await client.get(f"{PAGE}/program.csv")).text == "\ufeff" + to_table(strategy.program)
    live = (await client.get("/trackers/T1")).text
    assert 'Three places: step <span class="value-live" data-live="program.step"' in live


async def test_a_wrong_row_is_named_and_what_was_typed_stays(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    rows = {"at": ["08:00", "07:00"], "first": ["110", "north"], "second": ["30", "30"]}
    answer = await sent(client, PROGRAM, program_name="P", **rows)
    assert answer.status_code == 422
    assert "Row 2, azimuth_deg: &#39;north&#39; is not a number." in answer.text
    assert 'value="north"' in answer.text
    assert not machine.orders


@pytest.mark.parametrize(
    ("action", "typed"),
    [
        (PAGE, {"kind": "deadband", "deadband": "0.03"}),
        (PROGRAM, {"program_name": "P", "at": "08:00", "first": "110", "second": "0.03"}),
        (HYBRID, CORRECTION | {"bound": "0.03"}),
    ],
)
async def test_what_the_machine_refuses_comes_back_in_the_form(
    client: httpx.AsyncClient, machine: FakeMachine, action: str, typed: dict[str, str]
) -> None:
    machine.refusal = "The tolerance must not exceed the deadband."
    answer = await sent(client, action, **typed)
    assert answer.status_code == 422
    assert answer.text.lstrip().startswith("<form")
    assert "The tolerance must not exceed the deadband." in answer.text
    assert 'value="0.03"' in answer.text


async def test_the_table_is_filled_from_csv_an_example_or_with_rows(client: httpx.AsyncClient) -> None:
    imported = await sent(client, PROGRAM, do="import", table=to_table(ALEXANDRU_TABLE_3))
    assert "Imported. Check the program, then save it." in imported.text
    assert 'value="07:52:48"' in imported.text
    example = await sent(client, PROGRAM, do="example", example="alexandru-table-3")
    assert 'value="07:52:48"' in example.text
    more = await sent(client, PROGRAM, do="rows", at=["06:00"], first=["1"], second=[""])
    assert more.text.count('name="at"') == 4


async def test_the_correction_is_set_and_shown_live(client: httpx.AsyncClient, machine: FakeMachine) -> None:
    assert "hybrid.computed" not in (await client.get("/trackers/T1")).text
    await sent(client, HYBRID, **CORRECTION)
    hybrid = machine.orders[-1].command.config.hybrid
    assert (hybrid.enabled, hybrid.threshold_wm2, hybrid.bound_deg) == (True, 200.0, 1.5)
    assert hybrid.simulated.cloud == 0.25
    live = (await client.get("/trackers/T1")).text
    for part in ("computed", "correction", "sum"):
        assert f'data-live="hybrid.{part}.elevation_deg"' in live


async def test_today_is_drawn_with_what_it_costs(client: httpx.AsyncClient) -> None:
    part = (await client.get(f"{PAGE}/day", params={"kind": "interval", "minutes": "60"})).text
    assert "Greatest error" in part
    assert part.count("<svg") >= 2
