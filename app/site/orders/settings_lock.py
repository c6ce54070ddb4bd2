"""The lock on what was commissioned: settings, drive, mount, strategy, zero and location stay as they are."""

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from app.base.message import N_, say
from app.base.names import clean
from app.link.messages import (
    SetLocation,
    SiteCommand,
)
from app.link.settings_orders import LockSettings, UnlockSettings
from app.site.loop.loop import TrackerLoop
from app.site.state.model import SiteModel
from app.tracker.access.local_locks import locked_settings
from app.tracker.commands.commands import CommandRejected
from app.tracker.memory.memory import CommissioningLock
from app.tracker.state.snapshot import Event, EventKind
from app.tracker.values.reason import Reason

LONGEST_REASON = 200
NO_REASON = Reason(
    "no_reason",
    N_("Unlocking the settings needs a reason."),
    N_("Enter a short reason; it is recorded in the journal."),
)


def refuse_locked(model: SiteModel, command: SiteCommand) -> None:
    """Raise `CommandRejected` for what would change settings that are locked.

    The location is locked with any tracker, because all of them aim by it; its time zone is not. That a zero
    is set is refused by the controller.
    """
    if not command.spec.sealed:
        return
    concerned: Iterable[TrackerLoop | None] = (model.loops.get(_about(command)),)
    if isinstance(command, SetLocation):
        concerned = () if command.location == model.state.location else model.loops.values()
    found = tuple(reason for loop in concerned if (reason := _locked(loop)) is not None)
    if found:
        raise CommandRejected(*found)


def _about(command: SiteCommand) -> str:
    about: Any = getattr(command, "config", command)
    return getattr(about, "tracker_id", "")


def _locked(loop: TrackerLoop | None) -> Reason | None:
    return None if loop is None else locked_settings(loop.config, loop.memory)


async def lock(model: SiteModel, command: LockSettings, actor: str) -> tuple[Event, ...]:
    """Lock a tracker's settings, stored before this returns."""
    loop = model.tracker(command.tracker_id)
    kept = loop.memory.settings_lock or CommissioningLock(actor, model.now())
    message = say("The settings of {name} were locked.", name=loop.config.name)
    event = model.event(EventKind.SETTINGS_LOCKED, message, actor, command.tracker_id)
    return await _keep(model, loop, kept, event)


async def unlock(model: SiteModel, command: UnlockSettings, actor: str) -> tuple[Event, ...]:
    """Unlock a tracker's settings, stored before this returns."""
    loop = model.tracker(command.tracker_id)
    reason = clean(command.reason)
    if len(reason) > LONGEST_REASON:
        raise ValueError(
            say("A reason has at most {longest_reason} characters.", longest_reason=LONGEST_REASON)
        )
    if not reason:
        raise CommandRejected(NO_REASON)
    message = say(
        "The settings of {name} were unlocked. Reason: {reason}", name=loop.config.name, reason=reason
    )
    event = model.event(EventKind.SETTINGS_UNLOCKED, message, actor, command.tracker_id, reason=reason)
    return await _keep(model, loop, None, event)


async def _keep(
    model: SiteModel, loop: TrackerLoop, lock: CommissioningLock | None, event: Event
) -> tuple[Event, ...]:
    await model.ledger.save_tracker(
        replace(loop.state, memory=replace(loop.memory, settings_lock=lock)), (event,)
    )
    loop.controller.set_settings_lock(lock)
    return (event,)
