"""A site: trackers living on one clock. It carries out orders and tells everyone what is."""

import asyncio
from collections.abc import AsyncIterator, Callable, Sequence
from dataclasses import dataclass, field, replace
from datetime import timedelta
from pathlib import Path

from app.alarms.alarm import Alarm
from app.alarms.conditions import Condition
from app.base.clock import Clock
from app.base.logs import get_logger
from app.base.message import N_, say, with_format
from app.drives.drive import Drive
from app.link.messages import Order, SiteCommand, SiteDetail, Update
from app.link.metrics import MachineMetrics
from app.link.outlet import Listener, Outlet
from app.link.whole import with_tracker
from app.site.clock.timekeeping import Timekeeper
from app.site.loop.loop import TrackerLoop
from app.site.loop.overload import CODE, Overload
from app.site.orders import (
    control,
    dispatch,
    sightings,
    tracker_orders,
)
from app.site.orders.idempotency import Overtaken, Repeats, refuse_untimely
from app.site.publishing.alarming import AlarmDesk
from app.site.publishing.details import Details
from app.site.publishing.health import resident_bytes
from app.site.publishing.publishing import Publisher, concerned
from app.site.recording.auditing import Auditor, as_action
from app.site.recording.gathering import BackgroundWriter, GiveWay
from app.site.recording.recorder import Recorder
from app.site.recording.write_queue import Ledger
from app.site.retention import Limits, Retention
from app.site.state.connection_test import Checks, DriveTools
from app.site.state.model import SiteModel
from app.site.weather.kept_weather import WeatherFile
from app.site.weather.met_poll import StationReader
from app.site.weather.weather import WeatherStation
from app.tracker.commands.commands import Command, CommandRejected
from app.tracker.memory.memory import MetStation, SiteState, TrackerState
from app.tracker.memory.observation import Observation
from app.tracker.settings.config import TrackerConfig
from app.tracker.state.snapshot import Event, EventKind, SiteSnapshot, Snapshot
from app.tracker.values.actors import CONTROLLER
from app.tracker.values.notifications import Notifications
from app.tracker.values.order_spec import Motion
from app.tracker.values.reason import Reason
from app.tracker.weather.weather_windows import USUAL_OLD_S, same_age

PULSE = timedelta(milliseconds=500)
CONTROL_EVERY = timedelta(milliseconds=250)
CATCH_UP_EVERY = timedelta(seconds=2)
SAMPLES_EVERY = timedelta(seconds=300)

log = get_logger()


@dataclass(frozen=True, slots=True)
class SiteOptions:
    """How a site lives: its tick, what it keeps, and the id of this life of the machine.

    With `safe_mode` everything but stopping is refused for that reason. `pause` is how the writer's thread
    waits for a loop that is pressed; without it, it does not.
    """

    boot_id: str = "boot"
    period: timedelta = timedelta(milliseconds=100)
    retention: Limits = field(default_factory=Limits)
    samples_every: timedelta = SAMPLES_EVERY
    weather_stale_after: timedelta = timedelta(seconds=USUAL_OLD_S)
    disk_free: Callable[[], int | None] = lambda: None
    safe_mode: Reason | None = None
    make_station: Callable[[MetStation], StationReader] | None = None
    weather_file: Path | None = None
    pause: Callable[[float], object] | None = None


