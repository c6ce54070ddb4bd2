"""A device whose clock differs from the controller's by over a minute raises an alarm for everybody."""

from collections.abc import AsyncIterator
from datetime import timedelta

import pytest

from app.alarms.urgency import by_urgency, own_headline
from app.base.clock import VirtualClock
from app.link.messages import ReportDeviceClock, SetClock
from app.site.clock.device_clocks import MOST_DEVICES, UNHEARD, DeviceClocks
from app.site.clock.ntp import KernelClock
from app.site.clock.timekeeping import Timekeeper
from app.tracker.memory.memory import ClockSetting
from app.tracker.state.snapshot import ActivityName
from tests.site.plant import SUMMER_NOON, Plant

APART_S = 11 * 3600 + 39 * 60
TEXT = "The controller's clock is 11 h 39 min ahead of the clock of the device used by technician."
ON_DELAY_S, OFF_DELAY_S = 4.0, 31.0


@pytest.fixture
async def tracks(plant: Plant) -> AsyncIterator[Plant]:
    await plant.track(until=lambda seen: seen.activity is ActivityName.TRACKING)
    yield plant
    await plant.close()


async def look(plant: Plant, ahead_s: float, *, seconds: float = ON_DELAY_S, page: str = "a") -> None:
    """Have a page open for so long, which tells its device's clock every three seconds."""
    for _ in range(int(seconds // 3) + 1):
        await plant.ask(ReportDeviceClock(page, ahead_s))
        await plant.forward(seconds=3)


async def test_a_clock_that_differs_is_told_to_everybody_until_it_agrees(tracks: Plant) -> None:
    assert tracks.latest().clock.off_s is None
    await look(tracks, APART_S)
    assert tracks.alarms() == {"clock_differs": TEXT}
    tracks.site.model.timekeeper.offset.crept = timedelta(seconds=0.2)
    await tracks.forward(seconds=1)
    assert tracks.latest().clock.off_s is None, "not hidden behind 0 s"
    assert tracks.latest().clock.trusted, "nobody knows which of both is wrong"
    assert tracks.tracker().activity is ActivityName.TRACKING
    (told,) = tracks.latest().trackers
    first = told.messages[0]
    assert (first.code, first.priority, first.alarm_id) == ("clock_differs", 3, "clock_differs")
    assert first.message == TEXT

    await tracks.ask(ReportDeviceClock("a", 0.4))
    await tracks.forward(seconds=OFF_DELAY_S)
    assert tracks.alarms() == {}
    assert tracks.latest().clock.off_s == 0.2


async def test_one_that_agrees_hides_none_that_does_not(tracks: Plant) -> None:
    await look(tracks, -120.0, page="wrong")
    await look(tracks, -APART_S, page="more wrong")
    await tracks.ask(ReportDeviceClock("right", 0.0))
    await tracks.forward(seconds=1)
    assert tracks.alarms() == {"clock_differs": TEXT.replace("ahead of", "behind")}


async def test_who_looks_at_no_page_any_more_is_forgotten(tracks: Plant) -> None:
    await look(tracks, APART_S)
    await tracks.forward(seconds=UNHEARD.total_seconds() + OFF_DELAY_S)
    assert tracks.alarms() == {}


@pytest.mark.parametrize(("ahead_s", "differs"), [(60.0, False), (61.0, True), (-60.0, False), (-61.0, True)])
async def test_more_than_a_minute(tracks: Plant, ahead_s: float, *, differs: bool) -> None:
    await look(tracks, ahead_s)
    assert ("clock_differs" in tracks.alarms()) is differs


async def test_it_is_no_message_of_one_tracker_among_others(tracks: Plant) -> None:
    await look(tracks, APART_S)
    site = tracks.latest()
    assert [(one.code, one.tracker_id) for one in site.messages] == [("clock_differs", None)]
    (first,) = by_urgency(site.trackers)
    headline = own_headline(first)
    assert headline is not None
    assert headline.code != "clock_differs"


async def test_ntp_knows_better_than_a_device(tracks: Plant) -> None:
    tracks.site.model.timekeeper.offset.kernel = KernelClock(synchronised=True)
    tracks.site.model.timekeeper._kernel = lambda: KernelClock(synchronised=True)
    await look(tracks, APART_S)
    assert tracks.latest().clock.off_s == 0.0
    (warning,) = tracks.latest().clock.warnings
    assert warning.hint == "NTP keeps the controller's clock correct: set the clock of that device."


def test_a_clock_set_by_hand_is_compared_with_ntp() -> None:
    """The difference of 11 h 39 min is not told as an error of 0 s."""

    def keeper(offset_s: float, source: str = "manual") -> Timekeeper:
        setting = ClockSetting(source, offset_s)
        return Timekeeper(VirtualClock(SUMMER_NOON), setting, kernel=lambda: KernelClock(synchronised=True))

    state = keeper(-APART_S).state()
    assert state.off_s == -APART_S
    (warning,) = state.warnings
    assert warning.message == (
        "The controller's clock was set manually, 11 h 39 min behind the computer's clock, which NTP keeps "
        "correct."
    )
    assert "2 min ahead of" in keeper(120.0).state().warnings[0].message
    assert keeper(60.0).state().warnings == ()
    assert keeper(60.0).state().off_s == 60.0


async def test_keeping_the_clock_does_not_end_the_difference(tracks: Plant) -> None:
    await look(tracks, APART_S)
    await tracks.ask(SetClock("system"))
    await tracks.ask(ReportDeviceClock("a", APART_S))
    await tracks.forward(seconds=1)
    assert "clock_differs" in tracks.alarms()


def test_of_very_many_pages_the_oldest_is_forgotten() -> None:
    clocks = DeviceClocks(VirtualClock(SUMMER_NOON))
    clocks.heard("first", "ada", timedelta(days=3))
    for number in range(MOST_DEVICES):
        clocks.heard(str(number), "bo", timedelta(minutes=2))
    furthest = clocks.furthest()
    assert furthest is not None
    assert furthest.whose == "bo"
