"""Training: faults played over pages and API on a simulated tracker, and seen as an operator sees them."""

from collections.abc import AsyncIterator
from html import unescape
from pathlib import Path

import pytest

from app.drives.faults import FaultKind
from app.tracker.training import LESSONS, lesson
from tests.web.desk import Desk

HTMX = {"HX-Request": "true", "HX-Request-Type": "partial"}
API = "/api/v1/trackers/T1/training"


@pytest.fixture
async def desk(tmp_path: Path) -> AsyncIterator[Desk]:
    async with Desk(tmp_path) as desk:
        yield desk


def test_every_lesson_can_be_played_by_the_simulator() -> None:
    assert {one.fault for one in LESSONS} <= set(FaultKind)
    with pytest.raises(ValueError, match="There is no fault 'fire'"):
        lesson("fire")


async def test_a_fault_is_played_seen_and_ended(desk: Desk) -> None:
    page = await desk.ask("GET", "/trackers/T1/training")
    assert "TRAINING" in page.text
    assert all(one.title in unescape(page.text) for one in LESSONS)
    played = await desk.ask(
        "POST", "/trackers/T1/training/play", data={"fault": "local_switch"}, headers=HTMX
    )
    assert "The fault is played." in played.text
    await desk.forward(1.0)
    seen = (await desk.ask("GET", "/api/v1/trackers/T1/snapshot")).json()
    assert seen["local"] is True
    ended = await desk.ask("POST", "/trackers/T1/training/clear", headers=HTMX)
    assert ended.status_code == 200
    await desk.forward(1.0)
    assert (await desk.ask("GET", "/api/v1/trackers/T1/snapshot")).json()["local"] is False


async def test_the_api_plays_and_ends_faults_and_knows_their_names(desk: Desk) -> None:
    lessons = (await desk.ask("GET", API)).json()
    assert [one["fault"] for one in lessons] == [one.fault for one in LESSONS]
    assert (await desk.ask("POST", API, json={"fault": "drive_fault"})).status_code == 204
    await desk.forward(1.0)
    seen = (await desk.ask("GET", "/api/v1/trackers/T1/snapshot")).json()
    assert seen["fault"]["code"] == "drive_fault"
    assert (await desk.ask("DELETE", API)).status_code == 204
    assert (await desk.ask("POST", API, json={"fault": "fire"})).status_code == 422
