"""The maintenance lock: while somebody works on the machine, nothing but their own hand moves it."""

from app.tracker.activity import STOPPING, Faulted
from app.tracker.commands import LockOut
from app.tracker.conditions import Action, demand
from app.tracker.mind import NOWHERE, Mind
from app.tracker.protections.words import MaintenanceLock
from app.tracker.reason import Reason
from app.tracker.snapshot import EventKind
from app.tracker.transitions import leave, switch_tracking_off

LONGEST_NAME = 60
LONGEST_REASON = 200


def lock_out(mind: Mind, command: LockOut) -> None:
    """Stop and forbid every automatic motion, or raise `CommandRejected`."""
    demand(mind, Action.LOCK_OUT, named(command.name, "A maintenance inhibit"), _too_long(command))
    name, why = command.name.strip(), command.reason.strip()
    switch_tracking_off(mind, "a maintenance inhibit was set.")
    leave(mind, "a maintenance inhibit was set.")
    mind.setpoint = NOWHERE
    if not isinstance(mind.activity, Faulted):
        mind.activity = STOPPING
    mind.remember(lock=MaintenanceLock(name, mind.actor, mind.site_time, why))
    mind.say(
        EventKind.LOCKED_OUT,
        f"{name} set a maintenance inhibit for {mind.config.name}.",
        name=name,
        reason=why,
    )


def release_lock(mind: Mind) -> None:
    """Forget the lock, or raise `CommandRejected`; whoever wants a motion commands it."""
    demand(mind, Action.RELEASE_LOCK)
    lock = mind.memory.lock
    mind.remember(lock=None)
    name = "nobody" if lock is None else lock.name
    mind.say(EventKind.LOCK_RELEASED, f"The maintenance inhibit of {name} was released.", name=name)


def named(name: str, what: str) -> Reason | None:
    """Return that a name is missing or no name, None where it is one."""
    if name.isprintable() and 1 <= len(name.strip()) <= LONGEST_NAME:
        return None
    return Reason(
        "lock_unnamed",
        f"{what} requires a name of 1 to {LONGEST_NAME} characters.",
        "Enter the name of the person who works on the tracker.",
    )


def _too_long(command: LockOut) -> Reason | None:
    if len(command.reason.strip()) <= LONGEST_REASON:
        return None
    return Reason(
        "lock_unnamed",
        f"The reason for a maintenance inhibit has up to {LONGEST_REASON} characters.",
        "Shorten the reason.",
    )
