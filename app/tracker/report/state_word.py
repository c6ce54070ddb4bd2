"""The state of a tracker in a word or two, what is dangerous or not known before what it does."""

from app.tracker.access.authority import service_state
from app.tracker.activities.approach import is_approaching
from app.tracker.report.shown_reasons import waiting_reasons
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
)
from app.tracker.state.controller_state import ControllerState
from app.tracker.values.operator_message import StateWord

_WORDS: dict[type[Activity], StateWord] = {
    Jogging: StateWord.JOGGING,
    Moving: StateWord.MOVING,
    SettingHome: StateWord.SETTING_HOME,
    Homing: StateWord.HOMING,
    Measuring: StateWord.DRIVE_TEST,
    Showing: StateWord.SHOW,
    Stopping: StateWord.STOPPING,
    Stowing: StateWord.STOWING,
    Stowed: StateWord.STOWED,
    Faulted: StateWord.FAULT,
}
_TESTS = (MoveKind.DIRECTION, MoveKind.SCALE)


def state_word(state: ControllerState) -> StateWord:
    """Return the state of a tracker: danger first, then what is not known, then what it does."""
    if state.alarmed is not None:
        return StateWord.NOT_STOWED
    if isinstance(state.activity, Faulted):
        return StateWord.FAULT
    if state.connection.lost or state.feedback is None:
        return StateWord.NO_CONNECTION
    match state.activity:
        case Holding():
            return _holding(state)
        case Tracking():
            if is_approaching(state):
                return StateWord.MOVING_TO_THE_SUN
            return StateWord.WAITING if waiting_reasons(state) else StateWord.TRACKING
        case Moving(kind=kind) if kind in _TESTS:
            return StateWord.DRIVE_TEST
        case _:
            return _WORDS[type(state.activity)]


def _holding(state: ControllerState) -> StateWord:
    """Return why a tracker at standstill stays there."""
    seen = state.seen.feedback if state.seen else None
    reasons = (
        (seen is not None and seen.local, StateWord.LOCAL),
        (state.memory.lock is not None, StateWord.INHIBITED),
        (service_state(state) is not None, StateWord.SERVICE_MODE),
        (state.memory.tracking_on or bool(state.memory.stow), StateWord.INTERRUPTED),
        (state.memory.home is None, StateWord.NOT_HOMED),
    )
    return next((word for holds, word in reasons if holds), StateWord.AT_STANDSTILL)
