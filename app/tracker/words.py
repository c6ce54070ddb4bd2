"""What a tracker is doing, as one sentence for the person in front of it."""

from typing import assert_never

from app.angles import separation_deg
from app.tracker.activities.tracking import SUN_DPS
from app.tracker.activity import (
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
from app.tracker.approach import is_approaching
from app.tracker.controller_state import ControllerState
from app.tracker.mount import sky
from app.tracker.mounts.capabilities import axis_words
from app.tracker.programs.stepped import clock_text
from app.tracker.progress import step_progress
from app.tracker.setpoint_scheduler import trigger_deg
from app.tracker.snapshot import ShowPhase
from app.tracker.strategy import Continuous, Deadband, EncoderDeadband, Interval, Stepped
from app.tracker.weather_protection import hold_reason

_MOVING = {
    MoveKind.MOVE: "Moving to the requested orientation",
    MoveKind.PARK: "Moving to the park position",
    MoveKind.STEP: "Moving by one increment",
    MoveKind.DIRECTION: "Moving for the direction test: watch which way the panel turns",
    MoveKind.SCALE: "Moving for the scale test: measure how far the panel turns",
}
_PLAIN: dict[type[Activity], str] = {
    SettingHome: "Setting the home position",
    Homing: "Searching for the home switches",
    Stopping: "Stopping",
}
_SHOWING = {
    ShowPhase.GOING_TO_START: "Show: going to the start position",
    ShowPhase.READY: "Show: ready at the start position",
    ShowPhase.RUNNING: "Show: running",
    ShowPhase.PAUSED: "Show: paused",
}


def activity_text(mind: ControllerState) -> str:
    """Return what the tracker is doing, without times of day (pages know the local time)."""
    if mind.lost:
        return "No communication with the drive; a stop command was sent"
    return _doing(mind, mind.activity)


def _doing(mind: ControllerState, activity: Activity) -> str:
    match activity:
        case Holding():
            return "Holding; tracking needs the operator" if mind.memory.tracking_on else "Holding"
        case Jogging():
            return f"Jogging {_jog(mind, activity)}, {activity.speed}"
        case Moving() | Measuring() | Stowing() | Stowed():
            return _by_order(activity)
        case SettingHome() | Homing() | Stopping():
            return _PLAIN[type(activity)]
        case Tracking():
            return _approaching(mind) if is_approaching(mind) else f"Tracking: {_tracking(mind, activity)}"
        case Showing():
            return _SHOWING[activity.phase]
        case Faulted():
            return f"Stopped by a fault: {activity.reason.message}"
    assert_never(activity)


def _by_order(activity: Moving | Measuring | Stowing | Stowed) -> str:
    if isinstance(activity, Stowing):
        return f"Going to the stow position {activity.stow}"
    if isinstance(activity, Stowed):
        return f"Stowed: {activity.stow}"
    if isinstance(activity, Moving):
        return _MOVING[activity.kind]
    if activity.speed is not None:
        return "Stop test: stopping" if activity.asked else "Stop test: accelerating"
    return (
        "Communication-loss test: no commands are sent"
        if activity.asked
        else "Communication-loss test: moving slowly"
    )


def _jog(mind: ControllerState, jogging: Jogging) -> str:
    words = axis_words(mind.config.mount, jogging.axis)
    if words is None:
        return jogging.axis
    return f"{words.title.lower()} {words.grows if jogging.direction > 0 else words.falls}"


def _approaching(mind: ControllerState) -> str:
    return "Moving to the sun" if mind.warning is None else "Moving to the sun in a few seconds"


def _tracking(mind: ControllerState, tracking: Tracking) -> str:
    night = tracking.phase is TrackPhase.NIGHT
    if tracking.run is not None:
        if night:
            return "the sun is down, going to the night position"
        is_fixed = tracking.phase is TrackPhase.FIXED
        return "moving to the fixed orientation" if is_fixed else "moving to the sun"
    if tracking.phase is TrackPhase.RESTING or mind.warning is not None:
        return _resting(mind)
    return _standing(mind, tracking)


def _resting(mind: ControllerState) -> str:
    why = hold_reason(mind)
    return "moves in a few seconds" if why is None else f"holding its position. {why.message}"


def _standing(mind: ControllerState, tracking: Tracking) -> str:
    match tracking.phase:
        case TrackPhase.NIGHT:
            return "holding until sunrise"
        case TrackPhase.PAUSED:
            return "holding until the site's clock is trusted again"
        case TrackPhase.RESTING:
            return _resting(mind)
        case TrackPhase.FIXED:
            return "holding the fixed orientation"
        case TrackPhase.LIMITED:
            return "at the edge of the axes' range, as near to the sun as possible"
        case TrackPhase.KEYHOLE:
            return "passing the zenith as fast as the azimuth axis can"
        case TrackPhase.FOLLOWING:
            return _next_move(mind)
    assert_never(tracking.phase)


def _next_move(mind: ControllerState) -> str:
    """Return when the panel will have to follow, by the tracker's strategy."""
    match mind.config.strategy:
        case Continuous():
            return "following the sun continuously"
        case Deadband():
            return _next_run(mind)
        case EncoderDeadband(counts):
            return f"holding until an axis is off by {counts} counts"
        case Interval(minutes):
            return f"holding until the next move, one every {minutes} min"
        case Stepped():
            return _held_step(mind)
    assert_never(mind.config.strategy)


def _next_run(mind: ControllerState) -> str:
    """Return when the sun will have moved so far that the panel has to follow."""
    feedback, target = mind.feedback, mind.target
    if feedback is None or target is None:
        return "pointing at the sun"
    pointing = mind.memory.pointing
    faced = sky(mind.config, pointing, feedback.azimuth.position_deg, feedback.elevation.position_deg)
    off_deg = separation_deg(faced.azimuth_deg, faced.elevation_deg, target.azimuth_deg, target.elevation_deg)
    minutes = (trigger_deg(mind.config) - off_deg) / SUN_DPS / 60.0
    return f"next move in about {round(minutes)} min" if minutes >= 1.0 else "next move within a minute"


def _held_step(mind: ControllerState) -> str:
    held = step_progress(mind)
    if held is None:
        return "holding the position of its program"
    text = f"holding step {held.step} of {held.steps} of {held.name}"
    return text if held.next_h is None else f"{text} until {clock_text(held.next_h)} {held.time_base} time"
