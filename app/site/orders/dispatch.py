"""Which order to the site is whose: one look-up, and what holds for all that change what is set."""

from collections.abc import Awaitable, Callable
from functools import partial
from typing import Any, TypeVar

from app.link.alarm_orders import (
    AcknowledgeAlarm,
    SetNotifications,
    ShelveAlarm,
    TestNotification,
    UnshelveAlarm,
)
from app.link.messages import (
    AddTracker,
    AnswerControl,
    AnswerDirection,
    AnswerScale,
    ApplySightings,
    CheckConnection,
    ConfigureTracker,
    ConfirmStep,
    DeleteRecording,
    EndInjectedFaults,
    InjectFault,
    Order,
    ReleaseControl,
    RemoveTracker,
    RenameSite,
    RenewControl,
    ReportDeviceClock,
    RequestControl,
    RestoreDrive,
    SavePlan,
    SaveRecording,
    SetClock,
    SetLocation,
    SetSoftLimit,
    SiteCommand,
    StopAll,
    TakeSighting,
)
from app.link.place_orders import SetHorizon
from app.link.record_orders import AddRecordPhoto, RemoveRecordPhoto, SignRecord
from app.link.settings_orders import LockSettings, UndoSettings, UndoSiteSettings, UnlockSettings
from app.link.weather_orders import ReportWeather, SetMetStation, SetWeatherWindows, SimulateWeather
from app.site.orders import (
    control,
    drive_testing,
    notifying,
    records,
    settings_lock,
    sightings,
    site_orders,
    site_undo,
    tracker_setup,
    training,
    weather_setup,
)
from app.site.orders.idempotency import refuse_untimely
from app.site.publishing.alarming import AlarmDesk
from app.site.state.model import SiteModel
from app.tracker.state.snapshot import Event

Asked = TypeVar("Asked", bound=SiteCommand)
Happened = Awaitable[tuple[Event, ...]]
Handler = Callable[[SiteModel, Any, Order], Happened]
Entry = tuple[type[object], Handler]
Handlers = dict[type[object], Handler]


async def carry_out(
    handlers: Handlers, model: SiteModel, command: SiteCommand, order: Order
) -> tuple[Event, ...]:
    """Carry out one order to the site and return what happened; what changes settings waits for its turn."""
    if not command.spec.at_a_time:
        return await handlers[type(command)](model, command, order)
    async with model.changing:
        refuse_untimely(order, model.now())
        settings_lock.refuse_locked(model, command)
        events = await _change(handlers, model, order, command)
    if isinstance(command, SetClock):
        await site_orders.set_drive_clocks(model)
    return events


async def _change(
    handlers: Handlers, model: SiteModel, order: Order, command: SiteCommand
) -> tuple[Event, ...]:
    """Carry out an order; what sets something for the whole site can be taken back."""
    obey = partial(_obey, handlers, model, order)
    if isinstance(command, UndoSiteSettings):
        return await site_undo.undo(model, obey)
    if command.spec.undone_by is UndoSiteSettings:
        return await site_undo.change(model, command, obey)
    return await obey(command)


async def _obey(
    handlers: Handlers, model: SiteModel, order: Order, command: SiteCommand
) -> tuple[Event, ...]:
    return await handlers[type(command)](model, command, order)


def handlers_with(alarms: AlarmDesk) -> Handlers:
    """Return whose every order to a site is, with its desk for alarms."""
    return HANDLERS | dict(
        (
            _said(AcknowledgeAlarm, alarms.acknowledge),
            _said(ShelveAlarm, alarms.shelve),
            _said(UnshelveAlarm, alarms.unshelve),
        )
    )


def _given(kind: type[Asked], do: Callable[[SiteModel, Asked, Order], Happened]) -> Entry:
    """Return an entry whose function asks how the order came."""
    return kind, do


def _said(kind: type[Asked], do: Callable[[SiteModel, Asked, str], Happened]) -> Entry:
    """Return an entry whose function asks only who ordered."""
    return kind, lambda model, command, order: do(model, command, order.actor)


HANDLERS: Handlers = dict(
    (
        _said(StopAll, site_orders.stop_all),
        _said(SetLocation, site_orders.set_location),
        _said(SetHorizon, site_orders.set_horizon),
        _said(SetClock, site_orders.set_clock),
        _said(ReportDeviceClock, site_orders.note_device_clock),
        _said(RenameSite, site_orders.rename),
        _said(ConfirmStep, site_orders.confirm),
        _said(SavePlan, site_orders.save_plan),
        _said(SaveRecording, site_orders.save_recording),
        _said(DeleteRecording, site_orders.delete_recording),
        _said(AddTracker, tracker_setup.add),
        _said(ConfigureTracker, tracker_setup.obey_configure),
        _said(RemoveTracker, tracker_setup.remove),
        _said(UndoSettings, tracker_setup.undo),
        _said(TakeSighting, sightings.take),
        _said(ApplySightings, sightings.apply),
        _said(AnswerDirection, drive_testing.answer_direction),
        _said(AnswerScale, drive_testing.answer_scale),
        _said(SetSoftLimit, drive_testing.set_soft_limit),
        _said(RestoreDrive, drive_testing.restore_drive),
        _said(CheckConnection, drive_testing.check_connection),
        _said(InjectFault, training.inject),
        _said(EndInjectedFaults, training.end_faults),
        _said(ReportWeather, weather_setup.report),
        _said(SetMetStation, weather_setup.set_station),
        _said(SimulateWeather, weather_setup.simulate),
        _said(SetWeatherWindows, weather_setup.set_windows),
        _said(SetNotifications, notifying.set_notifications),
        _said(TestNotification, notifying.test),
        _said(LockSettings, settings_lock.lock),
        _said(UnlockSettings, settings_lock.unlock),
        _said(AddRecordPhoto, records.add_photo),
        _said(RemoveRecordPhoto, records.remove_photo),
        _said(SignRecord, records.sign),
        _given(RequestControl, control.request),
        _given(AnswerControl, control.answer),
        _given(ReleaseControl, control.release),
        _given(RenewControl, control.renew),
    )
)
"""What carries out every order to the site, stored before it returns; those about alarms need their desk."""
