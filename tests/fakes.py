"""A machine and a store that live in memory, and a panel that runs on them.

`python -m tests.fakes` serves the whole panel on http://127.0.0.1:8010 with moving values.
"""

import asyncio
import contextlib
import shutil
import tempfile
import weakref
from collections.abc import AsyncIterator
from dataclasses import replace
from datetime import datetime, timedelta
from functools import cache
from pathlib import Path
from zoneinfo import available_timezones

import httpx
import uvicorn
from fastapi import FastAPI

from app.alarms.urgency import newest, site_messages, with_messages
from app.base.clock import Clock, SystemClock
from app.base.message import say
from app.base.settings import Settings
from app.link.alarm_orders import AcknowledgeAlarm, SetNotifications, ShelveAlarm, UnshelveAlarm
from app.link.messages import (
    AddTracker,
    ApplySightings,
    ConfigureTracker,
    ConfirmStep,
    DeleteRecording,
    MachineUnreachable,
    Order,
    RemoveTracker,
    RenameSite,
    ReportDeviceClock,
    SavePlan,
    SaveRecording,
    SetClock,
    SetLocation,
    SiteDetail,
    StopAll,
    TakeSighting,
    TrackerDetail,
    UnknownRecording,
    UnknownTracker,
    Update,
)
from app.link.metrics import GatewayMetrics, GatewayStatus, MachineMetrics
from app.link.outlet import Outlet
from app.link.place_orders import SetHorizon
from app.link.record_orders import AddRecordPhoto, RemoveRecordPhoto, SignRecord
from app.link.weather_orders import ReportWeather, SetMetStation, SetWeatherWindows, SimulateWeather
from app.store.store import PlannedShow
from app.tracker.commands.commands import (
    CommandRejected,
    Stop,
)
from app.tracker.commissioning.drive_test_states import proof_states
from app.tracker.commissioning.steps import Step as WizardStep
from app.tracker.commissioning.steps import StepStatus
from app.tracker.memory.memory import (
    ClockSetting,
    Confirmation,
    SiteState,
    StepName,
    TrackerMemory,
    TrackerState,
)
from app.tracker.state.snapshot import (
    ActivityName,
    ClockState,
    Event,
    EventKind,
    Pair,
    SiteSnapshot,
    Snapshot,
)
from app.tracker.values.alarm_words import AlarmNow
from app.tracker.values.reason import Reason
from app.tracker.weather.weather import WeatherNow
from app.web.documented import DocumentedApp
from app.web.main import create_app
from tests.fake_alarms import after, counted, in_book
from tests.fake_data import commissioned, made_up_sun, site_state
from tests.fake_records import keep_record
from tests.fake_store import FakeReader
from tests.fake_tracker import CAPABILITIES, FakeTracker

PORT = 8010
KINDS = {
    "stop": EventKind.STOPPED,
    "stop_all": EventKind.STOPPED,
    "set_location": EventKind.LOCATION_SET,
}


GATEWAYS = (
    GatewayMetrics(
        "SunSpec over Modbus TCP",
        GatewayStatus.LISTENING,
        "127.0.0.1:5021",
        2,
        writes=say("{hosts} may write; all other hosts can only read.", hosts="10.0.0.5"),
    ),
    GatewayMetrics(
        "MQTT",
        GatewayStatus.CONNECTING,
        "broker.example:8883",
        error=say(
            "The broker at {where} cannot be reached: {first}. Heliopanel retries automatically.",
            where="broker.example:8883",
            first="Connection refused",
        ),
        waiting=128,
    ),
    GatewayMetrics(
        "SunSpec over Modbus RTU",
        GatewayStatus.OFF,
        say("set HELIOPANEL_{variable} to enable it", variable="SUNSPEC_SERIAL_PORT"),
    ),
)


