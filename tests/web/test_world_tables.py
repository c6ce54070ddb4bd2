"""Tables as spreadsheets save them: read right, or refused with the row; what is exported comes back."""

import re
from html import unescape
from itertools import pairwise

import httpx
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from app.base.file_text import text_of
from app.base.names import tidy, unseen
from app.tracker.programs.step_table import TableWrong, from_table, to_table
from app.tracker.settings.stepped import ProgramStep, StepFrame, StepProgram, TimeBase
from app.tracker.settings.strategy import Stepped
from app.tracker.values.file_table import read_table
from app.tracker.weather.weather_day import read_steps
from tests.fakes import FakeMachine
from tests.golden.table import rows
from tests.web.filled import filled

ROWS = rows("world/tables.csv")
PROGRAMS = [row for row in ROWS if row["entrance"] == "program"]
NO_TEXT = [row for row in PROGRAMS if "UTF-8" in row["refusal"]]
WEATHERS = [row for row in ROWS if row["entrance"] == "weather"]
API = "/api/v1/trackers/T1/program.csv"
PAGE = "/trackers/T1/strategy"
HOUR = {"tracker_id": "T1", "start": "2027-06-21T09:00:00+03:00", "end": "2027-06-21T10:00:00+03:00"}
TYPED = {"tracker": "T1", "date": "2027-06-21", "mode": "dual", "azimuth": "180", "elevation": "45"}


def named(row: dict[str, str]) -> str:
    return f"{row['text'][-40:]} {row['saved']}"


def steps_of(program: StepProgram) -> str:
    return "; ".join(
        " ".join(map(_shown, (one.from_h, one.first_deg, one.second_deg))) for one in program.steps
    )


def _shown(value: float | None) -> str:
    return "-" if value is None else f"{value:g}"


@pytest.mark.parametrize("row", [row for row in PROGRAMS if row not in NO_TEXT], ids=named)
def test_a_table_is_read_as_a_program_or_refused(row: dict[str, str]) -> None:
    file = row["text"].encode(row["saved"])
    if row["refusal"]:
        with pytest.raises(TableWrong, match=re.escape(row["refusal"])):
            from_table(text_of(file))
    else:
        assert steps_of(from_table(text_of(file))) == row["value"]


@pytest.mark.parametrize("row", WEATHERS, ids=named)
def test_a_table_is_read_as_the_weather_of_a_day_or_refused(row: dict[str, str]) -> None:
    if row["refusal"]:
        with pytest.raises(ValueError, match=re.escape(row["refusal"])):
            read_steps(row["text"])
        return
    steps = [f"{one.after_midnight!s:0>8} {_values(one.values)}" for one in read_steps(row["text"])]
    assert "; ".join(steps) == row["value"]


def _values(values: object) -> str:
    assert isinstance(values, dict)
    return ", ".join(f"{name} {value:g}" for name, value in values.items())


async def test_every_entrance_reads_tables_so(client: httpx.AsyncClient, machine: FakeMachine) -> None:
    wrong = next(row for row in PROGRAMS if row["refusal"] and row not in NO_TEXT)
    weather = next(row for row in WEATHERS if row["refusal"])
    for row in (wrong, *NO_TEXT):
        refused = await client.put(API, content=row["text"].encode(row["saved"]))
        assert (refused.status_code, row["refusal"] in refused.json()["detail"]) == (422, True)
    assert not machine.orders
    day = await client.post("/api/v1/simulations", json=HOUR | {"weather": {"csv": weather["text"]}})
    assert (day.status_code, weather["refusal"] in day.json()["detail"]) == (422, True)
    for action, page, typed, row in (
        (f"{PAGE}/program", PAGE, {"do": "import", "table": wrong["text"]}, wrong),
        ("/simulate", "/simulate", TYPED | {"weather": "steps", "steps": weather["text"]}, weather),
    ):
        form = await filled(client, page, typed, action=action)
        answer = await client.post(action, data=form)
        assert (answer.status_code, row["refusal"] in unescape(answer.text)) == (422, True)


async def test_a_program_is_exported_for_spreadsheets_and_comes_back(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    steps = (ProgramStep(0.1, 100.123456789, None), ProgramStep(7.88, 0.001, 1e-7), ProgramStep(23.5, 1 / 3))
    program = StepProgram('Say "noon"; Güneş, 天气', steps, StepFrame.HORIZON, TimeBase.CLOCK, -3.5)
    assert (await client.put(API, content=to_table(program))).status_code == 200
    assert machine.trackers["T1"].config.strategy == Stepped(program)
    file = (await client.get(f"{PAGE}/program.csv")).content
    assert file.startswith(b"\xef\xbb\xbf"), "without it, Excel does not take the file for UTF-8"
    assert (await client.put(API, content=file)).status_code == 200
    assert machine.trackers["T1"].config.strategy == Stepped(program)
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
