"""Training: faults played over pages and API on a simulated tracker, and seen as an operator sees them."""

import re
from collections.abc import AsyncIterator
from html import unescape
from pathlib import Path

import pytest

from app.tracker.programs.fault_scenarios import LESSONS, Subject
from tests.fault_result import FaultResult
from tests.web.desk import Desk

HTMX = {"HX-Request": "true", "HX-Request-Type": "partial"}
API = "/api/v1/trackers/T1/fault-injection"


@pytest.fixture
async def desk(tmp_path: Path) -> AsyncIterator[Desk]:
    async with Desk(tmp_path) as desk:
        yield desk


async def test_a_fault_is_played_seen_and_ended(desk: Desk) -> None:
    page = await desk.ask("GET", "/trackers/T1/fault-injection")
    assert "TRAINING" in page.text
    assert all(one.title in unescape(page.text) for one in LESSONS if one.subject is not Subject.WEATHER)
    assert "The site's weather is not simulated now" in unescape(page.text)
    played = await desk.ask(
        "POST", "/trackers/T1/fault-injection/play", data={"fault": "local_switch"}, headers=HTMX
    )
    assert "The fault is injected." in played.text
    await desk.forward(1.0)
    seen = (await desk.ask("GET", "/api/v1/trackers/T1/snapshot")).json()
    assert seen["local"] is True
    ended = await desk.ask("POST", "/trackers/T1/fault-injection/clear", headers=HTMX)
    assert ended.status_code == 200
    await desk.forward(1.0)
    assert (await desk.ask("GET", "/api/v1/trackers/T1/snapshot")).json()["local"] is False


async def test_the_api_plays_and_ends_faults_and_knows_their_names(desk: Desk) -> None:
    lessons = (await desk.ask("GET", API)).json()["items"]
    assert [one["fault"] for one in lessons] == [one.fault for one in LESSONS]
    assert (await desk.ask("POST", API, json={"fault": "drive_fault"})).status_code == 204
    await desk.forward(1.0)
    seen = (await desk.ask("GET", "/api/v1/trackers/T1/snapshot")).json()
    assert seen["fault"]["code"] == "drive_fault"
    assert (await desk.ask("DELETE", API)).status_code == 204
    assert (await desk.ask("POST", API, json={"fault": "fire"})).status_code == 422


async def test_weather_is_played_on_made_up_weather_only_and_ends_with_the_faults(desk: Desk) -> None:
    refused = await desk.ask("POST", API, json={"fault": "wind_impossible"})
    assert refused.status_code == 409
    assert "weather is not simulated" in refused.text
    assert (await desk.ask("POST", "/trackers/T1/fault-injection/weather", headers=HTMX)).status_code == 204
    await desk.forward(2.0)
    assert (await desk.ask("POST", API, json={"fault": "wind_impossible"})).status_code == 204
    page = (await desk.ask("GET", "/trackers/T1/fault-injection")).text
    assert "Active fault: wind implausible." in page
    assert all(one.title in unescape(page) for one in LESSONS)
    await desk.forward(2.0)
    assert await wind(desk) == "impossible"
    assert (await desk.ask("DELETE", API)).status_code == 204
    await desk.forward(2.0)
    assert await wind(desk) == "good"


@pytest.mark.fault(42)
async def test_a_panel_that_is_not_stowed_is_told_first_with_the_button_that_stows(desk: Desk) -> None:
    card = re.compile(r'<section class="message" id="urgent" role="alert" data-code="(\w*)"[^>]*?(hidden)?>')
    bar = re.compile(r'id="says" data-code="not_stowed" data-priority="1"')
    calm = (await desk.ask("GET", "/trackers/T1")).text
    assert card.search(calm)[2] == "hidden"  # type: ignore[index]
    await desk.ask("POST", "/trackers/T1/fault-injection/weather", headers=HTMX)
    await desk.forward(2.0)
    assert (await desk.ask("POST", API, json={"fault": "not_stowed"})).status_code == 204
    await desk.forward(3.0)
    for path in ("/trackers/T1", "/trackers/T1/fault-injection", "/trackers/T1/settings"):
        page = (await desk.ask("GET", path)).text
        assert bar.search(page), "the bar is red"
        assert "is NOT STOWED, although wind requires it" in page
    page = (await desk.ask("GET", "/trackers/T1")).text
    found = card.search(page)
    assert found is not None
    assert (found[1], found[2]) == ("not_stowed", None)
    assert found.start() < page.index("live-readings"), "before everything else of the page"
    slots = page[page.index('<div class="slots">') :]
    forms = re.findall(r"<form[^>]*/stow.*?</form>", slots, re.DOTALL)
    assert ["hidden" in one.split(">")[0] for one in forms] == [False, True], "the wind demands it, not snow"
    assert 'value="wind"' in forms[0]


async def wind(desk: Desk) -> str:
    weather = (await desk.ask("GET", "/api/v1/site/weather")).json()
    quality: str = weather["quantities"]["wind_mps"]["quality"]
    return quality


@pytest.mark.fault(17)
async def test_a_pressed_switch_is_named_with_the_way_out_on_the_page(desk: Desk, fault: FaultResult) -> None:
    assert (await desk.ask("POST", API, json={"fault": "upper_limit_stuck"})).status_code == 204
    await desk.forward(1.0)
    seen = (await desk.ask("GET", "/api/v1/trackers/T1/snapshot")).json()
    told = {reason["code"]: reason["message"] for reason in seen["notices"]}
    sentence = "The upper limit switch of the azimuth axis of Tracker 1 is on although the axis is within"
    assert told["at_limit_switch"].startswith(sentence)
    assert told["at_limit_switch"].endswith("the axis moves west (counterclockwise) only.")
    assert sentence in (await desk.ask("GET", "/trackers/T1/fault-injection")).text
    fault.shows(told["at_limit_switch"])
    await desk.ask("POST", API, json={"fault": "both_limits"})
    await desk.forward(1.0)
    both = (await desk.ask("GET", "/api/v1/trackers/T1/snapshot")).json()
    assert "at_limit_switch" not in {reason["code"] for reason in both["notices"]}
    assert both["fault"]["code"] == "limit_switch_wiring"