class FakeMachine:
    """A machine with T1 holding and T2 tracking; it keeps every order it got.

    `rejects` maps a command's kind to the reasons with which it is refused; with a `refusal` every order is
    refused for being wrong; `cut()` cuts the link.
    """

    def __init__(self, clock: Clock | None = None) -> None:
        self.store = FakeReader()
        self.clock = clock or SystemClock()
        self.site: SiteState = site_state()
        holding, tracking = (
            commissioned("T1", "North field", tracking=False),
            commissioned("T2", "South field", tracking=True),
        )
        self.trackers = {
            "T1": FakeTracker(holding, Pair(180.0, 45.0)),
            "T2": FakeTracker(tracking, Pair(180.0, 60.0)),
        }
        self.orders: list[Order] = []
        self.device_clocks: dict[str, float] = {}
        """By how much each page says that this clock is ahead of its device's: a sign of life, no order."""
        self.rejects: dict[str, tuple[Reason, ...]] = {}
        self.refusal = ""
        self.reachable = True
        self.off_s: float | None = None
        self.weather: WeatherNow | None = None
        self.alarms: tuple[AlarmNow, ...] = ()
        self.last: dict[str, Event | None] = {}
        self.sequence = 0
        self.boot_id = "fake-boot"
        self._outlet = Outlet()
        self.emit()

    async def execute(self, order: Order) -> SiteSnapshot:
        """Carry out one order and tell every reader."""
        if not self.reachable:
            raise MachineUnreachable("The controller service does not answer.")
        if self.refusal:
            raise ValueError(self.refusal)
        if isinstance(order.command, ReportDeviceClock):
            self.device_clocks[order.command.page] = order.command.ahead_s
            return self.site
        self.orders.append(order)
        if reasons := self.rejects.get(order.command.kind):
            raise CommandRejected(*reasons)
        event = self._carry_out(order)
        return self.emit(event)

    def _carry_out(self, order: Order) -> Event:
        now = self.clock.now()
        if order.tracker_id is not None:
            self._tracker(order.tracker_id).handle(order.command, now, order.actor)  # type: ignore[arg-type]
        else:
            self._site_command(order, now)
        kind = KINDS.get(order.command.kind, EventKind.TRACKER_CHANGED)
        return Event(now, kind, order.tracker_id, f"Done: {order.command.kind}.", order.actor)

    def _site_command(self, order: Order, now: datetime) -> None:  # noqa: C901 - one flat table of cases
        match order.command:
            case SetLocation(location=location, time_zone=zone):
                _check_zone(zone)
                revision = self.site.location_revision + 1
                self.site = replace(self.site, location=location, time_zone=zone, location_revision=revision)
            case SetHorizon(horizon=horizon):
                self.site = replace(self.site, horizon=horizon)
            case SetClock(source=source, at=at, time_zone=zone):
                _check_zone(zone or "UTC")
                offset_s = (at - now).total_seconds() if at else 0.0
                setting = ClockSetting(source, offset_s, now, order.actor)
                self.site = replace(self.site, clock=setting, time_zone=zone or self.site.time_zone)
            case SetMetStation(station=station):
                made_up = None if station else self.site.simulated_weather
                self.site = replace(self.site, met_station=station, simulated_weather=made_up)
            case SimulateWeather(station=station):
                self.site = replace(self.site, simulated_weather=station, met_station=None)
            case SetNotifications(notifications=notifications):
                self.site = replace(self.site, notifications=notifications)
            case SetWeatherWindows(windows=windows):
                self.site = replace(self.site, weather_windows=windows)
            case RenameSite(name=name):
                self.site = replace(self.site, name=name)
            case AddTracker(config=config):
                if config.tracker_id in self.trackers:
                    raise ValueError(f"Tracker {config.tracker_id} already exists.")
                fresh = TrackerState(config, TrackerMemory())
                self.trackers[config.tracker_id] = FakeTracker(fresh, Pair(12.0, 8.0))
            case ConfigureTracker(config=config):
                self._tracker(config.tracker_id).config = config
            case RemoveTracker(tracker_id=tracker_id):
                self._tracker(tracker_id)
                del self.trackers[tracker_id]
            case ConfirmStep(tracker_id=tracker_id, step=step):
                tracker = self._tracker(tracker_id)
                confirmed = tracker.memory.confirmations | {
                    step: Confirmation(now, order.actor, self.site.location_revision)
                }
                tracker.memory = replace(tracker.memory, confirmations=confirmed)
            case StopAll():
                for tracker in self.trackers.values():
                    tracker.handle(Stop(), now, order.actor)
            case SaveRecording(info=info):
                self.store.heads[info.recording_id] = info
            case DeleteRecording(recording_id=recording_id):
                if self.store.heads.pop(recording_id, None) is None:
                    raise UnknownRecording(recording_id)
            case SavePlan(tracker_id=tracker_id, plan=plan):
                self.store.shows[plan.show_id] = PlannedShow(tracker_id, plan)
            case TakeSighting(tracker_id=tracker_id):
                self._tracker(tracker_id)
            case AddRecordPhoto() | RemoveRecordPhoto() | SignRecord():
                self._tracker(order.command.tracker_id)
                keep_record(self.store, order.command, now, order.actor)
            case ApplySightings(tracker_id=tracker_id, keep=keep):
                tracker = self._tracker(tracker_id)
                tracker.memory = replace(tracker.memory, sightings=keep)
            case AcknowledgeAlarm() | ShelveAlarm() | UnshelveAlarm():
                self.alarms = after(self.alarms, order.command, now, order.actor)
            case ReportWeather(readings=readings, measured_at=at):
                self.weather = WeatherNow(readings, at or now, 0.0, stale=False, source=order.actor)

    def _tracker(self, tracker_id: str) -> FakeTracker:
        if tracker_id not in self.trackers:
            raise UnknownTracker(tracker_id)
        return self.trackers[tracker_id]

    def emit(self, *events: Event) -> SiteSnapshot:
        """Tell every reader how things stand now."""
        self.sequence += 1
        for event in events:
            if event.tracker_id is not None:
                self.last[event.tracker_id] = newest(self.last.get(event.tracker_id), event)
        snapshot = self._snapshot()
        self._outlet.publish(snapshot, events)
        return snapshot

    def tick(self) -> SiteSnapshot:
        """End the jogs that were not renewed in time, and tell every reader."""
        now = self.clock.now()
        return self.emit(*(event for one in self.trackers.values() for event in one.overdue(now)))

    def rest(self) -> None:
        """Have every tracker hold, and tell every reader."""
        for tracker in self.trackers.values():
            tracker.activity = ActivityName.HOLDING
            tracker.memory = replace(tracker.memory, tracking_on=False)
        self.emit()

    def cut(self) -> None:
        """Lose the link: readers end, orders fail."""
        self.reachable = False
        self._outlet.end()

    def mend(self) -> None:
        """Have the link back."""
        self.reachable = True
        self.emit()

    def start_again(self) -> None:
        """Begin another life, as after a restart of the controller service."""
        self.boot_id = "second-boot"
        self.emit()

    def _snapshot(self) -> SiteSnapshot:
        now = self.clock.now() + timedelta(seconds=self.site.clock.offset_s)
        clock = self.site.clock
        return SiteSnapshot(
            boot_id=self.boot_id,
            sequence=self.sequence,
            at=now,
            site_name=self.site.name,
            location=self.site.location,
            time_zone=self.site.time_zone,
            clock=ClockState(
                clock.source, clock.offset_s, clock.source != "unset", None, clock.set_at, off_s=self.off_s
            ),
            sun=made_up_sun(now),
            trackers=(trackers := tuple(self._told(one, now) for one in self.trackers.values())),
            weather=self.weather,
            alarms=self.alarms,
            alarm_counts=counted(self.alarms),
            messages=site_messages(trackers, self.alarms),
            sun_behind_horizon=self.site.horizon.hides(
                made_up_sun(now).azimuth_deg, made_up_sun(now).elevation_deg
            ),
        )

    def _told(self, tracker: FakeTracker, now: datetime) -> Snapshot:
        """Return a tracker with what to know about it, as the controller tells it."""
        name = tracker.config.tracker_id
        alarms = {one.alarm_id: in_book(one) for one in self.alarms if one.tracker_id == name}
        return with_messages(tracker.snapshot(now, self.sequence), alarms, self.last.get(name))

    async def metrics(self) -> MachineMetrics:
        """Return counters of a machine that has done nothing yet, with its doors in every state."""
        if not self.reachable:
            raise MachineUnreachable("The controller service does not answer.")
        return MachineMetrics("fake-boot", 5.0, gateways=GATEWAYS)

    async def detail(self) -> SiteDetail:
        """Return stored settings, steps and capabilities."""
        if not self.reachable:
            raise MachineUnreachable("The controller service does not answer.")
        return SiteDetail(self.site, {name: self._detail(one) for name, one in self.trackers.items()})

    def _detail(self, tracker: FakeTracker) -> TrackerDetail:
        known = self.site.confirmations | tracker.memory.confirmations
        steps = []
        for name in StepName:
            given = known.get(name)
            status = StepStatus.DONE if given else StepStatus.TO_DO
            reasons = () if given else (Reason(f"{name}_open", f"Step {name} is not done yet.", "Do it."),)
            steps.append(WizardStep(name, status, reasons, given and given.at, given.by if given else ""))
        proofs = proof_states(tracker.config, tracker.memory, CAPABILITIES)
        state = TrackerState(tracker.config, tracker.memory)
        return TrackerDetail(state, tuple(steps), CAPABILITIES, proofs, tracker.check)

    async def tracker(self, tracker_id: str) -> Snapshot:
        """Return one tracker now."""
        if not self.reachable:
            raise MachineUnreachable("The controller service does not answer.")
        return self._told(self._tracker(tracker_id), self.clock.now())

    async def watch(self, tracker_ids: frozenset[str]) -> None:
        """Do nothing: actions are always told here."""

    def latest(self) -> SiteSnapshot | None:
        """Return the newest snapshot, None while the link is cut."""
        return self._outlet.latest

    def updates(self) -> AsyncIterator[Update]:
        """Yield what `emit` tells, until the link is cut."""
        return self._outlet.subscribe()


