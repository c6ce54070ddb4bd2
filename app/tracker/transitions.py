"""Leaving what a tracker is doing: every way out says what ended and why."""

from dataclasses import replace
from typing import assert_never

from app.tracker.activity import (
    HOLDING,
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
    Unfaulted,
)
from app.tracker.controller_state import NOWHERE, ControllerState
from app.tracker.reason import Reason
from app.tracker.snapshot import EventKind


def leave(mind: ControllerState, why: str) -> None:
    """End the present activity before its time; afterwards the tracker holds (a fault stays a fault)."""
    if not isinstance(mind.activity, Faulted):
        _say_what_ended(mind, mind.activity, why)
        mind.activity = HOLDING


def _say_what_ended(mind: ControllerState, activity: Unfaulted, why: str) -> None:
    match activity:
        case Holding() | Stopping():
            pass
        case Jogging():
            mind.kill_press(activity.press_id)
            mind.say(EventKind.JOG_ENDED, f"The jog of {activity.axis} ended: {why}", outcome="interrupted")
        case Moving() | Measuring():
            _say_order_ended(mind, activity, why)
        case SettingHome() | Homing():
            _say_zero_ended(mind, activity, why)
        case Stowing() | Stowed():
            text = f"The stow position {activity.stow} was canceled: {why}"
            mind.say(EventKind.STOW_ENDED, text, stow=activity.stow, outcome="interrupted")
        case Tracking():
            mind.say(EventKind.TRACKING_INTERRUPTED, f"Tracking is interrupted and needs the operator: {why}")
        case Showing():
            end_show(mind, activity, f"The show ended early: {why}", "interrupted")
        case _:
            assert_never(activity)


def _say_order_ended(mind: ControllerState, activity: Moving | Measuring, why: str) -> None:
    """Say that a move or a test ended early; a watched move that did leaves nothing to judge."""
    if isinstance(activity, Measuring):
        text = f"The test of the {activity.axis} axis ended early: {why}"
        mind.say(EventKind.DRIVE_TEST_ENDED, text, axis=activity.axis, outcome="interrupted")
        return
    mind.say(EventKind.MOVE_ENDED, f"{_MOVES[activity.kind]} ended early: {why}", outcome="interrupted")
    if activity.kind in (MoveKind.DIRECTION, MoveKind.SCALE):
        mind.remember(proofs=replace(mind.memory.proofs, move=None))


def _say_zero_ended(mind: ControllerState, activity: SettingHome | Homing, why: str) -> None:
    if isinstance(activity, Homing):
        text = f"The search for the home switches ended: {why}"
        mind.say(EventKind.HOMING_ENDED, text, outcome="failed")
        return
    mind.say(EventKind.HOME_POSITION_NOT_SET, f"Home position not set: {why}")
    lose_home(mind, Reason("home_position_not_set", f"setting the home position was interrupted: {why}"))


def end_move(mind: ControllerState, why: str) -> None:
    """End a move that something else takes the place of."""
    if isinstance(mind.activity, Moving):
        leave(mind, why)


def end_show(mind: ControllerState, showing: Showing, message: str, outcome: str) -> None:
    """Say that a show has ended; nothing is running any more."""
    mind.remember(showing=None, show_moves=False)
    mind.say(EventKind.SHOW_ENDED, message, outcome=outcome, show_id=showing.course.plan.show_id)


def interrupt(mind: ControllerState, reason: Reason) -> None:
    """End what is going on for a reason; what was automatic waits, visibly, for the operator."""
    leave(mind, reason.message)
    mind.setpoint = NOWHERE
    if mind.memory.tracking_on or mind.memory.stow is not None:
        mind.wait = reason


def fail(mind: ControllerState, reason: Reason) -> None:
    """Latch a fault and stop; only a reset leaves it."""
    interrupt(mind, reason)
    mind.activity = Faulted(reason)
    mind.remember(fault_code=reason.code, fault_text=reason.message)
    mind.say(EventKind.FAULT_RAISED, reason.message, code=reason.code, hint=reason.hint)


def lose_home(mind: ControllerState, reason: Reason) -> None:
    """Stop believing the zero, and whatever needed it."""
    mind.remember(former_home=None)
    mind.zeroed, mind.corrected = frozenset(), None
    if mind.memory.home is None:
        return
    doubt_zero(mind, reason.message)
    mind.say(EventKind.HOME_LOST, f"Home reference lost: {reason.message}", code=reason.code)


def doubt_zero(mind: ControllerState, why: str) -> None:
    """Remember since when and why there is no zero that is trusted."""
    mind.remember(home=None, home_lost=why, home_lost_at=mind.site_time)


def switch_tracking_off(mind: ControllerState, why: str) -> None:
    """Switch tracking off and say so, because something else was commanded; moves and stows end too."""
    mind.wait = mind.warning = None
    if isinstance(mind.activity, Moving | Stowing | Stowed):
        leave(mind, why)
    mind.remember(stow=None)
    if isinstance(mind.activity, Tracking):
        mind.activity = HOLDING
    if mind.memory.tracking_on:
        mind.remember(tracking_on=False)
        mind.say(EventKind.TRACKING_ENDED, f"Tracking is switched off: {why}", outcome="switched_off")


_MOVES = {
    MoveKind.MOVE: "The move",
    MoveKind.PARK: "The move to the park position",
    MoveKind.STEP: "The incremental jog",
    MoveKind.DIRECTION: "The move of the direction test",
    MoveKind.SCALE: "The move of the scale test",
}
