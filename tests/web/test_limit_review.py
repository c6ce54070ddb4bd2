"""Limits that give the machine more room are shown and confirmed, and refused where the axes stand."""

from html import unescape

import pytest

from tests.fault_result import FaultResult
from tests.web.desk import Desk

HTMX = {"HX-Request": "true", "HX-Request-Type": "partial"}
API = "/api/v1/trackers/T1"
PAGE = "/trackers/T1/settings"
FIELDS = {
    "name": "Tracker 1", "drive": "simulated", "profile": "simulated-plc", "host": "127.0.0.1",
    "port": "5020", "unit": "1", "azimuth_minimum_deg": "0",
    "azimuth_maximum_deg": "360", "azimuth_speed_dps": "6",
    "azimuth_acceleration_dps2": "6", "azimuth_jog_slow_dps": "0.5", "azimuth_jog_fast_dps": "3",
    "elevation_minimum_deg": "0",
    "elevation_maximum_deg": "90", "elevation_speed_dps": "4", "elevation_acceleration_dps2": "6",
    "elevation_jog_slow_dps": "0.5", "elevation_jog_fast_dps": "2", "algorithm": "psa", "refraction": "yes",
    "deadband_deg": "0.5", "in_position_deg": "0.05", "following_error_deg": "2", "night": "sunrise",
    "park_azimuth_deg": "180", "park_elevation_deg": "90",
}  # fmt: skip


async def save(desk: Desk, **typed: str) -> tuple[int, str]:
    answer = await desk.ask("POST", PAGE, data=FIELDS | typed, headers=HTMX)
    return answer.status_code, unescape(answer.text)


async def upper_deg(desk: Desk) -> float:
    limit: float = (await desk.ask("GET", API)).json()["azimuth"]["maximum_deg"]
    return limit


async def homed(desk: Desk) -> None:
    await desk.ask("POST", f"{API}/commands", json={"type": "home"})
    await desk.forward(30.0)
    assert (await desk.ask("GET", f"{API}/snapshot")).json()["homed"]


@pytest.mark.fault(24)
async def test_more_room_is_shown_and_saved_only_when_somebody_is_sure_of_it(desk: Desk) -> None:
    await homed(desk)
    status, text = await save(desk, azimuth_maximum_deg="400")
    assert status == 200
    assert "Nothing is saved yet" in text
    assert all(words in text for words in ("Azimuth, upper soft limit", "360 °", "400 °"))
    assert "may turn 40 degrees further than before" in text
    assert await upper_deg(desk) == 360.0
    review = (await desk.ask("POST", f"{API}/review", json={"azimuth": {"maximum_deg": 400}})).json()
    assert [one["after"] for one in review["differences"]] == ["400 °"]
    assert [one["code"] for one in review["doubts"]] == ["limits_widened"]
    said = "Azimuth, upper soft limit: 360 ° to 400 °"
    status, text = await save(desk, azimuth_maximum_deg="410", confirmed=said)
    assert "Nothing is saved yet" in text, "what was confirmed is not what would be saved"
    status, text = await save(desk, azimuth_maximum_deg="400", confirmed=said)
    assert "The settings are saved." in text
    assert await upper_deg(desk) == 400.0


@pytest.mark.fault(24)
async def test_limits_that_shut_out_where_the_axis_stands_are_refused_at_every_door(desk: Desk) -> None:
    await homed(desk)
    wrong = {"azimuth": {"minimum_deg": 10}}
    sentence = "is at 0.0 degrees, outside the new soft limits 10 to 360 degrees"
    review = (await desk.ask("POST", f"{API}/review", json=wrong)).json()
    assert sentence in review["against"][0]["message"]
    refused = await desk.ask("PATCH", API, json=wrong)
    assert refused.status_code == 409
    assert sentence in refused.text
    status, text = await save(desk, azimuth_minimum_deg="10")
    assert status == 409
    assert sentence in text
    narrower = await desk.ask("PATCH", API, json={"azimuth": {"maximum_deg": 300}})
    assert narrower.status_code == 200, "less room, with the axis inside it, needs nobody's word"


async def test_without_a_zero_nobody_knows_where_the_axes_stand(desk: Desk) -> None:
    status, text = await save(desk, elevation_speed_dps="5")
    assert status == 200
    assert "may turn faster than before" in text
    assert "The tracker is not homed: the axis positions" in text
    anywhere = await desk.ask("PATCH", API, json={"azimuth": {"minimum_deg": 10}})
    assert anywhere.status_code == 200


@pytest.mark.fault(24)
async def test_a_limit_beyond_a_switch_that_is_on_is_refused(desk: Desk, fault: FaultResult) -> None:
    await homed(desk)
    await desk.ask("POST", f"{API}/fault-injection", json={"fault": "upper_limit_stuck"})
    await desk.forward(1.0)
    refused = await desk.ask("PATCH", API, json={"azimuth": {"maximum_deg": 400}})
    assert refused.status_code == 409
    assert "the new upper soft limit lies beyond it" in refused.text
    fault.shows(refused.json()["detail"])