def _check_zone(name: str) -> None:
    if name not in available_timezones():
        raise ValueError(f"{name} is not a time zone; give an IANA name such as Europe/Istanbul.")


@cache
def settings() -> Settings:
    """Return the settings of every fake panel, read once: that takes half of the time of making one."""
    return Settings(port=PORT)


def fake_app(machine: FakeMachine | None = None, reader: FakeReader | None = None) -> DocumentedApp:
    """Return the whole panel on the fakes, with a data folder of its own that goes with it."""
    folder = Path(tempfile.mkdtemp(prefix="heliopanel-fakes-"))
    machine = machine or FakeMachine()
    app = create_app(
        settings().model_copy(update={"data_dir": folder}),
        machine=machine,
        reader=reader or machine.store,
        clock=machine.clock,
    )
    weakref.finalize(app, shutil.rmtree, folder, ignore_errors=True)
    return app


@contextlib.asynccontextmanager
async def serving(app: FastAPI) -> AsyncIterator[httpx.AsyncClient]:
    """Run an application in process, with its start and end, and give a client for it."""
    async with app.router.lifespan_context(app):
        transport = httpx.ASGITransport(app)
        async with httpx.AsyncClient(transport=transport, base_url=f"http://127.0.0.1:{PORT}") as client:
            yield client


async def _animate(machine: FakeMachine) -> None:
    while True:
        machine.emit()
        await machine.clock.sleep_until(machine.clock.now() + timedelta(milliseconds=200))


async def _main() -> None:
    machine = FakeMachine()
    moving = asyncio.create_task(_animate(machine))
    app = fake_app(machine)
    server = uvicorn.Server(uvicorn.Config(app, host="127.0.0.1", port=PORT, timeout_graceful_shutdown=2))
    await server.serve()
    moving.cancel()


if __name__ == "__main__":
    asyncio.run(_main())
