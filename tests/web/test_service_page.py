"""Service mode, the switch at the cabinet and the trust in the zero, as pages and API show them."""

from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any

import pytest

from app.tracker.access.interlocks import REQUIRED, homed
from app.web.shell.without_zero import NEEDS_ZERO
from tests.web.desk import Desk

HTMX = {"HX-Request": "true", "HX-Request-Type": "partial"}
PAGE = "/trackers/T1/service"
API = "/api/v1/trackers/T1"


@pytest.fixture
async def desk(tmp_path: Path) -> AsyncIterator[Desk]:
    async with Desk(tmp_path) as desk:
        await desk.forward(1.0)
        yield desk


async def seen(desk: Desk) -> dict[str, Any]:
    found: dict[str, Any] = (await desk.ask("GET", f"{API}/snapshot")).json()
    return found


async def press(desk: Desk, path: str, **typed: str) -> tuple[int, str]:
    answer = await desk.ask("POST", f"{PAGE}{path}", data=typed, headers=HTMX)
    return answer.status_code, answer.text


def test_everything_that_needs_a_zero_has_words_for_it() -> None:
    assert {action for action, conditions in REQUIRED.items() if homed in conditions} == set(NEEDS_ZERO)


async def test_service_begins_in_a_name_is_confirmed_counts_down_and_ends(desk: Desk) -> None:
    await desk.ask("PATCH", API, json={"machine": {"clear_for_s": 20}})
    status, text = await press(desk, "", name="")
    assert status == 409
    assert "Service mode requires a name" in text
    assert (await press(desk, "", name="Ada"))[0] == 200
    await desk.forward(1.0)
    served = (await seen(desk))["service"]
    assert served["mode"]["name"] == "Ada"
    assert served["clear_for_s"] == 0.0
    status, text = await press(desk, "/clear")
    assert status == 422
    assert "confirm that no one is within reach of the panel" in text
    assert (await press(desk, "/clear", looked="yes"))[0] == 200
    await desk.forward(5.0)
    assert 14.5 <= (await seen(desk))["service"]["clear_for_s"] <= 15.5
    page = (await desk.ask("GET", PAGE)).text
    assert "at <b>0.5°/s</b> in azimuth and <b>0.5°/s</b> in elevation" in page
    assert "In service mode by" in (await desk.ask("GET", "/trackers/T1")).text
    await desk.forward(16.0)
    assert (await seen(desk))["service"]["clear_for_s"] == 0.0
    assert (await seen(desk))["actions"]["jog"][0]["code"] == "area_not_clear"
    assert (await press(desk, "/end"))[0] == 200
    assert (await seen(desk))["service"] is None


async def test_the_switch_at_the_cabinet_is_told_on_every_page(desk: Desk) -> None:
    played = await desk.ask("POST", f"{API}/fault-injection", json={"fault": "local_switch"})
    assert played.status_code == 204
    await desk.forward(1.0)
    for path in ("/trackers/T1", "/trackers/T1/settings", PAGE):
        page = (await desk.ask("GET", path)).text
        bar = page.split('id="says" data-code="local"')[1].split("</summary>")[0]
        assert "The switch at the cabinet is on local." in bar, path
    for path in ("/", "/site", "/alarms"):
        page = (await desk.ask("GET", path)).text
        bar = page.split('id="says" data-code="local"')[1].split("</a>")[0]
        assert "T1 Tracker 1: Local: Heliopanel cannot move the tracker." in bar, path


async def test_the_zero_says_who_granted_it_and_why_it_was_lost(desk: Desk) -> None:
    never = (await desk.ask("GET", "/trackers/T1")).text
    assert "No home position has been set yet." in never
    assert (await seen(desk))["home"] is None
    await desk.ask("POST", f"{API}/commands", json={"type": "set_home", "confirmed": True})
    await desk.forward(3.0)
    granted = await seen(desk)
    assert granted["homed"]
    assert granted["home"]["by"] == "local user"
    assert granted["home"]["how"] == "set manually"
    assert "local user" in (await desk.ask("GET", "/trackers/T1")).text
    await desk.ask("POST", f"{API}/fault-injection", json={"fault": "power_loss"})
    await desk.forward(2.0)
    lost = await seen(desk)
    assert lost["home"] is None
    assert "has restarted" in lost["home_lost"]
    assert lost["home_lost_at"] > granted["home"]["set_at"]
    page = (await desk.ask("GET", PAGE)).text
    assert "has restarted" in page
    assert "stow, not even against wind" in page
