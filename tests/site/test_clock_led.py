"""No clock is moved by more than a minute under a tracker that is led by it."""

from dataclasses import replace
from datetime import timedelta

import pytest

from app.link.messages import ApplySightings, ConfigureTracker, SetClock, SetLocation
from app.sun.position import Algorithm
from app.tracker.access.location_change import (
    Doing,
    against_another_aim,
    against_another_clock,
    against_other_settings,
    led_by_the_location,
)
from app.tracker.commands.commands import CommandRejected, SelectMode, Stop, Track
from app.tracker.state.activity import HOLDING
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


LED = {
    ActivityName.TRACKING: (True, True, True),
    ActivityName.SHOWING: (True, True, True),
} | dict.fromkeys(set(ActivityName) - {ActivityName.TRACKING, ActivityName.SHOWING}, (False, True, True))
"""Who is led while tracking is off, while it is on, and while it goes on with nobody asked."""
TRACKING_IS = ((False, False), (True, False), (True, True))


@pytest.mark.parametrize("activity", list(ActivityName))
def test_who_is_led_by_the_clock_and_by_the_location(activity: ActivityName) -> None:
    for (tracking_on, continues), led in zip(TRACKING_IS, LED[activity], strict=True):
        now = dict.fromkeys(("T1", "T2"), Doing(activity, tracking_on, continues))
        for found in (against_another_clock(-AHEAD, now), led_by_the_location(now)):
            assert len(found) == (2 if led else 0)
            assert all(key in one.message + one.hint for key, one in zip(("T1", "T2"), found, strict=False))
            waits = continues and activity in {ActivityName.STOWING, ActivityName.STOWED}
            assert all(one.hint.startswith("Wait until") is waits for one in found), "nobody ends such a stow"
        assert against_another_clock(timedelta(minutes=1), now) == ()


@pytest.mark.parametrize("activity", list(ActivityName))
def test_who_takes_no_other_settings(activity: ActivityName) -> None:
    at_rest = activity in {ActivityName.HOLDING, ActivityName.FAULTED}
    for tracking_on, continues in TRACKING_IS:
        now = Doing(activity, tracking_on, continues)
        assert (against_other_settings("T1", now, is_moving=False) is None) is at_rest
        aim = against_another_aim("T1", now, is_moving=False)
        assert (aim is None) is (at_rest and not tracking_on), "a restart would go on tracking"
        moves = [one("T1", now, is_moving=True) for one in (against_other_settings, against_another_aim)]
        for refused in (*moves, *((aim,) if aim else ())):
            assert refused is not None
            assert (refused.code, refused.hint) == ("tracker_busy", "Stop T1 first.")


async def test_no_restart_tracks_by_what_was_changed_since_it_was_interrupted(plant: Plant) -> None:
    """A fault that was reset leaves tracking switched on, and a restart goes on with it."""
    await tracks(plant)
    loop = plant.site.model.tracker("T1")
    plant.site.model.tracker("T1").controller._state.activity = HOLDING
    await plant.forward(seconds=1)
    assert plant.tracker().activity is ActivityName.HOLDING
    assert loop.memory.tracking_on
    place = plant.site.model.state.location
    assert place is not None
    config = loop.config
    for order in (
        SetClock("manual", plant.site.model.now() + AHEAD),
        SetLocation(replace(place, latitude_deg=-41.0), "UTC"),
        ConfigureTracker(replace(config, algorithm=Algorithm.COOPER)),
        ApplySightings("T1", ()),
    ):
        with pytest.raises(CommandRejected, match="Tracking is still switched on"):
            await plant.ask(order)
    await plant.ask(ConfigureTracker(replace(config, name="Renamed")))
    await plant.ask(Stop())
    await plant.forward(seconds=2)
    await plant.ask(ConfigureTracker(replace(config, algorithm=Algorithm.COOPER)))


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
