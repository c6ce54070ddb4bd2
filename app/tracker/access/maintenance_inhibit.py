"""The maintenance lock: while somebody works on the machine, nothing but their own hand moves it."""

from app.base.message import N_, say
from app.base.names import tidy, unseen
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
    name, why = tidy(command.name), tidy(command.reason)
    demand(state, Action.SET_INHIBIT, named(name, N_("A maintenance inhibit")), _too_long(why))
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
    """Return that a tidy name is missing or no name, None where it is one."""
    fault = unseen(name)
    if fault is None and 1 <= len(name) <= LONGEST_NAME:
        return None
    return Reason(
        "lock_unnamed",
        fault
        or say(
            "{what} requires a name of 1 to {longest_name} characters.", what=what, longest_name=LONGEST_NAME
        ),
        N_("Enter the name of the person who works on the tracker."),
    )


def _too_long(why: str) -> Reason | None:
    if fault := unseen(why):
        return Reason("lock_unnamed", fault)
    if len(why) <= LONGEST_REASON:
        return None
    return Reason(
        "lock_unnamed",
        say(
            "The reason for a maintenance inhibit has up to {longest_reason} characters.",
            longest_reason=LONGEST_REASON,
        ),
        N_("Shorten the reason."),
    )
