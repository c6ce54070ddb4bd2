"""What ends a motion, tick by tick: which reading is one too few, and what is said of it."""

from dataclasses import replace
from datetime import timedelta

import pytest

from app.tracker.commands.commands import Jog, Move, Track
from app.tracker.controller import Controller
from app.tracker.motion import guards
from app.tracker.settings.axes import Axis, AxisConfig
from app.tracker.settings.config import Orientation
from app.tracker.state.snapshot import ActivityName, EventKind
from app.tracker.values.motion import Feedback
from tests.tracker.plant import BLANK, CONFIG, READY
from tests.tracker.scripted import CAPABILITIES, Scripted

ALONE = [(Axis.AZIMUTH, Orientation(90.0, 0.0)), (Axis.ELEVATION, Orientation(0.0, 45.0))]
"""A move that turns one axis alone, from where both are zero."""


@pytest.fixture
def script() -> Scripted:
    begun = Scripted(READY)
    begun.forward(0.5)
    return begun


def jogging(script: Scripted) -> Scripted:
    script.tick()
    script.ask(Jog("p", Axis.AZIMUTH, 1, lease=timedelta(milliseconds=240)))
    assert script.controller.activity is ActivityName.JOGGING
    return script


def reading(script: Scripted) -> Feedback:
    assert script.reading is not None
    return script.reading


def test_two_missed_readings_end_a_jog_and_one_does_not(script: Scripted) -> None:
    sound = reading(jogging(script))
    script.reading = None
    script.tick()
    assert script.controller.activity is ActivityName.JOGGING
    script.reading = sound
    script.tick()
    script.reading = None
    script.tick()
    assert script.controller.activity is ActivityName.JOGGING, "a good reading begins the count anew"
    script.tick()
    assert script.controller.activity is ActivityName.HOLDING
    (ended,) = script.happened(EventKind.JOG_ENDED)
    assert ended.data["outcome"] == "interrupted"
    assert ended.message.endswith("the drive did not answer.")


def test_other_motion_ends_after_more_than_600_ms_without_a_reading(script: Scripted) -> None:
    script.ask(Move(Orientation(90.0, 45.0)))
    script.reading = None
    script.forward(0.6)
    assert script.controller.activity is ActivityName.MOVING
    assert not script.happened(EventKind.DRIVE_LOST)
    script.forward(0.1)
    assert script.controller.activity is ActivityName.HOLDING
    (lost,) = script.happened(EventKind.DRIVE_LOST)
    assert lost.message == "The drive of Tracker 1 no longer answers."
    script.forward(5.0)
    assert len(script.happened(EventKind.DRIVE_LOST)) == 1


def test_a_drive_that_answers_again_is_told_with_what_it_did(script: Scripted) -> None:
    sound = reading(script)
    script.reading = None
    script.forward(1.0)
    script.reading = sound
    script.forward(1.0)
    (found,) = script.happened(EventKind.DRIVE_FOUND)
    assert found.data["code"] == "drive_back"
    assert found.message == "The drive of Tracker 1 answers again. The drive reports no restart."
    assert script.snapshot.measured is not None
    script.reading = None
    script.forward(0.6)
    assert len(script.happened(EventKind.DRIVE_LOST)) == 1, "it is lost anew only after as long again"
    script.forward(0.1)
    assert len(script.happened(EventKind.DRIVE_LOST)) == 2


def test_what_the_drive_did_is_forgotten_when_it_is_lost_again(script: Scripted) -> None:
    sound = reading(script)
    script.reading = None
    script.forward(1.0)
    script.reading = sound
    script.forward(0.2)
    assert script.controller._state.connection.aftermath is not None
    script.reading = None
    script.forward(1.0)
    assert script.controller._state.connection.aftermath is None


def test_a_fault_of_the_drive_is_told_with_the_trackers_name(script: Scripted) -> None:
    script.sees(fault_code=7)
    script.tick()
    assert script.controller.memory.fault_code == "drive_fault"
    assert "The drive of Tracker 1 reports fault code 7." in script.controller.memory.fault_text
    assert script.controller.memory.home is None


