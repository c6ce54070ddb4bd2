"""Tables as spreadsheets save them: read right, or refused with the row; what is exported comes back."""

from datetime import timedelta
from html import unescape
from itertools import pairwise

import httpx
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from app.base.names import tidy, unseen
from app.tracker.programs.step_table import from_table, to_table
from app.tracker.settings.stepped import ProgramStep, StepFrame, StepProgram, TimeBase
from app.tracker.settings.strategy import Stepped
from app.tracker.values.file_table import read_table
from app.tracker.weather.weather_day import read_steps
from tests.fakes import FakeMachine
from tests.golden.table import rows
from tests.web.filled import filled

ROWS = rows("world/tables.csv")
PROGRAMS = [row for row in ROWS if row["entrance"] == "program"]
WEATHERS = [row for row in ROWS if row["entrance"] == "weather"]
API = "/api/v1/trackers/T1/program.csv"
PAGE = "/trackers/T1/strategy"
HOUR = {"tracker_id": "T1", "start": "2027-06-21T09:00:00+03:00", "end": "2027-06-21T10:00:00+03:00"}
TYPED = {"tracker": "T1", "date": "2027-06-21", "mode": "dual", "azimuth": "180", "elevation": "45"}
NAMES = (
    "Three places",
    "Morning, noon; evening",
    'Say "noon"',
    "# 1",
    " outer spaces ",
    "Güneş, 天气",
    "=1+1",
    "sep=;",
    "a\N{EN DASH}b,",
    '"',
)


def named(row: dict[str, str]) -> str:
    return f"{row['text'][-40:]} {row['saved']}"


def steps_of(program: StepProgram) -> str:
    return "; ".join(
        " ".join(map(_shown, (one.from_h, one.first_deg, one.second_deg))) for one in program.steps
    )


def _shown(value: float | None) -> str:
    return "-" if value is None else f"{value:g}"


@pytest.mark.parametrize("row", PROGRAMS, ids=named)
async def test_the_api_takes_a_program(
    client: httpx.AsyncClient, machine: FakeMachine, row: dict[str, str]
) -> None:
    before = len(machine.orders)
    answer = await client.put(API, content=row["text"].encode(row["saved"]))
    if row["refusal"]:
        assert answer.status_code == 422
        assert row["refusal"] in answer.json()["detail"]
        assert len(machine.orders) == before
        return
    assert answer.status_code == 200, answer.text
    strategy = machine.trackers["T1"].config.strategy
    assert isinstance(strategy, Stepped)
    assert steps_of(strategy.program) == row["value"]


@pytest.mark.parametrize("row", [row for row in PROGRAMS if "UTF-8" not in row["refusal"]], ids=named)
async def test_the_page_fills_its_table(client: httpx.AsyncClient, row: dict[str, str]) -> None:
    typed = {"do": "import", "table": row["text"]}
    answer = await client.post(
        f"{PAGE}/program", data=await filled(client, PAGE, typed, action=f"{PAGE}/program")
    )
    if row["refusal"]:
        assert answer.status_code == 422
        assert row["refusal"] in unescape(answer.text)
        return
    assert answer.status_code == 200, unescape(answer.text)
    assert "Imported. Check the program, then save it." in answer.text
    for step in from_table(row["text"]).steps:
        assert f'value="{step.first_deg:g}"' in answer.text


@pytest.mark.parametrize("row", WEATHERS, ids=named)
async def test_the_weather_of_a_simulated_day(client: httpx.AsyncClient, row: dict[str, str]) -> None:
    if not row["refusal"]:
        steps = read_steps(row["text"])
        assert (
            "; ".join(f"{_clock(one.after_midnight)} {_values(one.values)}" for one in steps) == row["value"]
        )
        return
    api = await client.post("/api/v1/simulations", json=HOUR | {"weather": {"csv": row["text"]}})
    assert api.status_code == 422
    assert row["refusal"] in api.json()["detail"]
    typed = TYPED | {"weather": "steps", "steps": row["text"]}
    page = await client.post("/simulate", data=await filled(client, "/simulate", typed))
    assert page.status_code == 422
    assert row["refusal"] in unescape(page.text)


def _clock(after: timedelta) -> str:
    return f"{after!s:0>8}"


def _values(values: object) -> str:
    assert isinstance(values, dict)
    return ", ".join(f"{name} {value:g}" for name, value in values.items())


@pytest.mark.parametrize("name", NAMES)
async def test_a_program_is_exported_for_spreadsheets_and_comes_back(
    client: httpx.AsyncClient, machine: FakeMachine, name: str
) -> None:
    steps = (ProgramStep(0.1, 100.123456789, None), ProgramStep(7.88, 0.001, 1e-7), ProgramStep(23.5, 1 / 3))
    program = StepProgram(name, steps, StepFrame.HORIZON, TimeBase.CLOCK, -3.5)
    assert (await client.put(API, content=to_table(program))).status_code == 200
    first = machine.trackers["T1"].config.strategy
    assert isinstance(first, Stepped)
    assert (first.program.name.strip(), first.program.steps) == (name.strip(), steps)
    file = (await client.get(f"{PAGE}/program.csv")).content
    assert file.startswith(b"\xef\xbb\xbf"), "without it, Excel does not take the file for UTF-8"
    assert (await client.put(API, content=file)).status_code == 200
    strategy = machine.trackers["T1"].config.strategy
    assert isinstance(strategy, Stepped)
    assert strategy == first
    plain = (await client.get("/api/v1/trackers/T1/program", params={"format": "csv"})).content
    assert plain == file.removeprefix(b"\xef\xbb\xbf"), "programs are given the bare text, as documented"


names = st.text(st.characters(categories=["L", "N", "P", "S", "Zs"]), min_size=1, max_size=80).filter(
    lambda name: name == tidy(name) and unseen(name) is None
)
angles = st.floats(0.0, 90.0)
angle_pairs = st.tuples(angles, st.none() | angles) | st.tuples(st.none(), angles)


@given(names, st.dictionaries(st.floats(0.0, 23.9), angle_pairs, min_size=1))
def test_what_is_exported_is_imported_unchanged(
    name: str, pairs: dict[float, tuple[float | None, float | None]]
) -> None:
    steps = [ProgramStep(from_h, *pair) for from_h, pair in sorted(pairs.items())]
    assume(all(after.from_h - before.from_h > 1e-8 for before, after in pairwise(steps)))
    program = StepProgram(name, tuple(steps))
    back = from_table(to_table(program))
    assert back.name == name
    assert [(one.first_deg, one.second_deg) for one in back.steps] == list(
        dict(sorted(pairs.items())).values()
    )
    assert [one.from_h for one in back.steps] == pytest.approx([one.from_h for one in steps], abs=1e-9)
    in_german = to_table(StepProgram("x", program.steps)).replace(",", ";").replace(".", ",")
    assert from_table(in_german).steps == back.steps


@pytest.mark.parametrize(
    "comment", ["# " + " " * 90_000 + "x", "#" + ";" * 90_000 + "x", '"#' + '""' * 45_000 + '"'], ids=len
)
def test_a_long_comment_is_read_in_time_by_its_length(comment: str) -> None:
    assert read_table(f"{comment}\ntime\n").names == ("time",)
