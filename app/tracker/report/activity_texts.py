"""What a tracker is doing, as one sentence for the person in front of it."""

from typing import assert_never

from app.base.angles import separation_deg
from app.base.message import N_, Message, Word, plain, say
from app.tracker.activities.approach import is_approaching
from app.tracker.activities.setpoint_scheduler import trigger_deg
from app.tracker.activities.tracking import SUN_DPS
from app.tracker.mounts.capabilities import axis_words
from app.tracker.mounts.mount import sky
from app.tracker.report.progress import step_progress
from app.tracker.settings.protections import StowName
from app.tracker.settings.stepped import clock_text
from app.tracker.settings.strategy import Continuous, Deadband, EncoderDeadband, Interval, Stepped
from app.tracker.state.activity import (
    Activity,
    Faulted,
    Holding,
    Homing,
    Jogging,
    Measuring,
    MoveKind,
    Moving,
    SettingHome,
    Showing,
    Stopping,
    Stowed,
    Stowing,
    Tracking,
    TrackPhase,
)
from app.tracker.state.controller_state import ControllerState
from app.tracker.state.snapshot import ShowPhase
from app.tracker.supervision.weather_protection import hold_reason

_MOVING = {
    MoveKind.MOVE: N_("Moving to the requested orientation"),
    MoveKind.PARK: N_("Moving to the park position"),
    MoveKind.STEP: N_("Moving by one increment"),
    MoveKind.DIRECTION: N_("Moving for the direction test: watch which way the panel turns"),
    MoveKind.SCALE: N_("Moving for the scale test: measure how far the panel turns"),
}
_GOING = {
    StowName.WIND: N_("Going to the wind stow position"),
    StowName.SNOW: N_("Going to the snow stow position"),
    StowName.HAIL: N_("Going to the hail stow position"),
    StowName.CLEANING: N_("Going to the cleaning position"),
    StowName.MAINTENANCE: N_("Going to the maintenance position"),
    StowName.PARK: N_("Moving to the park position"),
}
_PLAIN: dict[type[Activity], Message] = {
    SettingHome: N_("Setting the home position"),
    Homing: N_("Searching for the home switches"),
    Stopping: N_("Stopping"),
}
_SHOWING = {
    ShowPhase.GOING_TO_START: N_("Show: going to the start position"),
    ShowPhase.READY: N_("Show: ready at the start position"),
    ShowPhase.RUNNING: N_("Show: running"),
    ShowPhase.PAUSED: N_("Show: paused"),
}


def activity_text(state: ControllerState) -> Message:
    """Return what the tracker is doing, without times of day (pages know the local time)."""
    if state.connection.lost:
        return N_("No connection to the drive")
    return _doing(state, state.activity)


def _doing(state: ControllerState, activity: Activity) -> Message:
    match activity:
        case Holding():
            return N_("Holding; tracking needs the operator") if state.memory.tracking_on else N_("Holding")
        case Jogging():
            return say("Jogging {what}, {speed}", what=_jog(state, activity), speed=activity.speed)
        case Moving() | Measuring() | Stowing() | Stowed():
            return _by_order(activity)
        case SettingHome() | Homing() | Stopping():
            return _PLAIN[type(activity)]
        case Tracking():
            return (
                _approaching(state)
                if is_approaching(state)
                else say("Tracking: {what}", what=_tracking(state, activity))
            )
        case Showing():
            return _SHOWING[activity.phase]
        case Faulted():
            return say("Stopped by a fault: {message}", message=activity.reason.message)
    assert_never(activity)


def _by_order(activity: Moving | Measuring | Stowing | Stowed) -> Message:
    if isinstance(activity, Stowing):
        return _GOING[activity.stow]
    if isinstance(activity, Stowed):
        return say("Stowed: {stow}", stow=activity.stow)
    if isinstance(activity, Moving):
        return _MOVING[activity.kind]
    if activity.speed is not None:
        return N_("Stop test: stopping") if activity.asked else N_("Stop test: accelerating")
    return (
        N_("Communication-loss test: no commands are sent")
        if activity.asked
        else N_("Communication-loss test: moving slowly")
    )


