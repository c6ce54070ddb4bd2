"""Who may move the machine: the switch at its cabinet before all, somebody in service next."""

from datetime import timedelta

from app.tracker.activity import STOPPING, Faulted, Holding, Stopping
from app.tracker.commands import BeginServiceMode
from app.tracker.controller_state import NOWHERE, ControllerState
from app.tracker.interlocks import Action, demand
from app.tracker.maintenance_inhibit import named
from app.tracker.motion import Feedback
from app.tracker.protections.words import ServiceMode, ServiceState
from app.tracker.reason import Reason
from app.tracker.snapshot import EventKind
from app.tracker.transitions import interrupt, leave, switch_tracking_off


def watch_local(mind: ControllerState, before: Feedback | None, feedback: Feedback) -> None:
    """End everything while the switch at the cabinet is on local; nothing moves when it is turned back."""
    was_local = before is not None and before.local
    if feedback.local or was_local:
        mind.held_back = None
    if feedback.local and not was_local:
        reason = at_cabinet(mind)
        mind.say(EventKind.SWITCHED_TO_LOCAL, reason.message, code=reason.code)
    elif was_local and not feedback.local:
        text = (
            f"The switch at the cabinet of {mind.config.name} is on remote again. Nothing moves "
            "automatically."
        )
        mind.say(EventKind.SWITCHED_TO_REMOTE, text)
    if feedback.local and not isinstance(mind.activity, Holding | Stopping | Faulted):
        interrupt(mind, at_cabinet(mind))


def at_cabinet(mind: ControllerState) -> Reason:
    """Return that the switch at the cabinet keeps the panel from moving anything."""
    return Reason(
        "local",
        f"The switch at the cabinet of {mind.config.name} is on local.",
        "The tracker is operated from its cabinet. Turn the switch to remote to use Heliopanel.",
    )


def begin_service_mode(mind: ControllerState, command: BeginServiceMode) -> None:
    """Stop, and from now on move slowly and only while the area is clear, or raise `CommandRejected`."""
    demand(mind, Action.BEGIN_SERVICE_MODE, named(command.name, "Service mode"))
    name = command.name.strip()
    switch_tracking_off(mind, "service mode begins.")
    leave(mind, "service mode begins.")
    mind.setpoint = NOWHERE
    if not isinstance(mind.activity, Faulted):
        mind.activity = STOPPING
    mind.remember(service=ServiceMode(name, mind.actor, mind.site_time))
    mind.clear_until = None
    text = (
        f"{name} put {mind.config.name} in service mode. The tracker moves slowly after the "
        "area is confirmed clear."
    )
    mind.say(EventKind.SERVICE_MODE_STARTED, text, name=name)


def confirm_area_clear(mind: ControllerState) -> None:
    """Take the word that nobody stands where the panel moves, or raise `CommandRejected`."""
    demand(mind, Action.CONFIRM_AREA_CLEAR)
    seconds = mind.config.machine.clear_for_s
    mind.clear_until = mind.now + timedelta(seconds=seconds)
    text = f"The area around {mind.config.name} is confirmed clear, valid for {seconds / 60.0:g} minutes."
    mind.say(EventKind.AREA_CONFIRMED_CLEAR, text, seconds=seconds)


def end_service_mode(mind: ControllerState) -> None:
    """Leave service mode, or raise `CommandRejected`; a motion under way ends, nothing else begins."""
    demand(mind, Action.END_SERVICE_MODE)
    leave(mind, "service mode ends.")
    mind.remember(service=None)
    mind.clear_until = None
    mind.say(EventKind.SERVICE_MODE_ENDED, f"Service mode of {mind.config.name} has ended.")


def watch_service(mind: ControllerState) -> None:
    """End a motion when the word that the area is clear has expired."""
    if mind.memory.service is None or mind.clear_until is None or mind.now < mind.clear_until:
        return
    mind.clear_until = None
    reason = Reason(
        "area_not_clear",
        f"The area-clear confirmation for {mind.config.name} has expired.",
        "Check that the area is clear, then press Confirm area clear.",
    )
    if not isinstance(mind.activity, Holding | Stopping | Faulted):
        interrupt(mind, reason)
    mind.say(EventKind.AREA_CONFIRMATION_EXPIRED, reason.message, code=reason.code)


def service_state(mind: ControllerState) -> ServiceState | None:
    """Return service mode as it is shown, None outside it."""
    if mind.memory.service is None:
        return None
    left = timedelta(0) if mind.clear_until is None else mind.clear_until - mind.now
    return ServiceState(mind.memory.service, max(0.0, left.total_seconds()))
