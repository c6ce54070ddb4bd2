"""No clock is moved by more than a minute under a tracker that is led by it."""

from datetime import timedelta

import pytest

from app.link.messages import SetClock
from app.tracker.access.location_change import against_another_clock
from app.tracker.commands.commands import CommandRejected, SelectMode, Stop, Track
from app.tracker.state.snapshot import ActivityName
from app.tracker.values.mode import Mode
from tests.site.plant import Plant

AHEAD = timedelta(hours=11, minutes=39)
NEAR = timedelta(seconds=30)


async def tracks(plant: Plant) -> None:
    await plant.track(until=lambda seen: seen.activity is ActivityName.TRACKING)


@pytest.mark.parametrize("by", [AHEAD, -AHEAD, timedelta(seconds=61)])
async def test_a_clock_is_not_moved_while_a_tracker_tracks(plant: Plant, by: timedelta) -> None:
    await tracks(plant)
    before = plant.site.model.state.clock
    with pytest.raises(CommandRejected) as refused:
        await plant.ask(SetClock("manual", plant.site.model.now() + by))
    (reason,) = refused.value.reasons
    assert reason.message == "T1 is tracking the sun by the present clock."
    assert reason.hint == "End tracking of T1 first."
    assert plant.site.model.state.clock == before

    await plant.ask(Stop())
    await plant.ask(SetClock("manual", plant.site.model.now() + by))
    assert plant.site.model.state.clock.offset_s == pytest.approx(by.total_seconds())


async def test_the_system_clock_is_refused_where_it_moves_the_clock_of_the_site(plant: Plant) -> None:
    await plant.commission()
    await plant.ask(SetClock("manual", plant.clock.now() + timedelta(minutes=2)))
    await tracks_by_hand_set_clock(plant)
    with pytest.raises(CommandRejected, match="by the present clock"):
        await plant.ask(SetClock("system"))


async def tracks_by_hand_set_clock(plant: Plant) -> None:
    await plant.ask(SelectMode(Mode.DUAL))
    await plant.ask(Track())
    await plant.until(lambda seen: seen.activity is ActivityName.TRACKING)


async def test_half_a_minute_is_set_while_tracking_and_taken_back(plant: Plant) -> None:
    await tracks(plant)
    await plant.ask(SetClock("manual", plant.site.model.now() + NEAR))
    assert plant.site.model.state.clock.offset_s == pytest.approx(NEAR.total_seconds())
    await plant.ask(SetClock("system"))
    assert plant.site.model.state.clock.offset_s == 0.0
    assert plant.tracker().activity is ActivityName.TRACKING


@pytest.mark.parametrize("activity", list(ActivityName))
def test_who_is_led_by_the_clock(activity: ActivityName) -> None:
    always = {ActivityName.TRACKING, ActivityName.SHOWING}
    later = {ActivityName.STOWING, ActivityName.STOWED, ActivityName.FAULTED}
    for tracking_on in (False, True):
        found = against_another_clock(-AHEAD, {"T1": (activity, tracking_on), "T2": (activity, tracking_on)})
        led = activity in always or (tracking_on and activity in later)
        assert len(found) == (2 if led else 0)
        assert all(key in one.message + one.hint for key, one in zip(("T1", "T2"), found, strict=False))
        assert against_another_clock(timedelta(minutes=1), {"T1": (activity, tracking_on)}) == ()
        is_stowed = activity in {ActivityName.STOWING, ActivityName.STOWED}
        assert all(one.hint.startswith("Wait until") is is_stowed for one in found), "nobody ends a stow"