def _jog(state: ControllerState, jogging: Jogging) -> Message:
    words = axis_words(state.config.mount, jogging.axis)
    if words is None:
        return plain(jogging.axis)
    way = words.grows if jogging.direction > 0 else words.falls
    return say("{axis} {way}", axis=Word(words.title.lower()), way=Word(way))


def _approaching(state: ControllerState) -> Message:
    return (
        N_("Moving to the sun")
        if state.countdowns.motion is None
        else N_("Moving to the sun in a few seconds")
    )


def _tracking(state: ControllerState, tracking: Tracking) -> Message:
    night = tracking.phase is TrackPhase.NIGHT
    if tracking.run is not None:
        if night:
            return N_("the sun is down, going to the night position")
        is_fixed = tracking.phase is TrackPhase.FIXED
        return N_("moving to the fixed orientation") if is_fixed else N_("moving to the sun")
    if tracking.phase is TrackPhase.RESTING or state.countdowns.motion is not None:
        return _resting(state)
    return _standing(state, tracking)


def _resting(state: ControllerState) -> Message:
    why = hold_reason(state)
    return (
        N_("moves in a few seconds")
        if why is None
        else say("holding its position. {message}", message=why.message)
    )


def _standing(state: ControllerState, tracking: Tracking) -> Message:
    match tracking.phase:
        case TrackPhase.NIGHT:
            return N_("holding until sunrise")
        case TrackPhase.PAUSED:
            return N_("holding until the site's clock is trusted again")
        case TrackPhase.RESTING:
            return _resting(state)
        case TrackPhase.FIXED:
            return N_("holding the fixed orientation")
        case TrackPhase.LIMITED:
            return N_("at the edge of the axes' range, as near to the sun as possible")
        case TrackPhase.KEYHOLE:
            return N_("passing the zenith as fast as the azimuth axis can")
        case TrackPhase.FOLLOWING:
            return _next_move(state)
    assert_never(tracking.phase)


def _next_move(state: ControllerState) -> Message:
    """Return when the panel will have to follow, by the tracker's strategy."""
    match state.config.strategy:
        case Continuous():
            return N_("following the sun continuously")
        case Deadband():
            return _next_run(state)
        case EncoderDeadband(counts):
            return say("holding until an axis is off by {counts} counts", counts=counts)
        case Interval(minutes):
            return say("holding until the next move, one every {minutes} min", minutes=minutes)
        case Stepped():
            return _held_step(state)
    assert_never(state.config.strategy)


def _next_run(state: ControllerState) -> Message:
    """Return when the sun will have moved so far that the panel has to follow."""
    feedback, target = state.feedback, state.target
    if feedback is None or target is None:
        return N_("pointing at the sun")
    pointing = state.memory.pointing
    faced = sky(state.config, pointing, feedback.azimuth.position_deg, feedback.elevation.position_deg)
    off_deg = separation_deg(faced.azimuth_deg, faced.elevation_deg, target.azimuth_deg, target.elevation_deg)
    minutes = (trigger_deg(state.config) - off_deg) / SUN_DPS / 60.0
    return (
        say("next move in about {minutes} min", minutes=round(minutes))
        if minutes >= 1.0
        else N_("next move within a minute")
    )


def _held_step(state: ControllerState) -> Message:
    held = step_progress(state)
    if held is None:
        return N_("holding the position of its program")
    text = say("holding step {step} of {steps} of {name}", step=held.step, steps=held.steps, name=held.name)
    return (
        text
        if held.next_h is None
        else say(
            "{text} until {next_h} {time_base} time",
            text=text,
            next_h=clock_text(held.next_h),
            time_base=held.time_base,
        )
    )
