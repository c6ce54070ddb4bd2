"""Strategies over the API: set one, give a program, tell a day."""

import httpx

from app.tracker.settings.strategy import HybridConfig, Interval
from tests.fakes import FakeMachine

TRACKER = "/api/v1/trackers/T1"


async def test_a_strategy_and_the_correction_are_set_by_a_patch(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    change = {
        "strategy": {"kind": "interval", "minutes": 15},
        "hybrid": {"enabled": True, "simulated": {"azimuth_deg": 1}},
    }
    answer = await client.patch(TRACKER, json=change)
    assert answer.status_code == 200
    assert answer.json()["strategy"] == {"kind": "interval", "minutes": 15, "aim": "middle"}
    sent = machine.orders[-1].command
    assert sent.config.strategy == Interval(15)
    assert sent.config.hybrid.enabled
    assert sent.config.hybrid.bound_deg == HybridConfig().bound_deg
    assert sent.config.hybrid.simulated.azimuth_deg == 1.0
    wrong = await client.patch(TRACKER, json={"strategy": {"kind": "encoder-deadband", "counts": 0}})
    assert (wrong.status_code, "between 1 and 1000000" in wrong.text) == (422, True)


async def test_a_program_goes_in_and_comes_back(client: httpx.AsyncClient) -> None:
    missing = await client.get(f"{TRACKER}/program")
    assert missing.status_code == 404
    assert "does not follow a step program" in missing.json()["detail"]
    examples = (await client.get(f"{TRACKER}/program/examples")).json()
    program = examples["alexandru-table-3"] | {"name": "My own"}
    assert (await client.put(f"{TRACKER}/program", json=program)).status_code == 200
    assert (await client.get(f"{TRACKER}/program")).json() == program


async def test_the_api_tells_a_day_by_any_strategy(client: httpx.AsyncClient) -> None:
    question = {"strategy": {"kind": "interval", "minutes": 60}, "date": "2026-12-21"}
    day = (await client.post(f"{TRACKER}/strategy/day", json=question)).json()
    assert 8 <= day["moves"] <= 13
    assert 5.0 < day["largest_error_deg"] < 8.0
    assert len(day["sun_azimuth_deg"]) == len(day["panel_azimuth_deg"]) == 721
