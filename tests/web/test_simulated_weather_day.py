"""A simulated day with weather, as the API and the page take it."""

from pathlib import Path
from typing import Any

import httpx
import pytest

from tests.web.desk import Desk

API = "/api/v1/simulations"
HOUR = {
    "tracker_id": "T1",
    "start": "2027-06-21T09:00:00+03:00",
    "end": "2027-06-21T10:00:00+03:00",
    "step_s": 60,
}


async def test_a_storm_in_a_simulated_hour_stows_and_is_in_the_frames(tmp_path: Path) -> None:
    async with Desk(tmp_path) as desk:
        place = {"latitude_deg": 41.2867, "longitude_deg": 36.33, "time_zone": "Europe/Istanbul"}
        await desk.ask("PUT", "/api/v1/site/location", json=place | {"confirmed": True})
        steps = [{"time": "09:00", "wind_mps": 3}, {"time": "09:20", "wind_mps": 25}]
        made = await desk.ask("POST", API, json=HOUR | {"weather": {"steps": steps}})
        assert made.status_code == 201, made.text
        frames = (await desk.ask("GET", f"{made.headers['location']}/samples")).json()
        activity = frames["columns"]["activity"]
        assert activity[10] != activity[40], "tracking before, stowed in the storm"
        assert frames["columns"]["measured_elevation_deg"][40] == pytest.approx(90.0, abs=0.1)


@pytest.mark.parametrize(
    ("weather", "sentence"),
    [
        ({}, "Give one of scenario, steps, and csv"),
        ({"scenario": "manual"}, "given in steps"),
        ({"scenario": "storm", "begins": "noon"}, "The start of the scenario: give a time such as 11:30"),
        ({"steps": [{"time": "10:00", "wind_mps": 99}]}, "must lie between 0 and 50"),
    ],
)
async def test_weather_that_cannot_be_is_422_with_a_sentence(
    client: httpx.AsyncClient, weather: dict[str, Any], sentence: str
) -> None:
    answer = await client.post(API, json=HOUR | {"weather": weather})
    assert answer.status_code == 422
    assert sentence in answer.text
