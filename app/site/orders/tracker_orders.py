"""Orders to one tracker: commands for its controller, and stop."""

import asyncio
from contextlib import suppress

from app.base.logs import get_logger
from app.base.message import N_
from app.site.loop.loop import TrackerLoop
from app.site.state.model import SiteModel
from app.tracker.commands.commands import Command, CommandRejected, ResetFault, RunShow, Stop
from app.tracker.state.snapshot import Event, EventKind
from app.tracker.values.actors import CONTROLLER
from app.tracker.values.reason import Reason

STORED_WITHIN_S = 0.5
NOT_RECORDED = Reason(
    "not_stored",
    N_("Motion is refused because it cannot be recorded: storage fails."),
    N_("Free disk space or check the disk; storage is retried every two seconds."),
)

log = get_logger()


async def command(
    model: SiteModel, loop: TrackerLoop, given: Command, actor: str, via: str = ""
) -> tuple[Event, ...]:
    """Have the controller obey, and return once what changed is on disk; a jog does not wait for that.

    Without a store that works everything but a stop is refused, and a jog that lasts ends with its lease.
    A renewed jog changes only when its lease ends, and the end of a press that is over changes nothing: no
    tick is needed before the next one.
    """
    if isinstance(given, Stop):
        events = handle_stop(model, loop, actor)
        await finish_stop(model, loop)
        return events
    if loop.broken is not None:
        return _repair(model, loop, given, actor)
    if model.ledger.behind and not given.spec.ends_motion:
        raise CommandRejected(NOT_RECORDED)
    events = loop.handle(given, actor, via)
    if isinstance(given, RunShow):
        model.recorder.announce(loop.config.tracker_id, given.plan)
    if events or not given.spec.held:
        loop.wake()
    if given.spec.held:
        _post(model, loop, events)
    else:
        await _store(model, loop, events)
    return events


def handle_stop(model: SiteModel, loop: TrackerLoop, actor: str) -> tuple[Event, ...]:
    """Make the controller stop and have the latches stored soon; the drive is told by `finish_stop`."""
    try:
        events = loop.handle(Stop(), actor)
    except Exception:
        log.exception("stop_not_handled", tracker=loop.config.tracker_id)
        message = N_(
            "Stop was requested. The controller of this tracker has failed; its drive "
            "received a stop command."
        )
        events = (model.event(EventKind.STOPPED, message, actor, loop.config.tracker_id),)
    loop.wake()
    _post(model, loop, events)
    return events


async def finish_stop(model: SiteModel, loop: TrackerLoop) -> None:
    """Tell the drive to stop beside the controller, then give the latches half a second to be on disk."""
    await loop.stop_drive()
    await until_stored(model)


async def until_stored(model: SiteModel) -> None:
    """Give what was posted half a second to be on disk: a stop waits no longer for it."""
    with suppress(CommandRejected, TimeoutError):
        async with asyncio.timeout(STORED_WITHIN_S):
            await model.ledger.keep(lambda writer: None, 0)


def _repair(model: SiteModel, loop: TrackerLoop, given: Command, actor: str) -> tuple[Event, ...]:
    if not isinstance(given, ResetFault):
        raise CommandRejected(*filter(None, (loop.broken,)))
    loop.repair()
    event = model.event(
        EventKind.FAULT_RESET,
        N_("The controller of this tracker was restarted after an unexpected error."),
        actor,
        loop.config.tracker_id,
    )
    _post(model, loop, (event,))
    return (event,)


def _post(model: SiteModel, loop: TrackerLoop, events: tuple[Event, ...]) -> None:
    if loop.take_changed():
        model.ledger.post_tracker(loop.state, events)
    else:
        model.ledger.post_events(events)


async def _store(model: SiteModel, loop: TrackerLoop, events: tuple[Event, ...]) -> None:
    """Store what a command changed; what cannot be stored is not done: the tracker stops."""
    try:
        if loop.take_changed():
            await model.ledger.save_tracker(loop.state, events)
        else:
            await model.ledger.append(events)
    except CommandRejected:
        handle_stop(model, loop, CONTROLLER)
        await loop.stop_drive()
        raise
