"""Each page tells what its device's clock shows; what differs is told on every page."""

from datetime import timedelta
from html import unescape

import pytest

from app.tracker.state.snapshot import EventKind
from tests.web.desk import Desk
from tests.web.sockets import Socket, connected

APART = timedelta(hours=11, minutes=39)
PAGES = ("", "/commissioning/clock", "/commissioning/run", "/settings", "/mast")


async def look(desk: Desk, page: Socket, behind: timedelta, *, seconds: int, late_s: int = 0) -> None:
    """Have a page ping once a second; the later ones come late by so much."""
    for _ in range(seconds):
        now = desk.plant.site.model.now()
        sent = now - timedelta(seconds=late_s)
        await page.send(type="ping", tc=sent.timestamp() * 1000, at=(sent - behind).timestamp() * 1000)
        await page.next("pong")
        await desk.forward(1)


async def test_a_difference_is_told_on_every_page(desk: Desk) -> None:
    await desk.plant.commission()
    async with connected(desk.app, "tracker=T1") as page:
        await look(desk, page, APART, seconds=6)
        (alarm,) = desk.plant.alarms().items()
        assert alarm[0] == "clock_differs"
        assert "11 h 39 min ahead of the clock of the device used by local user" in alarm[1]
        for path in PAGES:
            shown = await desk.ask("GET", f"/trackers/T1{path}")
            assert "11 h 39 min ahead of" in shown.text, path
            assert 'data-priority="3"' in shown.text, path
        clock = (await desk.ask("GET", "/trackers/T1/commissioning/clock")).text
        assert 'id="clock-error" hidden>' in clock, "nobody knows which of both is wrong"
        assert alarm[1] in unescape(clock.partition('data-list="site.clock.warnings"')[2])
        assert "Clocks differ" in (await desk.ask("GET", "/alarms")).text
        assert "Clocks differ" in (await desk.ask("GET", "/")).text

        await look(desk, page, timedelta(0), seconds=33)
        assert desk.plant.alarms() == {}


async def test_what_is_not_over_a_minute_off_is_not_told_to_the_controller(desk: Desk) -> None:
    await desk.plant.commission()
    async with connected(desk.app, "tracker=T1") as page:
        await look(desk, page, timedelta(seconds=59), seconds=6)
        assert desk.plant.site.model.timekeeper.devices.furthest() is None


async def test_a_ping_that_was_held_up_tells_nothing_of_a_clock(desk: Desk) -> None:
    await desk.plant.commission()
    async with connected(desk.app, "tracker=T1") as page:
        await look(desk, page, timedelta(0), seconds=2)
        await look(desk, page, timedelta(0), seconds=4, late_s=90)
        assert desk.plant.site.model.timekeeper.devices.furthest() is None


@pytest.mark.parametrize("at", [-1, "now", 1e15, True, float("inf")])
async def test_no_clock_that_cannot_be_is_understood(desk: Desk, at: object) -> None:
    async with connected(desk.app, "tracker=T1") as page:
        await page.send(type="ping", tc=0, at=at)
        assert (await page.next("problem"))["status"] == 422


@pytest.mark.parametrize(
    ("at", "is_told"), [(0, True), (4.1e12, True), (4.11e12, False), (1e14, False), (None, False)]
)
async def test_the_ends_of_what_a_clock_can_show(desk: Desk, at: float | None, *, is_told: bool) -> None:
    await desk.plant.commission()
    async with connected(desk.app, "tracker=T1") as page:
        for second in range(6):
            await page.send(type="ping", tc=second * 1000, at=at)
            await page.next("pong")
            await desk.forward(1)
    assert ("clock_differs" in desk.plant.alarms()) is is_told


async def test_a_page_that_is_gone_tells_nothing_any_more(desk: Desk) -> None:
    await desk.plant.commission()
    async with connected(desk.app, "tracker=T1") as page:
        await look(desk, page, APART, seconds=6)
    await desk.forward(31)
    assert desk.plant.alarms() == {}


async def test_a_hidden_page_that_tells_once_a_minute_raises_one_alarm(desk: Desk) -> None:
    await desk.plant.commission()
    async with connected(desk.app, "tracker=T1") as page:
        await look(desk, page, APART, seconds=2)
        for _ in range(5):
            await desk.forward(59)
            await look(desk, page, APART, seconds=1)
        raised = [one.data["code"] for one in desk.plant.happened(EventKind.ALARM_RAISED)]
    assert raised.count("clock_differs") == 1
    assert not desk.plant.happened(EventKind.ALARM_RETURNED)
