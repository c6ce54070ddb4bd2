"""The lock on what was commissioned: settings, drive, mount, strategy, zero and location stay as they are."""

from dataclasses import replace

from app.link.messages import (
    AnswerDirection,
    AnswerScale,
    ApplySightings,
    ConfigureTracker,
    LockOrder,
    LockSettings,
    RemoveTracker,
    RestoreDrive,
    SetLocation,
    SetSoftLimit,
    SiteCommand,
)
from app.link.settings_orders import UndoSettings
from app.site.loop import TrackerLoop
from app.site.model import SiteModel
from app.tracker.commands import CommandRejected
from app.tracker.local_locks import locked_settings
from app.tracker.memory import CommissioningLock
from app.tracker.reason import Reason
from app.tracker.snapshot import Event, EventKind

LONGEST_REASON = 200
NO_REASON = Reason(
    "no_reason",
    "Unlocking the settings needs a reason.",
    "Enter a short reason; it is recorded in the journal.",
)


def refuse_locked(model: SiteModel, command: SiteCommand) -> None:
    """Raise `CommandRejected` for what would change settings that are locked.

    The location is locked with any tracker, because all of them aim by it; its time zone is not. That a zero
    is set is refused by the controller.
    """
    reasons: tuple[Reason | None, ...] = ()
    match command:
        case ConfigureTracker(config=config):
            reasons = (_locked(model.loops.get(config.tracker_id)),)
        case SetLocation(location=location) if location != model.state.location:
            reasons = tuple(_locked(loop) for loop in model.loops.values())
        case (
            RemoveTracker()
            | ApplySightings()
            | AnswerDirection()
            | AnswerScale()
            | SetSoftLimit()
            | RestoreDrive()
            | UndoSettings()
        ):
            reasons = (_locked(model.loops.get(command.tracker_id)),)
        case _:
            pass
    found = tuple(reason for reason in reasons if reason is not None)
    if found:
        raise CommandRejected(*found)


def _locked(loop: TrackerLoop | None) -> Reason | None:
    return None if loop is None else locked_settings(loop.config, loop.memory)


async def carry_out(model: SiteModel, command: LockOrder, actor: str) -> tuple[Event, ...]:
    """Lock or unlock a tracker's settings, stored before this returns."""
    loop = model.tracker(command.tracker_id)
    if isinstance(command, LockSettings):
        lock = loop.memory.settings_lock or CommissioningLock(actor, model.now())
        message = f"The settings of {loop.config.name} were locked."
        event = model.event(EventKind.SETTINGS_LOCKED, message, actor, command.tracker_id)
        return await _keep(model, loop, lock, event)
    reason = command.reason.strip()
    if len(reason) > LONGEST_REASON:
        raise ValueError(f"A reason has at most {LONGEST_REASON} characters.")
    if not reason:
        raise CommandRejected(NO_REASON)
    message = f"The settings of {loop.config.name} were unlocked. Reason: {reason}"
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
