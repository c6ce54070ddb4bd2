"""What a site consists of: its stored state, its clock and sky, its trackers, and what is kept of them."""

import asyncio
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from datetime import datetime, timedelta

from app.base.clock import Clock
from app.base.message import N_, Message, say, told_by
from app.drives.drive import Drive, check_fit
from app.link.messages import UnknownTracker
from app.modbus.errors import DriveError
from app.site.clock.timekeeping import Timekeeper
from app.site.loop.loop import TrackerLoop
from app.site.loop.overload import Overload
from app.site.loop.scheduler import Scheduler
from app.site.recording.recorder import Recorder
from app.site.recording.write_queue import Ledger
from app.site.state.authority import control_state
from app.site.state.connection_test import Checks
from app.site.state.controls import Controls
from app.site.state.simulated_reader import SimulatedReader
from app.site.state.unusable import UnusableDrive
from app.site.weather.kept_weather import WeatherFile
from app.site.weather.met_poll import MetPoll, Station, StationReader
from app.site.weather.sky import Sky
from app.site.weather.weather import WeatherStation
from app.sun.position import Algorithm, SunPosition
from app.tracker.access.location_change import AT_REST, Doing
from app.tracker.memory.memory import MetStation, SiteState, TrackerState
from app.tracker.memory.observation import Observation
from app.tracker.protections.guarding import wind_of
from app.tracker.protections.wind_stow import is_high
from app.tracker.protections.words import Protection
from app.tracker.settings.config import DriveKind, TrackerConfig
from app.tracker.state.snapshot import Event, EventKind, Snapshot
from app.tracker.values.motion import Feedback
from app.tracker.weather.played_weather import SECOND_MAST, second_mast
from app.tracker.weather.simulated_weather import SimulatedStation
from app.tracker.weather.weather import Weather


