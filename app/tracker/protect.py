"""What stands between every reading and every motion: link, drive, zero, encoder, switches, following."""

from datetime import datetime, timedelta
from typing import assert_never

from app.tracker import guards
from app.tracker.activities.measuring import is_silent
from app.tracker.activity import (
    Faulted,
    Holding,
    Homing,
    Jogging,
    Measuring,
    Moving,
    SettingHome,
    Showing,
    Stopping,
    Stowed,
    Stowing,
    Tracking,
)
from app.tracker.axes import Axis
from app.tracker.controller_state import HALTED, ControllerState
from app.tracker.following_error import watch
from app.tracker.motion import AxisCommand, DriveCommand, Feedback, Halt
from app.tracker.mounts.capabilities import axis_of
from app.tracker.reason import Reason
from app.tracker.snapshot import EventKind
from app.tracker.transitions import fail, interrupt, leave, lose_home

JOG_MISSES = 2


def miss(mind: ControllerState, now: datetime, silence: timedelta) -> None:
    """Count a reading that failed: two end a jog, and after the silence the drive is lost and all ends."""
    mind.misses += 1
    if mind.misses >= JOG_MISSES and isinstance(mind.activity, Jogging):
        leave(mind, "the drive did not answer.")
    since = mind.feedback_at or mind.started_at or now
    if mind.lost or now - since <= silence:
        return
    mind.lost = True
    mind.aftermath = None
    reason = Reason(
        "drive_lost",
        f"The drive of {mind.config.name} did not answer.",
        "Check the drive's power and network cable, then press Start tracking.",
    )
    mind.say(EventKind.DRIVE_LOST, f"The drive of {mind.config.name} no longer answers.")
    interrupt(mind, reason)


def found(mind: ControllerState, feedback: Feedback) -> None:
    """Note a good reading; after a loss say that the drive is back, and what it did meanwhile.

    Nothing resumes by itself.
    """
    mind.misses = 0
    if not mind.lost:
        return
    mind.lost = False
    mind.aftermath = guards.came_back(mind.config.name, mind.feedback, feedback)
    mind.say(EventKind.DRIVE_FOUND, mind.aftermath.message, code=mind.aftermath.code)


def protect(mind: ControllerState, before: Feedback | None, feedback: Feedback, elapsed: timedelta) -> None:
    """End what must not go on in the light of a reading, so long after the one before."""
    suspicious = feedback.fault_code or feedback.azimuth.at_upper_limit or feedback.elevation.at_upper_limit
    if suspicious and not is_silent(mind):
        _refuse_fault(mind, feedback)
    if before is not None and before is not feedback:
        _compare(mind, before, feedback, elapsed.total_seconds())
    home = mind.memory.home
    if home is not None and not isinstance(mind.activity, SettingHome):
        doubt = guards.home_doubt(mind.config, home, feedback)
        if doubt is not None:
            _doubt_home(mind, doubt)


def _refuse_fault(mind: ControllerState, feedback: Feedback) -> None:
    """Latch the drive's own fault or contradicting limit switches."""
    name = mind.config.name
    reason = guards.drive_fault(name, feedback)
    if reason is not None:
        lose_home(mind, reason)
    else:
        reason = guards.wiring_fault(mind.config, feedback)
    if reason is not None and not isinstance(mind.activity, Faulted):
        fail(mind, reason)


def _compare(mind: ControllerState, before: Feedback, feedback: Feedback, elapsed_s: float) -> None:
    """Judge what changed between two readings."""
    restarted = guards.restart(mind.config.name, before, feedback)
    if restarted is not None:
        _doubt_home(mind, restarted)
        return
    if feedback.watchdog_tripped and not before.watchdog_tripped and not is_silent(mind):
        _watchdog_tripped(mind)
    if isinstance(mind.activity, SettingHome | Homing):
        return
    jumped = guards.jump(mind.config, before, feedback, elapsed_s)
    if jumped is not None:
        _doubt_home(mind, jumped)


def _doubt_home(mind: ControllerState, reason: Reason) -> None:
    mind.guards = {}
    lose_home(mind, reason)
    interrupt(mind, reason)


def _watchdog_tripped(mind: ControllerState) -> None:
    """Say that the drive stopped for want of commands; only tracking goes on after that."""
    reason = Reason(
        "watchdog_tripped",
        f"The drive of {mind.config.name} stopped automatically because no command reached it in time.",
        "Check the network and the load of the controller's computer.",
    )
    match mind.activity:
        case Holding() | Stopping() | Faulted() | Stowed():
            return
        case Tracking() | Stowing():
            pass
        case Jogging() | Moving() | SettingHome() | Homing() | Showing() | Measuring():
            interrupt(mind, reason)
        case _:
            assert_never(mind.activity)
    mind.say(EventKind.STOPPED, reason.message, code=reason.code)


def obey_switches(mind: ControllerState, command: DriveCommand, feedback: Feedback) -> DriveCommand:
    """Return the command; halted, and the activity ended, if it led on into a pressed limit switch."""
    tolerance_deg = mind.config.in_position_deg
    for axis in Axis:
        told, seen = axis_command(command, axis), guards.axis_feedback(feedback, axis)
        if guards.heads_into_switch(told, seen, tolerance_deg):
            reason = Reason(
                "limit_switch",
                f"The {axis_of(mind.config, axis)} has reached its limit switch.",
                "Jog the axis away from the switch and check the home position.",
            )
            mind.say(EventKind.LIMIT_REACHED, reason.message, axis=axis)
            interrupt(mind, reason)
            return HALTED
    return command


def axis_command(command: DriveCommand, axis: Axis) -> AxisCommand:
    """Return what one axis is told."""
    return command.azimuth if axis is Axis.AZIMUTH else command.elevation


def check_following(mind: ControllerState, feedback: Feedback, now: datetime) -> None:
    """Compare every commanded axis with its reference, and latch a fault where it does not follow."""
    if isinstance(mind.command.azimuth, Halt) and isinstance(mind.command.elevation, Halt):
        if mind.watches:
            mind.watches = {}
        return
    watches = {}
    for axis in Axis:
        seen, config = guards.axis_feedback(feedback, axis), mind.config.axis(axis)
        before, allowed_deg = mind.watches.get(axis), mind.config.following_error_deg
        watched = watch(before, config, axis_command(mind.command, axis), seen, now, allowed_deg)
        if watched is not None:
            watches[axis] = watched
    mind.watches = watches
    for axis, watched in watches.items():
        if watched.turns_wrongly(guards.axis_feedback(feedback, axis).position_deg, now):
            reason = guards.wrong_way(mind.config, axis)
            lose_home(mind, reason)
        elif not watched.follows(now):
            reason = guards.not_following(mind.config, axis, watched)
        else:
            continue
        mind.watches = {}
        fail(mind, reason)
        return
