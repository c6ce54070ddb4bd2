"""Why a tracker that is to move by itself waits for the operator; nobody else writes that."""

from app.tracker.state.controller_state import ControllerState
from app.tracker.state.parts import NOT_WAITING, Waiting
from app.tracker.values.reason import Reason


def wait_for(state: ControllerState, reason: Reason) -> None:
    """Wait, visibly, until somebody commands something."""
    state.waiting = Waiting(reason)


def wait_untouched(state: ControllerState, reason: Reason) -> None:
    """Wait for what tracking lacks to go on by itself; the weather may stow the tracker meanwhile."""
    state.waiting = Waiting(reason, untouched=True)


def leave_to_people(state: ControllerState) -> None:
    """Let nothing move a tracker that waits: somebody was at its cabinet."""
    if state.waiting.untouched:
        state.waiting = Waiting(state.waiting.reason)


def end_waiting(state: ControllerState) -> None:
    """Wait for nobody any more."""
    state.waiting = NOT_WAITING