@dataclass(slots=True)
class SiteModel:
    """The parts that orders change and ticks read; it belongs to one event loop."""

    clock: Clock
    timekeeper: Timekeeper
    ledger: Ledger
    recorder: Recorder
    state: SiteState
    period: timedelta
    make_drive: Callable[[TrackerConfig], Drive]
    on_tick: Callable[[TrackerLoop, Observation, tuple[Event, ...]], None]
    loops: dict[str, TrackerLoop] = field(default_factory=dict)
    sky: Sky = field(default_factory=Sky)
    checks: Checks = field(default_factory=Checks)
    overloaded: Callable[[Overload], None] = lambda _: None
    measured: WeatherStation = field(default_factory=WeatherStation)
    made_up: WeatherStation | None = None
    weather_file: WeatherFile = field(default_factory=lambda: WeatherFile(None))
    make_station: Callable[[MetStation], StationReader] | None = None
    met: MetPoll = field(init=False)
    arrivals: int = 0
    """How often trackers came or went: who keeps something of each of them looks when it changes."""
    scheduler: Scheduler = field(init=False)

    def __post_init__(self) -> None:
        self.scheduler = Scheduler(self.clock, self.period, self.overloaded)
        self.met = MetPoll(self.clock, self._reader, self._take_weather)

    control: Controls = field(default_factory=Controls)
    changing: asyncio.Lock = field(default_factory=asyncio.Lock)
    """Held while something that is stored is changed; never while a drive or the network is waited for."""

    @property
    def station(self) -> Station | None:
        """Return the weather station of this site; made-up weather never moves a real tracker."""
        drives = {loop.config.drive.kind for loop in self.loops.values()}
        made_up = self.state.simulated_weather if drives <= {DriveKind.SIMULATED} else None
        return made_up or (self.state.met_station if self.make_station else None)

    @property
    def weather(self) -> WeatherStation:
        """Return the weather that counts; what is measured and what is made up are never mixed."""
        return self.made_up or self.measured

    def recall_weather(self) -> None:
        """Know the weather from before the restart, and note on disk that none has been heard since."""
        kept = self.weather_file.recall(self.now())
        if kept is not None:
            self.measured.recall(kept, self.now(), self.clock.now())
            self.keep_weather()

    def keep_weather(self) -> None:
        """Have what was measured outlive this life of the controller, as far as it matters."""
        now = self.clock.now()
        limits = (loop.config.protection.wind for loop in self.loops.values())
        kept = self.measured.kept(self.now(), now)
        self.weather_file.keep(kept, now, limits, self.recorder.stored_at)

    def rouse(self) -> None:
        """Have every tracker tick now that the wind is to stow and has not yet: none waits for its turn."""
        sensed = self.weather.sensed(self.clock.now())
        for loop in self.loops.values():
            limits = loop.config.protection.wind
            is_new = limits.enabled and loop.memory.protection is not Protection.WIND_STOW
            if is_new and is_high(limits, wind_of(sensed, limits)):
                loop.wake()

    def now(self) -> datetime:
        """Return the site's time."""
        return self.timekeeper.now()

    def sun(self) -> SunPosition | None:
        """Return where the sun stands over the site now, None while location or clock are unknown."""
        return self.sky.sun(self.state.location, Algorithm.PSA, self.now())

    def tracker(self, tracker_id: str | None) -> TrackerLoop:
        """Return a tracker's loop, or raise `UnknownTracker`."""
        if tracker_id is None or tracker_id not in self.loops:
            raise UnknownTracker(say("There is no tracker {tracker_id} on this site.", tracker_id=tracker_id))
        return self.loops[tracker_id]

    def snapshot(self, loop: TrackerLoop, at: datetime, *, asked: bool = True) -> Snapshot:
        """Return one tracker as everyone sees it, with who has control of it; `asked` as in the loop's."""
        authority = self.control.of(loop.config.tracker_id, loop.memory.control_epoch)
        return replace(loop.snapshot(at, asked=asked), control=control_state(authority, self.clock.now(), at))

    def rests(self, loop: TrackerLoop) -> bool:
        """Return whether a tracker neither moves nor means to."""
        return not loop.moving and loop.activity in AT_REST

    def doing(self) -> dict[str, Doing]:
        """Return what each tracker does, and whether it goes on tracking with nobody asked."""
        return {tracker_id: loop.doing for tracker_id, loop in self.loops.items()}

    def observe(self, config: TrackerConfig, feedback: Feedback | None) -> Observation:
        """Return everything one tick of one tracker may depend on."""
        now, site_time, location = self.clock.now(), self.now(), self.state.location
        return Observation(
            now=now,
            site_time=site_time,
            sun=self.sky.sun(location, config.algorithm, site_time),
            dawn=self.sky.dawn(location, config.algorithm, site_time),
            feedback=feedback,
            clock_trusted=not self.timekeeper.reasons(),
            location=location,
            location_revision=self.state.location_revision,
            weather=self.weather.sensed(now),
        )

    def check_drive(self, config: TrackerConfig) -> None:
        """Raise `ValueError` if no drive can be made of a configuration, or its numbers do not fit."""
        if config.drive.kind is DriveKind.SIMULATED:
            return
        try:
            check_fit(self.make_drive(config))
        except DriveError as error:
            raise ValueError(told_by(error)) from error

    def add(self, state: TrackerState) -> TrackerLoop:
        """Put a tracker on the site, or in the place of the one with its id; it does not tick yet."""
        loop = TrackerLoop(
            state,
            self._drive_of(state.config),
            self.clock,
            self,
            self.scheduler,
            period=self.period,
            on_tick=self.on_tick,
        )
        self.loops[state.config.tracker_id] = loop
        self.arrivals += 1
        return loop

    def drop(self, tracker_id: str) -> None:
        """Take a tracker off the site; who drops it sees to its loop."""
        del self.loops[tracker_id]
        self.arrivals += 1

    def _drive_of(self, config: TrackerConfig) -> Drive:
        try:
            return self.make_drive(config)
        except (DriveError, ValueError) as error:
            return UnusableDrive(told_by(error))

    def _reader(self, station: Station) -> StationReader:
        if isinstance(station, SimulatedStation):
            return SimulatedReader(station, self.now, self.sun)
        if self.make_station is None:
            raise ValueError(N_("This controller reads no weather stations."))
        return self.make_station(station)

    def _take_weather(self, readings: Weather | None, impossible: tuple[str, ...], source: str) -> None:
        made_up = self.state.simulated_weather
        second = None if made_up is None else second_mast(made_up, readings)
        if second is not None:
            self.weather.receive(second, None, SECOND_MAST, self.now(), self.clock.now())
        self.weather.receive(readings, None, source, self.now(), self.clock.now(), impossible)
        self.rouse()
        if made_up is None:
            self.keep_weather()

    def event(
        self, kind: EventKind, message: Message, actor: str, tracker_id: str | None = None, **data: object
    ) -> Event:
        """Return an event of this instant."""
        return Event(self.now(), kind, tracker_id, message, actor, data)
