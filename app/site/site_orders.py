"""Orders to the site: location, clock, name, trackers, confirmations, plans and recordings."""

import asyncio
from base64 import b64decode
from dataclasses import replace
from typing import assert_never

from app.clock import give_way
from app.drives.drive import DriveError
from app.link.messages import (
    AddTracker,
    AnswerDirection,
    AnswerScale,
    ApplySightings,
    CheckConnection,
    ConfigureTracker,
    ConfirmStep,
    DeleteRecording,
    DriveOrder,
    EndInjectedFaults,
    InjectFault,
    RemoveTracker,
    RenameSite,
    RestoreDrive,
    SavePlan,
    SaveRecording,
    SetClock,
    SetLocation,
    SetSoftLimit,
    StopAll,
    TakeSighting,
    UnknownRecording,
)
from app.link.place_orders import SetHorizon
from app.link.settings_orders import UndoSettings
from app.link.weather_orders import (
    ReportWeather,
    SetMetStation,
    SetWeatherWindows,
    SimulateWeather,
    WeatherOrder,
)
from app.logs import get_logger
from app.site import drive_testing, sightings, tracker_orders, tracker_setup, training, weather_setup
from app.site.loop import TrackerLoop
from app.site.model import SiteModel
from app.site.validation import check_name, check_time_zone
from app.store.store import PlannedShow, Writer
from app.tracker.commands import CommandRejected
from app.tracker.memory import Confirmation, SiteState, StepName
from app.tracker.mode import Mode
from app.tracker.reason import Reason
from app.tracker.recording import RecordingInfo
from app.tracker.snapshot import ActivityName, Event, EventKind

FOLLOWS_THE_SUN = {ActivityName.TRACKING, ActivityName.SHOWING}
CLOCK_SET_WITHIN_S = 2.0
MOST_AT_ONCE = 50
"""So many trackers are stopped before whatever else is due, a tick among it, has its turn."""
KEEPS_NOTHING = Reason("no_store", "This controller runs without a database and keeps no recordings.")

log = get_logger()


SiteOrder = (
    SetLocation | SetHorizon | SetClock | RenameSite | ConfirmStep | AddTracker | ConfigureTracker
    | RemoveTracker | TakeSighting | ApplySightings | SavePlan | SaveRecording | DeleteRecording | DriveOrder
    | StopAll | UndoSettings | WeatherOrder | InjectFault | EndInjectedFaults
)  # fmt: skip


async def carry_out(model: SiteModel, command: SiteOrder, actor: str) -> tuple[Event, ...]:
    """Carry out one order to the site, stored before this returns, and return what happened."""
    match command:
        case SetLocation() | SetHorizon() | SetClock() | RenameSite() | ConfirmStep():
            return await _change_site(model, command, actor)
        case AddTracker() | ConfigureTracker() | RemoveTracker():
            return await _change_trackers(model, command, actor)
        case TakeSighting() | ApplySightings() | SavePlan():
            return await _note(model, command, actor)
        case SaveRecording() | DeleteRecording():
            return await _change_recordings(model, command, actor)
        case (
            AnswerDirection() | AnswerScale() | SetSoftLimit() | RestoreDrive() | CheckConnection()
            | UndoSettings() | InjectFault() | EndInjectedFaults()
        ):  # fmt: skip
            return await _set_up_drive(model, command, actor)
        case StopAll():
            return await _stop_all(model, actor)
        case ReportWeather() | SetMetStation() | SimulateWeather() | SetWeatherWindows():
            return await weather_setup.carry_out(model, command, actor)
        case _:
            assert_never(command)


async def _change_site(
    model: SiteModel, command: SetLocation | SetHorizon | SetClock | RenameSite | ConfirmStep, actor: str
) -> tuple[Event, ...]:
    match command:
        case SetLocation():
            return await _set_location(model, command, actor)
        case SetHorizon():
            return await _set_horizon(model, command, actor)
        case SetClock():
            return await _set_clock(model, command, actor)
        case RenameSite():
            return await _rename(model, command, actor)
        case ConfirmStep():
            return await _confirm(model, command, actor)
        case _:
            assert_never(command)


async def _change_trackers(
    model: SiteModel, command: AddTracker | ConfigureTracker | RemoveTracker, actor: str
) -> tuple[Event, ...]:
    match command:
        case AddTracker():
            weather_setup.refuse_real(model, command.config)
            return await tracker_setup.add(model, command.config, actor)
        case ConfigureTracker():
            weather_setup.refuse_real(model, command.config)
            return await tracker_setup.configure(model, command.config, actor)
        case RemoveTracker():
            return await tracker_setup.remove(model, command.tracker_id, actor)
        case _:
            assert_never(command)


async def _note(
    model: SiteModel, command: TakeSighting | ApplySightings | SavePlan, actor: str
) -> tuple[Event, ...]:
    match command:
        case TakeSighting():
            return await sightings.take(model, command.tracker_id, actor)
        case ApplySightings():
            return await sightings.apply(model, command, actor)
        case SavePlan():
            model.tracker(command.tracker_id)
            await model.ledger.save_show(PlannedShow(command.tracker_id, command.plan))
            return ()
        case _:
            assert_never(command)


