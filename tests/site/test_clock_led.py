"""No clock is moved by more than a minute under a tracker that is led by it."""

from datetime import timedelta

import pytest

from app.link.messages import SetClock, SetLocation
from app.tracker.access.location_change import (
    Doing,
    against_another_clock,
    against_other_settings,
    led_by_the_location,
)
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
def test_who_is_led_by_the_clock_and_by_the_location(activity: ActivityName) -> None:
    always = {ActivityName.TRACKING, ActivityName.SHOWING}
    later = {ActivityName.STOWING, ActivityName.STOWED, ActivityName.FAULTED}
    for tracking_on, continues in ((False, False), (True, False), (True, True)):
        now = dict.fromkeys(("T1", "T2"), Doing(activity, tracking_on, continues))
        led = activity in always or (tracking_on and activity in later) or continues
        for found in (against_another_clock(-AHEAD, now), led_by_the_location(now)):
            assert len(found) == (2 if led else 0)
            assert all(key in one.message + one.hint for key, one in zip(("T1", "T2"), found, strict=False))
            is_stowed = activity in {ActivityName.STOWING, ActivityName.STOWED}
            assert all(one.hint.startswith("Wait until") is is_stowed for one in found), "nobody ends a stow"
        assert against_another_clock(timedelta(minutes=1), now) == ()


@pytest.mark.parametrize("activity", list(ActivityName))
def test_who_takes_no_other_settings(activity: ActivityName) -> None:
    at_rest = activity in {ActivityName.HOLDING, ActivityName.FAULTED}
    found = against_other_settings("T1", Doing(activity, tracking_on=True, continues=False), is_moving=False)
    assert (found is None) is at_rest
    for continues, is_moving in ((True, False), (False, True)):
        now = Doing(activity, tracking_on=True, continues=continues)
        refused = against_other_settings("T1", now, is_moving=is_moving)
        assert refused is not None
        assert (refused.code, refused.hint) == ("tracker_busy", "Stop T1 first.")


async def test_another_time_zone_moves_no_target(plant: Plant) -> None:
    """It is a matter of how instants are written; a tracker that tracks takes it unasked."""
    await tracks(plant)
    before = plant.tracker().target
    place = plant.site.model.state.location
    assert place is not None
    for order in (SetLocation(place, "America/Lima"), SetClock("system", None, "Asia/Tokyo")):
        await plant.ask(order)
        await plant.forward(seconds=0.2)
        after = plant.tracker()
        assert plant.site.model.state.time_zone == order.time_zone
        assert after.activity is ActivityName.TRACKING
        assert before is not None
        assert after.target is not None
        assert after.target.azimuth_deg == pytest.approx(before.azimuth_deg, abs=0.01)
