"""A latched fault, and the reset that leaves it once the cause is removed."""

from datetime import timedelta

from app.base.message import N_, say
from app.tracker.access.interlocks import Action, demand_drive
from app.tracker.motion.guards import wiring_fault
from app.tracker.state.activity import Faulted
from app.tracker.state.controller_state import ControllerState, Turn
from app.tracker.state.snapshot import EventKind
from app.tracker.state.transitions import begin, hold
from app.tracker.values.motion import DriveCommand, DriveRequest, Feedback, RequestKind

RESET_PATIENCE = timedelta(seconds=5)


def reset_fault(state: ControllerState) -> None:
    """Clear the fault, in the drive too if it has one, or raise `CommandRejected`."""
    feedback = demand_drive(state, Action.RESET_FAULT)
    if feedback.fault_code == 0:
        _clear(state, feedback)
    elif isinstance(state.activity, Faulted):
        begin(state, Faulted(state.activity.reason, state.next_request(), state.now + RESET_PATIENCE))


def step(state: ControllerState, faulted: Faulted, feedback: Feedback) -> Turn:
    """Stay halted; while a reset is under way, wait for the drive's answer."""
    if faulted.number is None or faulted.until is None:
        return Turn(faulted)
    if feedback.request_done == faulted.number and feedback.fault_code == 0:
        _clear(state, feedback)
        return Turn(state.activity)
    if feedback.request_done == faulted.number or state.now >= faulted.until:
        state.say(
            EventKind.FAULT_RAISED,
            say("The fault is still there: {message}", message=faulted.reason.message),
            code=faulted.reason.code,
        )
        return Turn(Faulted(faulted.reason))
    request = DriveRequest(faulted.number, RequestKind.RESET_FAULT)
    return Turn(faulted, DriveCommand(request=request))


def _clear(state: ControllerState, feedback: Feedback) -> None:
    """Hold again, unless the limit switches still contradict each other."""
    wiring = wiring_fault(state.config, feedback)
    if wiring is not None:
        begin(state, Faulted(wiring))
        state.say(
            EventKind.FAULT_RAISED,
            say("The fault is still there: {message}", message=wiring.message),
            code=wiring.code,
        )
        return
    hold(state)
    state.remember(fault_code=None, fault_text="")
    state.say(EventKind.FAULT_RESET, N_("The fault is reset."))