@pytest.mark.parametrize("activity", ["move", "track", "hold"])
def test_a_tripped_watchdog_is_told_once_and_ends_what_does_not_track(
    script: Scripted, activity: str
) -> None:
    if activity != "hold":
        script.ask(Track() if activity == "track" else Move(Orientation(90.0, 45.0)))
    sound = reading(script)
    script.reading = replace(sound, watchdog_tripped=True)
    script.forward(0.3)
    told = script.happened(EventKind.STOPPED)
    assert [event.data.get("code") for event in told] == ([] if activity == "hold" else ["watchdog_tripped"])
    assert (script.controller.activity is ActivityName.TRACKING) is (activity == "track")
    assert script.controller.activity is not ActivityName.MOVING


def test_an_axis_that_is_blocked_is_a_fault_only_after_its_patience(script: Scripted) -> None:
    script.ask(Move(Orientation(90.0, 45.0)))
    waited = 0
    while script.controller.activity is ActivityName.MOVING and waited < 100:
        script.forward(0.1)
        waited += 1
    assert script.controller.memory.fault_code == "following_error"
    assert script.controller.memory.home is not None, "a blocked axis still knows its zero"
    assert 10 < waited < 60


def test_a_zero_that_an_axis_has_lost_is_not_believed(script: Scripted) -> None:
    sound = reading(script)
    script.reading = replace(sound, elevation=replace(sound.elevation, homed=False))
    script.tick()
    assert script.controller.memory.home is None
    assert [event.data["code"] for event in script.happened(EventKind.HOME_LOST)] == ["not_homed"]


def test_a_zero_of_another_life_of_the_drive_is_not_believed_from_the_first_reading() -> None:
    begun = Scripted(READY)
    begun.reading = replace(reading(begun), boot_count=2)
    begun.tick()
    assert begun.controller.memory.home is None


def test_a_drive_that_restarts_ends_a_jog_though_no_zero_is_lost() -> None:
    script = jogging(Scripted(BLANK))
    script.sees(boot_count=2)
    script.tick()
    assert script.controller.activity is ActivityName.HOLDING
    (ended,) = script.happened(EventKind.JOG_ENDED)
    assert "The drive of Tracker 1 has restarted" in ended.message


@pytest.mark.parametrize("axis", list(Axis))
def test_a_switch_that_is_reached_is_told_with_its_axis(script: Scripted, axis: Axis) -> None:
    script.ask(Move(Orientation(90.0, 45.0)))
    sound = reading(script)
    pressed = replace(sound.azimuth, at_upper_limit=True)
    script.reading = replace(sound, **{str(axis): pressed})
    script.tick()
    (told,) = script.happened(EventKind.LIMIT_REACHED)
    assert told.data["axis"] is axis
    assert str(axis) in told.message


@pytest.mark.parametrize(("axis", "target"), ALONE)
def test_a_switch_stops_the_axis_that_heads_for_it_and_no_other(
    script: Scripted, axis: Axis, target: Orientation
) -> None:
    script.ask(Move(target))
    sound = reading(script)
    other = Axis.ELEVATION if axis is Axis.AZIMUTH else Axis.AZIMUTH
    beside = replace(guards.axis_feedback(sound, other), at_upper_limit=True)
    script.reading = replace(sound, **{str(other): beside})
    script.tick()
    assert script.controller.activity is ActivityName.MOVING
    ahead = replace(guards.axis_feedback(sound, axis), at_upper_limit=True)
    script.reading = replace(sound, **{str(axis): ahead})
    script.tick()
    assert script.controller.activity is ActivityName.HOLDING
    assert [event.data["axis"] for event in script.happened(EventKind.LIMIT_REACHED)] == [axis]


@pytest.mark.parametrize(("axis", "target"), ALONE)
def test_an_axis_is_judged_by_its_own_speed_and_told_by_its_name(axis: Axis, target: Orientation) -> None:
    slow = AxisConfig(0.0, 90.0, 0.1, 1.0, 0.05, 0.1)
    config = replace(CONFIG, elevation=slow) if axis is Axis.AZIMUTH else replace(CONFIG, azimuth=slow)
    script = Scripted(READY)
    script.controller = Controller(config, READY, CAPABILITIES)
    script.forward(0.5)
    script.ask(Move(target))
    script.forward(10.0)
    assert script.controller.memory.fault_code == "following_error", "the other axis would need 20 s"
    assert f"{axis} axis" in script.controller.memory.fault_text
