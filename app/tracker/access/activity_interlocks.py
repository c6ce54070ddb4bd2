"""Conditions of what a tracker is doing: its activity, and the phase of a show."""

from collections.abc import Callable

from app.base.message import N_, say, word
from app.tracker.state.activity import NAMES, Showing
from app.tracker.state.controller_state import ControllerState
from app.tracker.state.snapshot import ActivityName, ShowPhase
from app.tracker.values.reason import Reason

Condition = Callable[[ControllerState], Reason | None]


def while_(*allowed: ActivityName) -> Condition:
    """Return the condition that the tracker is doing one of these (a fault is `sound`'s business)."""

    def condition(state: ControllerState) -> Reason | None:
        doing = NAMES[type(state.activity)]
        if doing in allowed or doing is ActivityName.FAULTED:
            return None
        return busy(f"busy_{doing}", state.config.name, doing)

    return condition


def busy(code: str, name: str, doing: ActivityName) -> Reason:
    """Return what a tracker, which is not faulted, is doing, and what to do first."""
    words, hint = _DOING[doing]
    return Reason(code, say("{name} {words}.", name=name, words=word(words)), hint)


def showing(*phases: ShowPhase) -> Condition:
    """Return the condition that a show is in one of these phases."""

    def condition(state: ControllerState) -> Reason | None:
        if isinstance(state.activity, Showing) and state.activity.phase in phases:
            return None
        phase = state.activity.phase if isinstance(state.activity, Showing) else None
        hint = _SHOW_HINT[phases[0]] if phases[0] is not ShowPhase.READY else _BEFORE_RUN[phase]
        return Reason(
            "show_phase", say("{name} {words}.", name=state.config.name, words=word(_SHOW_IS[phase])), hint
        )

    return condition


def not_in_a_show(state: ControllerState) -> Reason | None:
    """Return that a show is under way, which would have to be stopped first."""
    if isinstance(state.activity, Showing) and state.activity.phase in (ShowPhase.RUNNING, ShowPhase.PAUSED):
        return Reason(
            "show_running",
            say("{name} {words}.", name=state.config.name, words=word(_SHOW_IS[state.activity.phase])),
            N_("Stop the show first."),
        )
    return None


_STOP_FIRST = N_("Press Stop first.")
_DOING = {
    ActivityName.HOLDING: (N_("is at standstill"), N_("No action is needed.")),
    ActivityName.JOGGING: (N_("is being jogged"), N_("Release the button first.")),
    ActivityName.MOVING: (
        N_("is moving to a position"),
        N_("Wait until the tracker has arrived, or press Stop."),
    ),
    ActivityName.SETTING_HOME: (N_("is setting its home position"), N_("Wait until this has finished.")),
    ActivityName.HOMING: (
        N_("is searching for its home switches"),
        N_("Wait until this has finished, or press Stop."),
    ),
    ActivityName.TRACKING: (N_("is tracking"), _STOP_FIRST),
    ActivityName.SHOWING: (N_("is busy with a show"), N_("Stop the show first.")),
    ActivityName.STOPPING: (N_("is stopping"), N_("Wait until both axes are at standstill.")),
    ActivityName.STOWING: (
        N_("is going to a stow position"),
        N_("Wait until the tracker has arrived, or press Stop."),
    ),
    ActivityName.STOWED: (N_("is stowed"), N_("Press Stop first; the tracker is then no longer stowed.")),
    ActivityName.MEASURING: (
        N_("is running a drive test"),
        N_("Wait until this has finished, or press Stop."),
    ),
}
_SHOW_IS = {
    None: N_("has no show under way"),
    ShowPhase.GOING_TO_START: N_("is still going to the start of the show"),
    ShowPhase.READY: N_("is at the start of a show that has not begun"),
    ShowPhase.RUNNING: N_("is running a show"),
    ShowPhase.PAUSED: N_("has paused a show"),
}
_SHOW_HINT = {
    ShowPhase.GOING_TO_START: N_("There is nothing to stop."),
    ShowPhase.RUNNING: N_("Only a running show can be paused."),
    ShowPhase.PAUSED: N_("Only a paused show can be resumed."),
}
_BEFORE_RUN = {
    None: N_("Press Go to start position and wait until the panel is there."),
    ShowPhase.GOING_TO_START: N_("Wait until the tracker has arrived, or press Stop."),
    ShowPhase.READY: N_("No action is needed."),
    ShowPhase.RUNNING: N_("Stop the show first."),
    ShowPhase.PAUSED: N_("Stop the show first."),
}
