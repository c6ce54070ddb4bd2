"""What stands between every reading and every motion: link, drive, zero, encoder, switches, following."""

from datetime import datetime, timedelta
from typing import assert_never

from app.base.message import N_, say
from app.tracker.motion import guards
from app.tracker.motion.following_error import watch
from app.tracker.mounts.capabilities import axis_of
from app.tracker.settings.axes import Axis
from app.tracker.state.activity import (
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
from app.tracker.state.controller_state import HALTED, ControllerState
from app.tracker.state.home_trust import lose_home
from app.tracker.state.parts import Connection
from app.tracker.state.snapshot import EventKind
from app.tracker.state.transitions import fail, interrupt, leave
from app.tracker.supervision.machine_guard import forget_guards, is_silent
from app.tracker.values.motion import AxisCommand, DriveCommand, Feedback, Halt
from app.tracker.values.reason import Reason

JOG_MISSES = 2


def miss(state: ControllerState, now: datetime, silence: timedelta) -> None:
    """Count a reading that failed: two end a jog, and after the silence the drive is lost and all ends."""
    state.connection = before = state.connection._replace(misses=state.connection.misses + 1)
    if before.misses >= JOG_MISSES and isinstance(state.activity, Jogging):
        leave(state, N_("the drive did not answer."))
    since = state.feedback_at or state.started_at or now
    if before.lost or now - since <= silence:
        return
    state.connection = Connection(before.misses, lost=True)
    reason = Reason(
        "drive_lost",
        say("The drive of {name} did not answer.", name=state.config.name),
        N_("Check the drive's power and network cable, then press Start tracking."),
    )
    state.say(EventKind.DRIVE_LOST, say("The drive of {name} no longer answers.", name=state.config.name))
    interrupt(state, reason)


def found(state: ControllerState, feedback: Feedback) -> None:
    """Note a good reading; after a loss say that the drive is back, and what it did meanwhile.

    Nothing resumes by itself.
    """
    if not state.connection.lost:
        state.connection = state.connection._replace(misses=0)
        return
    aftermath = guards.came_back(state.config.name, state.feedback, feedback)
    state.connection = Connection(aftermath=aftermath)
    state.say(EventKind.DRIVE_FOUND, aftermath.message, code=aftermath.code)


def forget_aftermath(state: ControllerState) -> None:
    """Show no longer what the drive did while it did not answer: somebody has commanded something since."""
    if state.connection.aftermath is not None:
        state.connection = state.connection._replace(aftermath=None)


def protect(state: ControllerState, before: Feedback | None, feedback: Feedback, elapsed: timedelta) -> None:
    """End what must not go on in the light of a reading, so long after the one before."""
    suspicious = feedback.fault_code or feedback.azimuth.at_upper_limit or feedback.elevation.at_upper_limit
    if suspicious and not is_silent(state):
        _refuse_fault(state, feedback)
    refused = None if state.seen is None else state.seen.refused
    if refused is not None and not isinstance(state.activity, Faulted):
        fail(state, refused)
    if before is not None and before is not feedback:
        _compare(state, before, feedback, elapsed.total_seconds())
    home = state.memory.home
    if home is not None and not isinstance(state.activity, SettingHome):
        doubt = guards.home_doubt(state.config, home, feedback)
        if doubt is not None:
            _doubt_home(state, doubt)


def _refuse_fault(state: ControllerState, feedback: Feedback) -> None:
    """Latch the drive's own fault or contradicting limit switches."""
    name = state.config.name
    reason = guards.drive_fault(name, feedback)
    if reason is not None:
        lose_home(state, reason)
    else:
        reason = guards.wiring_fault(state.config, feedback)
    if reason is not None and not isinstance(state.activity, Faulted):
        fail(state, reason)


def _compare(state: ControllerState, before: Feedback, feedback: Feedback, elapsed_s: float) -> None:
    """Judge what changed between two readings."""
    restarted = guards.restart(state.config.name, before, feedback)
    if restarted is not None:
        _doubt_home(state, restarted)
        return
    if feedback.watchdog_tripped and not before.watchdog_tripped and not is_silent(state):
        _watchdog_tripped(state)
    if isinstance(state.activity, SettingHome | Homing):
        return
    jumped = guards.jump(state.config, before, feedback, elapsed_s)
    if jumped is not None:
        _doubt_home(state, jumped)


def _doubt_home(state: ControllerState, reason: Reason) -> None:
    forget_guards(state)
    lose_home(state, reason)
    interrupt(state, reason)


def _watchdog_tripped(state: ControllerState) -> None:
    """Say that the drive stopped for want of commands; only tracking goes on after that."""
    reason = Reason(
        "watchdog_tripped",
        say(
            "The drive of {name} stopped automatically because no command reached it in time.",
            name=state.config.name,
        ),
        N_("Check the network and the load of the controller's computer."),
    )
    match state.activity:
        case Holding() | Stopping() | Faulted() | Stowed():
            return
        case Tracking() | Stowing():
            pass
        case Jogging() | Moving() | SettingHome() | Homing() | Showing() | Measuring():
            interrupt(state, reason)
        case _:
            assert_never(state.activity)
    state.say(EventKind.STOPPED, reason.message, code=reason.code)


def obey_switches(state: ControllerState, command: DriveCommand, feedback: Feedback) -> DriveCommand:
    """Return the command; halted, and the activity ended, if it led on into a pressed limit switch."""
    tolerance_deg = state.config.in_position_deg
    for axis in Axis:
        told, seen = axis_command(command, axis), guards.axis_feedback(feedback, axis)
        if guards.heads_into_switch(told, seen, tolerance_deg):
            reason = Reason(
                "limit_switch",
                say("The {config} has reached its limit switch.", config=axis_of(state.config, axis)),
                N_("Jog the axis away from the switch and check the home position."),
            )
            state.say(EventKind.LIMIT_REACHED, reason.message, axis=axis)
            interrupt(state, reason)
            return HALTED
    return command


def axis_command(command: DriveCommand, axis: Axis) -> AxisCommand:
    """Return what one axis is told."""
    return command.azimuth if axis is Axis.AZIMUTH else command.elevation


def forget_following(state: ControllerState) -> None:
    """Begin anew to compare the axes with their references."""
    state.watches = {}


def check_following(state: ControllerState, feedback: Feedback, now: datetime) -> None:
    """Compare every commanded axis with its reference, and latch a fault where it does not follow."""
    if isinstance(state.command.azimuth, Halt) and isinstance(state.command.elevation, Halt):
        if state.watches:
            state.watches = {}
        return
    watches = {}
    for axis in Axis:
        seen, config = guards.axis_feedback(feedback, axis), state.config.axis(axis)
        before, allowed_deg = state.watches.get(axis), state.config.following_error_deg
        watched = watch(before, config, axis_command(state.command, axis), seen, now, allowed_deg)
        if watched is not None:
            watches[axis] = watched
    state.watches = watches
    for axis, watched in watches.items():
        if watched.turns_wrongly(guards.axis_feedback(feedback, axis).position_deg, now):
            reason = guards.wrong_way(state.config, axis)
            lose_home(state, reason)
        elif not watched.follows(now):
            reason = guards.not_following(state.config, axis, watched)
        else:
            continue
        state.watches = {}
        fail(state, reason)
        return
