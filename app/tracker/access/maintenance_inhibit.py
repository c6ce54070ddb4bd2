"""The maintenance lock: while somebody works on the machine, nothing but their own hand moves it."""

from app.base.message import N_, say
from app.tracker.access.interlocks import Action, demand
from app.tracker.commands.commands import SetInhibit
from app.tracker.protections.words import MaintenanceLock
from app.tracker.state.controller_state import ControllerState
from app.tracker.state.snapshot import EventKind
from app.tracker.state.transitions import stop
from app.tracker.values.reason import Reason

LONGEST_NAME = 60
LONGEST_REASON = 200


def set_inhibit(state: ControllerState, command: SetInhibit) -> None:
    """Stop and forbid every automatic motion, or raise `CommandRejected`."""
    demand(state, Action.SET_INHIBIT, named(command.name, N_("A maintenance inhibit")), _too_long(command))
    name, why = command.name.strip(), command.reason.strip()
    stop(state, N_("a maintenance inhibit was set."))
    state.remember(lock=MaintenanceLock(name, state.actor, state.site_time, why))
    state.say(
        EventKind.INHIBIT_SET,
        say("{name} set a maintenance inhibit for {name2}.", name=name, name2=state.config.name),
        name=name,
        reason=why,
    )


def release_inhibit(state: ControllerState) -> None:
    """Forget the lock, or raise `CommandRejected`; whoever wants a motion commands it."""
    demand(state, Action.RELEASE_INHIBIT)
    lock = state.memory.lock
    state.remember(lock=None)
    name = N_("no user") if lock is None else lock.name
    state.say(
        EventKind.INHIBIT_RELEASED,
        say("The maintenance inhibit of {name} was released.", name=name),
        name=name,
    )


def named(name: str, what: str) -> Reason | None:
    """Return that a name is missing or no name, None where it is one."""
    if name.isprintable() and 1 <= len(name.strip()) <= LONGEST_NAME:
        return None
    return Reason(
        "lock_unnamed",
        say(
            "{what} requires a name of 1 to {longest_name} characters.", what=what, longest_name=LONGEST_NAME
        ),
        N_("Enter the name of the person who works on the tracker."),
    )


def _too_long(command: SetInhibit) -> Reason | None:
    if len(command.reason.strip()) <= LONGEST_REASON:
        return None
    return Reason(
        "lock_unnamed",
        say(
            "The reason for a maintenance inhibit has up to {longest_reason} characters.",
            longest_reason=LONGEST_REASON,
        ),
        N_("Shorten the reason."),
    )
