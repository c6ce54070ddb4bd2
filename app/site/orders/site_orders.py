"""Orders to the site: location, clock, name, trackers, confirmations, plans and recordings."""

import asyncio
from base64 import b64decode
from dataclasses import replace
from datetime import timedelta

from app.base.clock import give_way
from app.base.logs import get_logger
from app.base.message import N_, Word, say, with_format
from app.link.messages import (
    ConfirmStep,
    DeleteRecording,
    RenameSite,
    ReportDeviceClock,
    SavePlan,
    SaveRecording,
    SetClock,
    SetLocation,
    StopAll,
    UnknownRecording,
)
from app.link.place_orders import SetHorizon
from app.modbus.errors import DriveError
from app.site.loop.loop import TrackerLoop
from app.site.orders import tracker_orders
from app.site.state.model import SiteModel
from app.site.state.validation import check_name, check_time_zone
from app.store.store import PlannedShow, Writer
from app.tracker.access.location_change import against_another_clock, led_by_the_location
from app.tracker.commands.commands import CommandRejected
from app.tracker.memory.memory import Confirmation, SiteState, StepName
from app.tracker.memory.recording import RecordingInfo
from app.tracker.state.snapshot import Event, EventKind
from app.tracker.values.mode import Mode
from app.tracker.values.reason import Reason

CLOCK_SET_WITHIN_S = 2.0
MOST_AT_ONCE = 50
"""So many trackers are stopped before whatever else is due, a tick among it, has its turn."""
KEEPS_NOTHING = Reason("no_store", N_("This controller runs without a database and keeps no recordings."))

log = get_logger()


async def save_plan(model: SiteModel, command: SavePlan, actor: str) -> tuple[Event, ...]:
    """Keep the plan of a show."""
    model.tracker(command.tracker_id)
    await model.ledger.save_show(PlannedShow(command.tracker_id, command.plan))
    return ()


async def _keep(model: SiteModel, state: SiteState, *events: Event) -> tuple[Event, ...]:
    await model.ledger.save_site(state, events)
    model.state = state
    return events


def _confirmed(state: SiteState, step: StepName, given: Confirmation) -> SiteState:
    return replace(state, confirmations=state.confirmations | {step: given})


async def set_location(model: SiteModel, command: SetLocation, actor: str) -> tuple[Event, ...]:
    """Set where the site is, and its time zone."""
    state = replace(model.state, time_zone=check_time_zone(command.time_zone))
    if command.location != state.location:
        if reasons := led_by_the_location(model.doing()):
            raise CommandRejected(*reasons)
        state = replace(state, location=command.location, location_revision=state.location_revision + 1)
    given = Confirmation(model.now(), actor, state.location_revision)
    place = command.location
    message = say(
        "The location was set to {latitude_deg}, {longitude_deg} degrees, {altitude_m} m, "
        "time zone {time_zone}.",
        latitude_deg=with_format(place.latitude_deg, ".5f"),
        longitude_deg=with_format(place.longitude_deg, ".5f"),
        altitude_m=with_format(place.altitude_m, ".0f"),
        time_zone=state.time_zone,
    )
    event = model.event(EventKind.LOCATION_SET, message, actor)
    return await _keep(model, _confirmed(state, StepName.LOCATION, given), event)


async def set_horizon(model: SiteModel, command: SetHorizon, actor: str) -> tuple[Event, ...]:
    """Set what hides a low sun."""
    count = len(command.horizon.points)
    told = (
        Word("flat")
        if not count
        else (say("{count} point", count=count) if count == 1 else say("{count} points", count=count))
    )
    message = say("The horizon was set: {told}.", told=told)
    event = model.event(EventKind.HORIZON_SET, message, actor)
    return await _keep(model, replace(model.state, horizon=command.horizon), event)


async def set_clock(model: SiteModel, command: SetClock, actor: str) -> tuple[Event, ...]:
    """Choose the clock of the site, or raise `CommandRejected` where it would move a panel that tracks."""
    setting = model.timekeeper.choose(command.source, command.at, actor)
    moved = timedelta(seconds=setting.offset_s - model.timekeeper.setting.offset_s)
    if reasons := against_another_clock(moved, model.doing()):
        raise CommandRejected(*reasons)
    zone = model.state.time_zone if command.time_zone is None else check_time_zone(command.time_zone)
    state = replace(model.state, clock=setting, time_zone=zone)
    given = Confirmation(setting.set_at or model.now(), actor, state.location_revision)
    message = say(
        "The clock was set: source {source}, offset {offset_s} s.",
        source=setting.source,
        offset_s=with_format(setting.offset_s, "+.1f"),
    )
    event = model.event(EventKind.CLOCK_SET, message, actor)
    events = await _keep(model, _confirmed(state, StepName.CLOCK, given), event)
    model.timekeeper.adopt(setting)
    return events


async def note_device_clock(model: SiteModel, command: ReportDeviceClock, actor: str) -> tuple[Event, ...]:
    """Note how far the clock of a device is from that of the site."""
    ahead = timedelta(seconds=command.ahead_s)
    model.timekeeper.devices.heard(command.page, actor, ahead)
    return ()


