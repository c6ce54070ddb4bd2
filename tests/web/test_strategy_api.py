"""Strategies over the API: set one, give a program as JSON and CSV, tell a day."""

from collections.abc import AsyncIterator

import httpx
import pytest

from app.tracker.programs.examples import ALEXANDRU_TABLE_3
from app.tracker.programs.step_table import to_table
from app.tracker.settings.strategy import HybridConfig, Interval, Stepped
from tests.fakes import FakeMachine, fake_app, serving

TRACKER = "/trackers/T1"


@pytest.fixture
async def api(machine: FakeMachine) -> AsyncIterator[httpx.AsyncClient]:
    async with serving(fake_app(machine)) as client:
        client.base_url = httpx.URL("http://127.0.0.1:8010/api/v1")
        yield client


async def test_a_strategy_and_the_correction_are_set_by_a_patch(
    api: httpx.AsyncClient, machine: FakeMachine
) -> None:
    change = {
        "strategy": {"kind": "interval", "minutes": 15},
        "hybrid": {"enabled": True, "simulated": {"azimuth_deg": 1}},
    }
    answer = await api.patch(TRACKER, json=change)
    assert answer.status_code == 200
    assert answer.json()["strategy"] == {"kind": "interval", "minutes": 15, "aim": "middle"}
    sent = machine.orders[-1].command
    assert sent.config.strategy == Interval(15)
    assert sent.config.hybrid.enabled
    assert sent.config.hybrid.bound_deg == HybridConfig().bound_deg
    assert sent.config.hybrid.simulated.azimuth_deg == 1.0


@pytest.mark.parametrize(
    ("strategy", "word"),
    [
        ({"kind": "interval", "minutes": 0}, "between 1 and 240"),
        ({"kind": "encoder-deadband", "counts": 0}, "between 1 and 1000000"),
        ({"kind": "sideways"}, "sideways"),
        ({"kind": "stepped", "program": {"name": "x", "steps": []}}, "1 to 288 steps"),
    ],
)
async def test_what_is_no_strategy_is_refused_in_words(
    api: httpx.AsyncClient, strategy: dict[str, object], word: str
) -> None:
    answer = await api.patch(TRACKER, json={"strategy": strategy})
    assert answer.status_code == 422
    assert word in answer.text


async def test_a_program_goes_in_and_comes_back_as_csv(api: httpx.AsyncClient, machine: FakeMachine) -> None:
    missing = await api.get(f"{TRACKER}/program")
    assert missing.status_code == 404
    assert "does not follow a step program" in missing.json()["detail"]
    table = to_table(ALEXANDRU_TABLE_3)
    put = await api.put(f"{TRACKER}/program.csv", content=table, headers={"content-type": "text/csv"})
    assert put.status_code == 200
    assert machine.orders[-1].command.config.strategy == Stepped(ALEXANDRU_TABLE_3)
    back = await api.get(f"{TRACKER}/program", params={"format": "csv"})
    assert back.headers["content-type"].startswith("text/csv")
    assert back.text == table


async def test_a_program_goes_in_and_comes_back_as_json(api: httpx.AsyncClient) -> None:
    examples = (await api.get(f"{TRACKER}/program/examples")).json()
    program = examples["alexandru-table-3"] | {"name": "My own"}
    assert (await api.put(f"{TRACKER}/program", json=program)).status_code == 200
    assert (await api.get(f"{TRACKER}/program")).json() == program


async def test_a_table_that_is_wrong_names_row_and_column(
    api: httpx.AsyncClient, machine: FakeMachine
) -> None:
    before = len(machine.orders)
    table = "solar_time,azimuth_deg,elevation_deg\n07:00,90,30\n06:00,east,30\n"
    answer = await api.put(f"{TRACKER}/program.csv", content=table)
    assert answer.status_code == 422
    assert "Row 3, azimuth_deg: 'east' is not a number." in answer.text
    assert (await api.put(f"{TRACKER}/program.csv", content=b"\xff\xfe")).status_code == 422
    assert len(machine.orders) == before


async def test_the_api_tells_a_day_by_any_strategy(api: httpx.AsyncClient) -> None:
    question = {"strategy": {"kind": "interval", "minutes": 60}, "date": "2026-12-21"}
    day = (await api.post(f"{TRACKER}/strategy/day", json=question)).json()
    assert 8 <= day["moves"] <= 13
    assert 5.0 < day["largest_error_deg"] < 8.0
    assert len(day["sun_azimuth_deg"]) == len(day["panel_azimuth_deg"]) == 721
