"""A latched fault, and the reset that leaves it once the cause is removed."""

from datetime import timedelta

from app.tracker.activity import HOLDING, Faulted
from app.tracker.controller_state import ControllerState, Turn
from app.tracker.guards import wiring_fault
from app.tracker.interlocks import Action, demand_drive
from app.tracker.motion import DriveCommand, DriveRequest, Feedback, RequestKind
from app.tracker.snapshot import EventKind

RESET_PATIENCE = timedelta(seconds=5)


def reset_fault(mind: ControllerState) -> None:
    """Clear the fault, in the drive too if it has one, or raise `CommandRejected`."""
    feedback = demand_drive(mind, Action.RESET_FAULT)
    if feedback.fault_code == 0:
        _clear(mind, feedback)
    elif isinstance(mind.activity, Faulted):
        mind.activity = Faulted(mind.activity.reason, mind.next_request(), mind.now + RESET_PATIENCE)


def step(mind: ControllerState, faulted: Faulted, feedback: Feedback) -> Turn:
    """Stay halted; while a reset is under way, wait for the drive's answer."""
    if faulted.number is None or faulted.until is None:
        return Turn(faulted)
    if feedback.request_done == faulted.number and feedback.fault_code == 0:
        _clear(mind, feedback)
        return Turn(mind.activity)
    if feedback.request_done == faulted.number or mind.now >= faulted.until:
        mind.say(
            EventKind.FAULT_RAISED,
            f"The fault is still there: {faulted.reason.message}",
            code=faulted.reason.code,
        )
        return Turn(Faulted(faulted.reason))
    request = DriveRequest(faulted.number, RequestKind.RESET_FAULT)
    return Turn(faulted, DriveCommand(request=request))


def _clear(mind: ControllerState, feedback: Feedback) -> None:
    """Hold again, unless the limit switches still contradict each other."""
    wiring = wiring_fault(mind.config, feedback)
    if wiring is not None:
        mind.activity = Faulted(wiring)
        mind.say(EventKind.FAULT_RAISED, f"The fault is still there: {wiring.message}", code=wiring.code)
        return
    mind.activity = HOLDING
    mind.remember(fault_code=None, fault_text="")
    mind.say(EventKind.FAULT_RESET, "The fault is reset.")