async def set_drive_clocks(model: SiteModel) -> None:
    """Set them side by side: drives that do not answer hold up neither the others nor the site's orders."""
    await asyncio.gather(*(_set_drive_clock(model, loop) for loop in tuple(model.loops.values())))


async def _set_drive_clock(model: SiteModel, loop: TrackerLoop) -> None:
    if not loop.drive.capabilities.settable_clock:
        return
    try:
        async with asyncio.timeout(CLOCK_SET_WITHIN_S):
            await loop.drive.set_clock(model.now())
    except (DriveError, TimeoutError) as error:
        log.warning("drive_clock_not_set", tracker=loop.config.tracker_id, reason=str(error))


async def rename(model: SiteModel, command: RenameSite, actor: str) -> tuple[Event, ...]:
    """Give the site another name."""
    name = check_name(command.name)
    event = model.event(EventKind.TRACKER_CHANGED, say("The site is now called {name}.", name=name), actor)
    return await _keep(model, replace(model.state, name=name), event)


async def confirm(model: SiteModel, command: ConfirmStep, actor: str) -> tuple[Event, ...]:
    """Note that a step is still right, or raise `CommandRejected` while there is nothing to confirm."""
    loop = model.tracker(command.tracker_id)
    missing = _not_confirmable(model, command)
    if missing is not None:
        raise CommandRejected(missing)
    given = Confirmation(model.now(), actor, model.state.location_revision)
    event = model.event(
        EventKind.STEP_CONFIRMED,
        say("The step {value} was confirmed.", value=command.step.value),
        actor,
        command.tracker_id,
        step=command.step.value,
    )
    if command.step in (StepName.LOCATION, StepName.CLOCK):
        events = await _keep(model, _confirmed(model.state, command.step, given), event)
        if command.step is StepName.CLOCK:
            model.timekeeper.adopt(model.timekeeper.setting)
        return events
    confirmed = replace(loop.memory, confirmations={**loop.memory.confirmations, command.step: given})
    await model.ledger.save_tracker(replace(loop.state, memory=confirmed), (event,))
    loop.controller.confirm(command.step, given)
    return (event,)


def _not_confirmable(model: SiteModel, command: ConfirmStep) -> Reason | None:
    """Return why there is nothing yet that could be confirmed."""
    loop = model.tracker(command.tracker_id)
    memory = loop.memory
    there = {
        StepName.LOCATION: model.state.location is not None,
        StepName.CLOCK: model.state.clock.source != "unset",
        StepName.HOMING: memory.home is not None,
        StepName.MODE: memory.mode is Mode.DUAL or StepName.MODE in memory.confirmations,
        StepName.RUN: memory.tracking_on,
    }
    if there[command.step]:
        return None
    return Reason(
        "step_to_do",
        say("The step {value} is not done yet.", value=command.step.value),
        N_("Complete the step before you confirm it."),
    )


async def stop_all(model: SiteModel, command: StopAll, actor: str) -> tuple[Event, ...]:
    """Stop every tracker, whatever is wrong with one of them."""
    happened: list[Event] = []
    stopping: list[asyncio.Task[bool]] = []
    for number, loop in enumerate(tuple(model.loops.values()), 1):
        happened.extend(tracker_orders.handle_stop(model, loop, actor))
        stopping.append(asyncio.create_task(loop.stop_drive()))
        if number % MOST_AT_ONCE == 0:
            await give_way()
    await asyncio.gather(*stopping)
    await tracker_orders.until_stored(model)
    if not model.loops:
        happened.append(model.event(EventKind.STOPPED, N_("Stop was requested; there is no tracker."), actor))
        model.ledger.post_events(happened)
    return tuple(happened)


async def save_recording(model: SiteModel, command: SaveRecording, actor: str) -> tuple[Event, ...]:
    """Store a finished simulation."""
    _refuse_without_store(model)
    chunks = [b64decode(chunk, validate=True) for chunk in command.chunks]
    await model.ledger.keep(lambda writer: writer.save_recording(command.info, chunks), 0)
    return ()


async def delete_recording(model: SiteModel, command: DeleteRecording, actor: str) -> tuple[Event, ...]:
    """Delete a recording that is not running."""
    _refuse_without_store(model)
    recording_id = command.recording_id
    if model.recorder.is_open(recording_id):
        raise CommandRejected(
            Reason("recording_runs", N_("This recording is still running."), N_("Wait until it has ended."))
        )
    found: list[RecordingInfo | None] = []
    await model.ledger.keep(lambda writer: found.append(_take_out(writer, recording_id)), 0)
    if found[0] is None:
        raise UnknownRecording(say("There is no recording {recording_id}.", recording_id=recording_id))
    info = found[0]
    event = model.event(
        EventKind.RECORDING_DELETED,
        say("The recording {title} was deleted.", title=repr(info.title)),
        actor,
        info.tracker_id,
    )
    await model.ledger.append((event,))
    return (event,)


def _take_out(writer: Writer, recording_id: str) -> RecordingInfo | None:
    info = writer.recording(recording_id)
    if info is not None:
        writer.delete_recording(recording_id)
    return info


def _refuse_without_store(model: SiteModel) -> None:
    if model.ledger.writer is None:
        raise CommandRejected(KEEPS_NOTHING)
