"""The maintenance lock: while somebody works on the machine, nothing but their own hand moves it."""

from app.tracker.activity import STOPPING, Faulted
from app.tracker.commands import SetInhibit
from app.tracker.controller_state import NOWHERE, ControllerState
from app.tracker.interlocks import Action, demand
from app.tracker.protections.words import MaintenanceLock
from app.tracker.reason import Reason
from app.tracker.snapshot import EventKind
from app.tracker.transitions import leave, switch_tracking_off

LONGEST_NAME = 60
LONGEST_REASON = 200


def set_inhibit(mind: ControllerState, command: SetInhibit) -> None:
    """Stop and forbid every automatic motion, or raise `CommandRejected`."""
    demand(mind, Action.SET_INHIBIT, named(command.name, "A maintenance inhibit"), _too_long(command))
    name, why = command.name.strip(), command.reason.strip()
    switch_tracking_off(mind, "a maintenance inhibit was set.")
    leave(mind, "a maintenance inhibit was set.")
    mind.setpoint = NOWHERE
    if not isinstance(mind.activity, Faulted):
        mind.activity = STOPPING
    mind.remember(lock=MaintenanceLock(name, mind.actor, mind.site_time, why))
    mind.say(
        EventKind.INHIBIT_SET,
        f"{name} set a maintenance inhibit for {mind.config.name}.",
        name=name,
        reason=why,
    )


def release_inhibit(mind: ControllerState) -> None:
    """Forget the lock, or raise `CommandRejected`; whoever wants a motion commands it."""
    demand(mind, Action.RELEASE_INHIBIT)
    lock = mind.memory.lock
    mind.remember(lock=None)
    name = "nobody" if lock is None else lock.name
    mind.say(EventKind.INHIBIT_RELEASED, f"The maintenance inhibit of {name} was released.", name=name)


def named(name: str, what: str) -> Reason | None:
    """Return that a name is missing or no name, None where it is one."""
    if name.isprintable() and 1 <= len(name.strip()) <= LONGEST_NAME:
        return None
    return Reason(
        "lock_unnamed",
        f"{what} requires a name of 1 to {LONGEST_NAME} characters.",
        "Enter the name of the person who works on the tracker.",
    )


def _too_long(command: SetInhibit) -> Reason | None:
    if len(command.reason.strip()) <= LONGEST_REASON:
        return None
    return Reason(
        "lock_unnamed",
        f"The reason for a maintenance inhibit has up to {LONGEST_REASON} characters.",
        "Shorten the reason.",
    )
