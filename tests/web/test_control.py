"""Control at the doors of the panel: who has it is refused with 423 and shown; the page renews it."""

import pytest

from app.link.messages import Order, RequestControl, SiteCommand
from app.tracker.commands.commands import Command
from app.tracker.state.snapshot import ActivityName
from tests.web.desk import Desk
from tests.web.sockets import connected

API = "/api/v1/trackers/T1"
JOG = {"press_id": "p", "axis": "azimuth", "direction": 1}
STEP = {"type": "step", "axis": "azimuth", "delta_deg": 1.0}
HTMX = {"HX-Request": "true", "Origin": "http://127.0.0.1:8010"}


async def by_bo(desk: Desk, command: Command | SiteCommand, rank: int = 2) -> None:
    tracker_id = None if isinstance(command, SiteCommand) else "T1"
    await desk.plant.site.execute(Order(command, "bo", tracker_id, via="session", rank=rank))


@pytest.mark.fault(55)
async def test_motion_is_423_while_somebody_else_has_control(desk: Desk) -> None:
    await by_bo(desk, RequestControl(("T1",)))
    for path, body in ((f"{API}/jog", JOG), (f"{API}/commands", STEP)):
        refused = await desk.ask("POST", path, json=body)
        assert refused.status_code == 423
        assert refused.json()["reasons"][0]["code"] == "control_held"
        assert refused.json()["detail"] == "bo has control of Tracker 1."
    assert (await desk.ask("POST", f"{API}/stop")).status_code == 202
    assert (await desk.ask("GET", f"{API}/snapshot")).json()["control"]["holder"] == "bo"


async def test_the_first_order_takes_control_and_says_so(desk: Desk) -> None:
    assert (await desk.ask("GET", f"{API}/control")).json()["yours"] is False
    assert (await desk.ask("POST", f"{API}/jog", json=JOG)).status_code == 202
    mine = (await desk.ask("GET", f"{API}/control")).json()
    assert mine["yours"] is True
    assert mine["control"]["holder"] == "local user"
    assert (await desk.ask("DELETE", f"{API}/control")).json()["yours"] is False
    assert (await desk.ask("DELETE", f"{API}/control")).status_code == 409


@pytest.mark.fault(60)
async def test_an_order_of_an_older_epoch_is_423_and_moves_nothing(desk: Desk) -> None:
    taken = (await desk.ask("POST", f"{API}/control", json={})).json()["control"]["epoch"]
    await desk.ask("DELETE", f"{API}/control")
    late = await desk.ask("POST", f"{API}/jog", json=JOG, headers={"Control-Epoch": str(taken)})
    assert late.status_code == 423
    assert late.json()["reasons"][0]["code"] == "control_lost"
    await desk.forward(0.5)
    assert desk.plant.tracker().activity is ActivityName.HOLDING


async def test_control_is_asked_for_taken_over_and_kept_over_the_api(desk: Desk) -> None:
    await by_bo(desk, RequestControl(("T1",)), rank=1)
    asked = (await desk.ask("POST", f"{API}/control", json={"reason": "my turn"})).json()
    assert asked["control"]["request"]["by"] == "local user"
    assert asked["control"]["request"]["takes"] is False
    without = await desk.ask("POST", f"{API}/control", json={"action": "take_over"})
    assert without.status_code == 409
    await desk.ask("POST", f"{API}/control", json={"action": "take_over", "reason": "hail"})
    await desk.forward(10.5)
    assert (await desk.ask("GET", f"{API}/control")).json()["yours"] is True
    await by_bo(desk, RequestControl(("T1",), takes=True, reason="back"))
    await desk.forward(6)
    kept = await desk.ask("POST", f"{API}/control", json={"action": "keep"})
    assert kept.status_code == 409, "nothing was heard from here since"
    group = await desk.ask("POST", "/api/v1/control", json={"tracker_ids": ["T1"]})
    assert [one["yours"] for one in group.json()["items"]] == [True]


async def test_a_page_shows_who_has_control_and_its_keys(desk: Desk) -> None:
    await by_bo(desk, RequestControl(("T1",)))
    page = (await desk.ask("GET", "/trackers/T1")).text
    assert 'data-state="held"' in page
    assert "Take over" in page
    body = {"wanted": "take_over", "reason": "rain"}
    pressed = await desk.ask("POST", "/trackers/T1/control", data=body, headers=HTMX)
    assert "Control transfers when the countdown ends" in pressed.text
    assert 'data-state="waiting"' in (await desk.ask("GET", "/trackers/T1")).text
    assert desk.plant.tracker().control.request is not None
    wrong = await desk.ask("POST", "/trackers/T1/control", data={"wanted": "steal"}, headers=HTMX)
    assert wrong.status_code == 422


async def test_a_visible_page_keeps_control_and_a_hidden_one_loses_it(desk: Desk) -> None:
    await desk.ask("POST", f"{API}/control", json={})
    async with connected(desk.app, "tracker=T1") as page:
        for _ in range(6):
            await page.send(type="ping", tc=0, visible=True)
            await desk.forward(4)
        assert desk.plant.tracker().control.holder == "local user"
        for _ in range(6):
            await page.send(type="ping", tc=0, visible=False)
            await desk.forward(4)
        assert desk.plant.tracker().control.holder is None


async def test_settings_are_locked_and_unlocked_with_a_reason(desk: Desk) -> None:
    locked = await desk.ask("PUT", f"{API}/settings-lock", json={"locked": True})
    assert locked.json()["locked"]["by"] == "local user"
    refused = await desk.ask("PATCH", API, json={"name": "Other"})
    assert refused.status_code == 409
    assert refused.json()["reasons"][0]["code"] == "settings_locked"
    assert "Locked by" in (await desk.ask("GET", "/trackers/T1/settings")).text
    opened = await desk.ask("POST", "/trackers/T1/settings-lock/open", data={"reason": "gear"}, headers=HTMX)
    assert "unlocked" in opened.text
    assert (await desk.ask("GET", f"{API}/settings-lock")).json()["locked"] is None
    assert (await desk.ask("PATCH", API, json={"name": "Other"})).status_code == 200
