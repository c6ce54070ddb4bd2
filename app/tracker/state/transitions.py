"""Leaving what a tracker is doing: every way out says what ended and why."""

from dataclasses import replace
from typing import assert_never

from app.base.message import N_, Message, say
from app.tracker.state.activity import (
    HOLDING,
    STOPPING,
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
    Unfaulted,
)
from app.tracker.state.announce import call_off
from app.tracker.state.controller_state import ControllerState
from app.tracker.state.home_trust import give_up_search, lose_home
from app.tracker.state.setpoints import forget_setpoint
from app.tracker.state.snapshot import EventKind
from app.tracker.state.waiting import end_waiting, wait_for
from app.tracker.values.reason import Reason


def begin(state: ControllerState, activity: Activity) -> None:
    """Be in an activity from now on; nobody else assigns it."""
    state.activity = activity


def hold(state: ControllerState) -> None:
    """Do nothing from now on but stay where the panel is."""
    state.activity = HOLDING


def stop(state: ControllerState, why: Message) -> None:
    """Bring both axes to rest, end everything, switch tracking off; a fault stays a fault."""
    switch_tracking_off(state, why)
    leave(state, why)
    forget_setpoint(state)
    if not isinstance(state.activity, Faulted):
        state.activity = STOPPING


def leave(state: ControllerState, why: Message) -> None:
    """End the present activity before its time; afterwards the tracker holds (a fault stays a fault)."""
    if not isinstance(state.activity, Faulted):
        _say_what_ended(state, state.activity, why)
        state.activity = HOLDING


def _say_what_ended(state: ControllerState, activity: Unfaulted, why: Message) -> None:
    match activity:
        case Holding() | Stopping():
            pass
        case Jogging():
            state.kill_press(activity.press_id)
            state.say(
                EventKind.JOG_ENDED,
                say("The jog of {axis} ended: {why}", axis=activity.axis, why=why),
                outcome="interrupted",
            )
        case Moving() | Measuring():
            _say_order_ended(state, activity, why)
        case SettingHome() | Homing():
            _say_zero_ended(state, activity, why)
        case Stowing() | Stowed():
            text = say("The stow position {stow} was canceled: {why}", stow=activity.stow, why=why)
            state.say(EventKind.STOW_ENDED, text, stow=activity.stow, outcome="interrupted")
        case Tracking():
            state.say(
                EventKind.TRACKING_INTERRUPTED,
                say("Tracking is interrupted and needs the operator: {why}", why=why),
            )
        case Showing():
            end_show(state, activity, say("The show ended early: {why}", why=why), "interrupted")
        case _:
            assert_never(activity)


def _say_order_ended(state: ControllerState, activity: Moving | Measuring, why: Message) -> None:
    """Say that a move or a test ended early; a watched move that did leaves nothing to judge."""
    if isinstance(activity, Measuring):
        text = say("The test of the {axis} axis ended early: {why}", axis=activity.axis, why=why)
        state.say(EventKind.DRIVE_TEST_ENDED, text, axis=activity.axis, outcome="interrupted")
        return
    state.say(
        EventKind.MOVE_ENDED,
        say("{moves} ended early: {why}", moves=_MOVES[activity.kind], why=why),
        outcome="interrupted",
    )
    if activity.kind in (MoveKind.DIRECTION, MoveKind.SCALE):
        state.remember(proofs=replace(state.memory.proofs, move=None))


def _say_zero_ended(state: ControllerState, activity: SettingHome | Homing, why: Message) -> None:
    if isinstance(activity, Homing):
        text = say("The search for the home switches ended: {why}", why=why)
        state.say(EventKind.HOMING_ENDED, text, outcome="failed")
        give_up_search(state)
        return
    state.say(EventKind.HOME_POSITION_NOT_SET, say("Home position not set: {why}", why=why))
    lose_home(
        state,
        Reason("home_position_not_set", say("setting the home position was interrupted: {why}", why=why)),
    )


def end_move(state: ControllerState, why: Message) -> None:
    """End a move that something else takes the place of."""
    if isinstance(state.activity, Moving):
        leave(state, why)


def end_show(state: ControllerState, showing: Showing, message: Message, outcome: str) -> None:
    """Say that a show has ended; nothing is running any more."""
    state.remember(showing=None, show_moves=False)
    state.say(EventKind.SHOW_ENDED, message, outcome=outcome, show_id=showing.course.plan.show_id)


def interrupt(state: ControllerState, reason: Reason) -> None:
    """End what is going on for a reason; what was automatic waits, visibly, for the operator."""
    leave(state, reason.message)
    forget_setpoint(state)
    if state.memory.tracking_on or state.memory.stow is not None:
        wait_for(state, reason)


def fail(state: ControllerState, reason: Reason) -> None:
    """Latch a fault and stop; only a reset leaves it."""
    interrupt(state, reason)
    state.activity = Faulted(reason)
    state.remember(fault_code=reason.code, fault_text=reason.message)
    state.say(EventKind.FAULT_RAISED, reason.message, code=reason.code, hint=reason.hint)


def switch_tracking_off(state: ControllerState, why: Message) -> None:
    """Switch tracking off and say so, because something else was commanded; moves and stows end too."""
    end_waiting(state)
    call_off(state)
    if isinstance(state.activity, Moving | Stowing | Stowed):
        leave(state, why)
    state.remember(stow=None)
    if isinstance(state.activity, Tracking):
        state.activity = HOLDING
    if state.memory.tracking_on:
        state.remember(tracking_on=False)
        state.say(
            EventKind.TRACKING_ENDED, say("Tracking is switched off: {why}", why=why), outcome="switched_off"
        )


_MOVES = {
    MoveKind.MOVE: N_("The move"),
    MoveKind.PARK: N_("The move to the park position"),
    MoveKind.STEP: N_("The incremental jog"),
    MoveKind.DIRECTION: N_("The move of the direction test"),
    MoveKind.SCALE: N_("The move of the scale test"),
}
