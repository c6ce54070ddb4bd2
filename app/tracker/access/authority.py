"""Who may move the machine: the switch at its cabinet before all, somebody in service next."""

from datetime import timedelta

from app.base.message import N_, say, with_format
from app.base.names import tidy
from app.tracker.access.interlocks import Action, demand
from app.tracker.access.maintenance_inhibit import named
from app.tracker.commands.commands import BeginServiceMode
from app.tracker.protections.words import ServiceMode, ServiceState
from app.tracker.state.activity import Faulted, Holding, Stopping
from app.tracker.state.controller_state import ControllerState
from app.tracker.state.snapshot import EventKind
from app.tracker.state.transitions import interrupt, leave, stop
from app.tracker.state.waiting import leave_to_people
from app.tracker.values.motion import Feedback
from app.tracker.values.reason import Reason


def watch_local(state: ControllerState, before: Feedback | None, feedback: Feedback) -> None:
    """End everything while the switch at the cabinet is on local; nothing moves when it is turned back."""
    was_local = before is not None and before.local
    if feedback.local or was_local:
        leave_to_people(state)
    if feedback.local and not was_local:
        reason = at_cabinet(state)
        state.say(EventKind.SWITCHED_TO_LOCAL, reason.message, code=reason.code)
    elif was_local and not feedback.local:
        text = say(
            "The switch at the cabinet of {name} is on remote again. Nothing moves automatically.",
            name=state.config.name,
        )
        state.say(EventKind.SWITCHED_TO_REMOTE, text)
    if feedback.local and not isinstance(state.activity, Holding | Stopping | Faulted):
        interrupt(state, at_cabinet(state))


def at_cabinet(state: ControllerState) -> Reason:
    """Return that the switch at the cabinet keeps the panel from moving anything."""
    return Reason(
        "local",
        say("The switch at the cabinet of {name} is on local.", name=state.config.name),
        N_("The tracker is operated from its cabinet. Turn the switch to remote to use Heliopanel."),
    )


def begin_service_mode(state: ControllerState, command: BeginServiceMode) -> None:
    """Stop, and from now on move slowly and only while the area is clear, or raise `CommandRejected`."""
    name = tidy(command.name)
    demand(state, Action.BEGIN_SERVICE_MODE, named(name, N_("Service mode")))
    stop(state, N_("service mode begins."))
    state.remember(service=ServiceMode(name, state.actor, state.site_time))
    state.clear_until = None
    text = say(
        "{name} put {name2} in service mode. The tracker moves slowly after the area is confirmed clear.",
        name=name,
        name2=state.config.name,
    )
    state.say(EventKind.SERVICE_MODE_STARTED, text, name=name)


def confirm_area_clear(state: ControllerState) -> None:
    """Take the word that nobody stands where the panel moves, or raise `CommandRejected`."""
    demand(state, Action.CONFIRM_AREA_CLEAR)
    seconds = state.config.machine.clear_for_s
    state.clear_until = state.now + timedelta(seconds=seconds)
    text = say(
        "The area around {name} is confirmed clear, valid for {seconds} minutes.",
        name=state.config.name,
        seconds=with_format(seconds / 60.0, "g"),
    )
    state.say(EventKind.AREA_CONFIRMED_CLEAR, text, seconds=seconds)


def end_service_mode(state: ControllerState) -> None:
    """Leave service mode, or raise `CommandRejected`; a motion under way ends, nothing else begins."""
    demand(state, Action.END_SERVICE_MODE)
    leave(state, N_("service mode ends."))
    state.remember(service=None)
    state.clear_until = None
    state.say(EventKind.SERVICE_MODE_ENDED, say("Service mode of {name} has ended.", name=state.config.name))


def watch_service(state: ControllerState) -> None:
    """End a motion when the word that the area is clear has expired."""
    if state.memory.service is None or state.clear_until is None or state.now < state.clear_until:
        return
    state.clear_until = None
    reason = Reason(
        "area_not_clear",
        say("The area-clear confirmation for {name} has expired.", name=state.config.name),
        N_("Check that the area is clear, then press Confirm area clear."),
    )
    if not isinstance(state.activity, Holding | Stopping | Faulted):
        interrupt(state, reason)
    state.say(EventKind.AREA_CONFIRMATION_EXPIRED, reason.message, code=reason.code)


def service_state(state: ControllerState) -> ServiceState | None:
    """Return service mode as it is shown, None outside it."""
    if state.memory.service is None:
        return None
    left = timedelta(0) if state.clear_until is None else state.clear_until - state.now
    return ServiceState(state.memory.service, max(0.0, left.total_seconds()))