async def _set_up_drive(
    model: SiteModel, command: DriveOrder | UndoSettings | InjectFault | EndInjectedFaults, actor: str
) -> tuple[Event, ...]:
    match command:
        case InjectFault() | EndInjectedFaults():
            return await training.carry_out(model, command, actor)
        case AnswerDirection():
            return await drive_testing.answer_direction(model, command, actor)
        case AnswerScale():
            return await drive_testing.answer_scale(model, command, actor)
        case SetSoftLimit():
            return await drive_testing.set_soft_limit(model, command, actor)
        case UndoSettings():
            return await tracker_setup.undo(model, command.tracker_id, actor)
        case RestoreDrive():
            return await drive_testing.restore_drive(model, command, actor)
        case CheckConnection():
            return await drive_testing.check_connection(model, command, actor)
        case _:
            assert_never(command)


async def _change_recordings(
    model: SiteModel, command: SaveRecording | DeleteRecording, actor: str
) -> tuple[Event, ...]:
    _refuse_without_store(model)
    match command:
        case SaveRecording():
            return await _save_recording(model, command)
        case DeleteRecording():
            return await _delete_recording(model, command.recording_id, actor)
        case _:
            assert_never(command)


async def _keep(model: SiteModel, state: SiteState, *events: Event) -> tuple[Event, ...]:
    await model.ledger.save_site(state, events)
    model.state = state
    return events


def _confirmed(state: SiteState, step: StepName, given: Confirmation) -> SiteState:
    return replace(state, confirmations=state.confirmations | {step: given})


async def _set_location(model: SiteModel, command: SetLocation, actor: str) -> tuple[Event, ...]:
    state = replace(model.state, time_zone=check_time_zone(command.time_zone))
    if command.location != state.location:
        _refuse_while_following(model)
        state = replace(state, location=command.location, location_revision=state.location_revision + 1)
    given = Confirmation(model.now(), actor, state.location_revision)
    place = command.location
    message = (
        f"The location was set to {place.latitude_deg:.5f}, {place.longitude_deg:.5f} degrees, "
        f"{place.altitude_m:.0f} m, time zone {state.time_zone}."
    )
    event = model.event(EventKind.LOCATION_SET, message, actor)
    return await _keep(model, _confirmed(state, StepName.LOCATION, given), event)


async def _set_horizon(model: SiteModel, command: SetHorizon, actor: str) -> tuple[Event, ...]:
    count = len(command.horizon.points)
    told = "flat" if not count else f"{count} {'point' if count == 1 else 'points'}"
    message = f"The horizon was set: {told}."
    event = model.event(EventKind.HORIZON_SET, message, actor)
    return await _keep(model, replace(model.state, horizon=command.horizon), event)


def _refuse_while_following(model: SiteModel) -> None:
    reasons = tuple(
        Reason(
            "follows_the_sun",
            f"{loop.config.tracker_id} is tracking the sun for the present location.",
            f"Stop {loop.config.tracker_id} first.",
        )
        for loop in model.loops.values()
        if loop.activity in FOLLOWS_THE_SUN
    )
    if reasons:
        raise CommandRejected(*reasons)


async def _set_clock(model: SiteModel, command: SetClock, actor: str) -> tuple[Event, ...]:
    setting = model.timekeeper.choose(command.source, command.at, actor)
    zone = model.state.time_zone if command.time_zone is None else check_time_zone(command.time_zone)
    state = replace(model.state, clock=setting, time_zone=zone)
    given = Confirmation(setting.set_at or model.now(), actor, state.location_revision)
    message = f"The clock was set: source {setting.source}, offset {setting.offset_s:+.1f} s."
    event = model.event(EventKind.CLOCK_SET, message, actor)
    events = await _keep(model, _confirmed(state, StepName.CLOCK, given), event)
    model.timekeeper.adopt(setting)
    return events


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


async def _rename(model: SiteModel, command: RenameSite, actor: str) -> tuple[Event, ...]:
    name = check_name(command.name)
    event = model.event(EventKind.TRACKER_CHANGED, f"The site is now called {name}.", actor)
    return await _keep(model, replace(model.state, name=name), event)


async def _confirm(model: SiteModel, command: ConfirmStep, actor: str) -> tuple[Event, ...]:
    loop = model.tracker(command.tracker_id)
    missing = _not_confirmable(model, command)
    if missing is not None:
        raise CommandRejected(missing)
    given = Confirmation(model.now(), actor, model.state.location_revision)
    event = model.event(
        EventKind.STEP_CONFIRMED,
        f"The step {command.step.value} was confirmed.",
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
        f"The step {command.step.value} is not done yet.",
        "Complete the step before you confirm it.",
    )


async def _stop_all(model: SiteModel, actor: str) -> tuple[Event, ...]:
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
        happened.append(model.event(EventKind.STOPPED, "Stop was requested; there is no tracker.", actor))
        model.ledger.post_events(happened)
    return tuple(happened)


async def _save_recording(model: SiteModel, command: SaveRecording) -> tuple[Event, ...]:
    chunks = [b64decode(chunk, validate=True) for chunk in command.chunks]
    await model.ledger.keep(lambda writer: writer.save_recording(command.info, chunks), 0)
    return ()


async def _delete_recording(model: SiteModel, recording_id: str, actor: str) -> tuple[Event, ...]:
    if model.recorder.is_open(recording_id):
        raise CommandRejected(
            Reason("recording_runs", "This recording is still running.", "Wait until it has ended.")
        )
    found: list[RecordingInfo | None] = []
    await model.ledger.keep(lambda writer: found.append(_take_out(writer, recording_id)), 0)
    if found[0] is None:
        raise UnknownRecording(f"There is no recording {recording_id}.")
    info = found[0]
    event = model.event(
        EventKind.RECORDING_DELETED, f"The recording {info.title!r} was deleted.", actor, info.tracker_id
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