class Site:
    """The machine itself: implements `Machine`, directly in tests and behind the link server in service."""

    def __init__(
        self,
        clock: Clock,
        make_drive: Callable[[TrackerConfig], Drive],
        state: SiteState,
        trackers: tuple[TrackerState, ...],
        *,
        timekeeper: Timekeeper | None = None,
        writer: BackgroundWriter | None = None,
        options: SiteOptions | None = None,
        tools: DriveTools | None = None,
        alarms: Sequence[Alarm] = (),
    ) -> None:
        self._options = options or SiteOptions()
        self._clock = clock
        pause = self._options.pause
        paced = iter if pause is None else GiveWay(lambda: self.model.scheduler.pressed, pause)
        ledger = Ledger(writer, clock, paced)
        windows = state.weather_windows or same_age(self._options.weather_stale_after)
        self.model = SiteModel(
            clock,
            timekeeper or Timekeeper(clock, state.clock),
            ledger,
            Recorder(ledger, self._options.period, self._options.samples_every),
            state,
            self._options.period,
            make_drive,
            self._on_tick,
            checks=Checks(tools),
            measured=WeatherStation(windows),
            made_up=None if state.simulated_weather is None else WeatherStation(windows, simulated=True),
            weather_file=WeatherFile(self._options.weather_file),
            make_station=self._options.make_station,
            overloaded=self._shed,
        )
        for tracker in trackers:
            self.model.add(tracker)
        self._auditor = Auditor(self._options.boot_id, self.model.timekeeper, ledger.post_entry)
        self._alarms = AlarmDesk.open(self.model, alarms, self._options.disk_free)
        self._handlers = dispatch.handlers_with(self._alarms)
        self._outlet = Outlet()
        self._repeats = Repeats()
        self._overtaken = Overtaken()
        self._details = Details(self.model)
        self._retention = Retention(self.model, self._options.retention)
        self.publisher = Publisher(self.model, self._alarms, self._outlet, self._options.boot_id)
        self._started_at = self._caught_up_at = clock.now()
        self._orders = self._refused = 0
        self._tasks: tuple[asyncio.Task[None], ...] = ()

    async def start(self, *events: Event) -> None:
        """Begin to tick, and journal how this life began."""
        self.model.ledger.post_events(events)
        self.model.recall_weather()
        sightings.ask_the_sun(self.model)
        self.model.scheduler.start()
        for loop in self.model.loops.values():
            loop.start()
        await self.model.met.follow(self.model.station)
        self.publisher.publish(self.model.loops, events)
        self._tasks = (
            asyncio.create_task(self._beat(), name=N_("site pulse")),
            asyncio.create_task(self._watch_control(), name=N_("control authority")),
            asyncio.create_task(self.publisher.run(), name="publisher"),
        )

    async def close(self, *events: Event) -> None:
        """Stop every drive, end every recording and tell nobody any more."""
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        await self.model.met.close()
        await asyncio.gather(*(loop.close() for loop in self.model.loops.values()))
        await self.model.scheduler.close()
        await self.model.weather_file.close(self.model.measured.kept(self.model.now(), self._clock.now()))
        now = self.model.now()
        for tracker_id in self.model.loops:
            self.model.recorder.finish(tracker_id, now, N_("controller stopped"))
        self.model.recorder.flush(self._clock.now(), at_once=True)
        self.model.ledger.post_events(events)
        self.publisher.publish(self.model.loops, events)
        self.model.ledger.close()
        self._outlet.end()

    def note(self, *events: Event) -> None:
        """Journal and tell what happened at one of the site's other doors."""
        self.model.ledger.post_events(events)
        self.publisher.mark((), events, at_once=True)

    def trouble(self, name: str, condition: Condition | None) -> None:
        """Note a condition that is for the alarms, or with None that it is over."""
        self._alarms.trouble(name, condition)

    @property
    def notifications(self) -> Notifications:
        """Return where alarms are to be sent."""
        return self.model.state.notifications

    async def stop_drives(self) -> None:
        """Stop every drive for good, as far as each can be reached: the machine is about to end."""
        await asyncio.gather(*(loop.stop_for_good() for loop in self.model.loops.values()))

    async def execute(self, order: Order) -> SiteSnapshot:
        """Carry out one order and return the snapshot after it."""
        self._orders += 1
        try:
            if order.key is None:
                return await self._carry_out(order)
            return await self._repeats.once(order, self._carry_out)
        except Exception:
            self._refused += 1
            raise

    async def detail(self) -> SiteDetail:
        """Return stored settings, steps and capabilities."""
        trackers = await self._details.all()
        state = replace(self.model.state, weather_windows=self.model.weather.windows)
        return SiteDetail(state, trackers, await self.model.checks.choices())

    def latest(self) -> SiteSnapshot | None:
        """Return the newest snapshot that was told."""
        return self._outlet.latest

    async def tracker(self, tracker_id: str) -> Snapshot:
        """Return one tracker now, with what may be asked of it."""
        return self.publisher.told(self.model.snapshot(self.model.tracker(tracker_id), self.model.now()))

    async def watch(self, tracker_ids: frozenset[str], who: object = None) -> None:
        """Have snapshots of these trackers told with their actions, as long as one who watches them does."""
        self.publisher.watch(tracker_ids, who)

    def listen(self) -> Listener:
        """Return a new subscriber of the updates."""
        return self._outlet.listen()

    def updates(self) -> AsyncIterator[Update]:
        """Yield updates until the site ends; a slow reader skips snapshots, never events."""
        return self._outlet.subscribe()

    async def metrics(self) -> MachineMetrics:
        """Return what this machine counts about itself."""
        model, writer = self.model, self.model.ledger.writer
        return MachineMetrics(
            boot_id=self._options.boot_id,
            uptime_s=(self._clock.now() - self._started_at).total_seconds(),
            trackers={name: loop.counter.metrics() for name, loop in model.loops.items()},
            orders=self._orders,
            orders_refused=self._refused,
            events=model.ledger.event_count,
            events_waiting=self._outlet.waiting,
            samples_waiting=model.recorder.samples_waiting,
            store_queue=getattr(writer, "pending", 0),
            store_failures=getattr(writer, "failed", 0) + getattr(writer, "dropped", 0),
            resident_bytes=resident_bytes() or 0,
            lateness=model.scheduler.lateness.metrics(),
            overloaded=model.scheduler.overload.active,
        )

    @property
    def alive(self) -> bool:
        """Return whether what makes trackers tick and the tasks of the site still run."""
        runs = bool(self._tasks) and not any(task.done() for task in self._tasks)
        return runs and self.model.scheduler.alive

    @property
    def rests(self) -> bool:
        """Return whether no tracker moves or means to."""
        return all(self.model.rests(loop) for loop in self.model.loops.values())

    async def _carry_out(self, order: Order) -> SiteSnapshot:
        with self._auditor.recording(order):
            command, given_s = order.command, self._given_s(order)
            if isinstance(command, SiteCommand):
                events = await dispatch.carry_out(self._handlers, self.model, command, order)
            else:
                loop, command = await self._admitted(order, command)
                self._overtaken.refuse(command, loop.config, given_s)
                events = await tracker_orders.command(self.model, loop, command, order.actor, order.via)
                if command.spec.held and not events:
                    return self.publisher.newest
            return await self._told(order, events)

    def _given_s(self, order: Order) -> float:
        """Note a stop and return when an order was given, or raise `CommandRejected`."""
        refuse_untimely(order, self.model.now())
        spec, given_s = order.command.spec, order.given_s
        if given_s is None:
            given_s = asyncio.get_running_loop().time()
        if spec.motion is Motion.STOPS:
            stopped = (one for one in self.model.loops if order.tracker_id in (None, one))
            self._overtaken.stopped(given_s, stopped)
        if self._options.safe_mode is not None and not spec.in_safe_mode:
            raise CommandRejected(self._options.safe_mode)
        return given_s

    async def _admitted(self, order: Order, command: Command) -> tuple[TrackerLoop, Command]:
        """Return the tracker and the command if whoever ordered has control, or takes it by it."""
        loop = self.model.tracker(order.tracker_id)
        with as_action("take_control"):
            command, taken = await control.admit(self.model, loop, order, command)
        if taken:
            self.publisher.publish((loop.config.tracker_id,), taken)
        return self.model.tracker(order.tracker_id), command

    async def _told(self, order: Order, events: tuple[Event, ...]) -> SiteSnapshot:
        """Tell what happened and return the site after it; the tracker it is about has its `actions`."""
        about = concerned(order, self.model.loops)
        await self.publisher.tell(about, events)
        if len(about) != 1 or about[0] not in self.model.loops:
            return self.publisher.newest
        return with_tracker(self.publisher.newest, await self.tracker(about[0]))

    def _on_tick(self, loop: TrackerLoop, seen: Observation, events: tuple[Event, ...]) -> None:
        """Keep what a tick changed, record it and tell it."""
        if loop.take_changed():
            self.model.ledger.post_tracker(loop.state, events)
        else:
            self.model.ledger.post_events(events)
        self.model.recorder.observe(loop, self.model.state, seen, events)
        self.publisher.ticked(loop, events)

    async def _beat(self) -> None:
        """Every half second: watch the clock, hand samples to the store, remove what is too old."""
        due = self._clock.now()
        while True:
            self._watch_clock()
            now = self._clock.now()
            self.model.recorder.flush(now)
            if now - self._caught_up_at >= CATCH_UP_EVERY:
                self._caught_up_at = now
                self._catch_up()
            self._retention.beat()
            self.publisher.beat()
            due = max(due + PULSE, now)
            await self._clock.sleep_until(due)

    async def _watch_control(self) -> None:
        """Four times a second: let control pass whose countdown has run out, and end what nobody renews."""
        while True:
            for tracker_id in self.model.control.held:
                loop = self.model.loops.get(tracker_id)
                events = () if loop is None else await control.settle(self.model, loop)
                if loop is not None and events:
                    self.publisher.publish((loop.config.tracker_id,), events)
            await self._clock.sleep_until(self._clock.now() + CONTROL_EVERY)

    def _catch_up(self) -> None:
        """Store what could not be stored before: a latch must outlive a power cut."""
        model = self.model
        self._spare_the_disk()
        if model.ledger.behind:
            states = tuple(loop.state for loop in model.loops.values())
            model.ledger.catch_up(model.state, states, self._alarms.standing())
        if self._auditor.head_is_due(self._clock.now()):
            model.ledger.post_head()

    def _spare_the_disk(self) -> None:
        """Record no samples while hardly anything is free: what is left is for events and settings."""
        recorder, code = self.model.recorder, "disk_full"
        (recorder.suspend if code in self._alarms.books.of(None).present else recorder.resume)(code)

    def _shed(self, overload: Overload) -> None:
        """Leave out, or take up again, what is not motion, and tell it: every tick and every stop goes on."""
        self.publisher.slow(slow=overload.active)
        (self.model.recorder.suspend if overload.active else self.model.recorder.resume)(CODE)
        self._alarms.trouble(CODE, overload.condition())

    def _watch_clock(self) -> None:
        jump = self.model.timekeeper.watch()
        if jump is None:
            return
        moved_s = jump.by.total_seconds()
        event = self.model.event(
            EventKind.CLOCK_JUMPED,
            say(
                "The system clock jumped by {moved_s} s; automatic motion is held until the clock is "
                "confirmed or has been stable for 60 s.",
                moved_s=with_format(moved_s, "+.1f"),
            ),
            CONTROLLER,
            seconds=moved_s,
        )
        self.model.state = replace(self.model.state, clock=self.model.timekeeper.setting)
        self.model.ledger.post_site(self.model.state, (event,))
        self.publisher.publish((), (event,))
