"""The real controller on a simulated drive and a virtual clock, driven tick by tick."""

from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, datetime, timedelta

from app.base.clock import VirtualClock
from app.base.message import N_, say
from app.show.simulated_weather import MadeUpWeather
from app.simulation.simulated import SimulatedDrive
from app.simulation.sunlight import Sunlight
from app.site.weather.sky import Sky
from app.sun.position import Location, SunPosition
from app.tracker.commands.commands import Command, Home
from app.tracker.controller import Controller
from app.tracker.memory.memory import Pointing, TrackerMemory
from app.tracker.memory.observation import Observation
from app.tracker.settings.config import TrackerConfig
from app.tracker.state.snapshot import ActivityName, Event, Snapshot
from app.tracker.values.motion import DriveCommand, Halt
from app.tracker.weather.weather import NOTHING_SENSED

SHORT_STEP = timedelta(milliseconds=100)
STEADY_TICKS = 10
LONGEST_PREPARATION = timedelta(hours=1)


class RehearsalFailed(ValueError):
    """The simulated tracker did not get where it had to be; the text says what was waited for."""


class Rehearsal:
    """One simulated tracker whose sun stands still until it is homed and in place; it warns nobody.

    The machine's time starts at `begin` and always goes on; `site_time` moves only when told to. `weather` is
    none until it is given some.
    """

    def __init__(
        self, config: TrackerConfig, pointing: Pointing, location: Location, begin: datetime
    ) -> None:
        self.config = config
        self.location = location
        self.site_time = begin.astimezone(UTC)
        self.clock = VirtualClock(self.site_time)
        self._lit: SunPosition | None = None
        light = Sunlight(config, lambda: self._lit, pointing) if config.hybrid.enabled else None
        self.drive = SimulatedDrive(config, self.clock, watchdog=None, light=light)
        unwarned = replace(config, protection=replace(config.protection, warning_s=0.0))
        self.controller = Controller(unwarned, TrackerMemory(pointing=pointing), self.drive.capabilities)
        self._sky = Sky()
        self._told = DriveCommand()
        self.weather: MadeUpWeather | None = None

    @property
    def stands(self) -> bool:
        """Return whether the last tick halted both axes."""
        return isinstance(self._told.azimuth, Halt) and isinstance(self._told.elevation, Halt)

    def home(self) -> None:
        """Search the origin switches until the zero is trusted."""
        self.tick()
        self.ask(Home())
        self.prepare_until(lambda seen: seen.homed and self._rests(seen), N_("it was homed"))

    def ask(self, command: Command) -> tuple[Event, ...]:
        """Give the controller a command."""
        return self.controller.handle(command, self.clock.now(), "simulation")

    def prepare_until(self, ready: Callable[[Snapshot], bool], what: str) -> None:
        """Tick with the sun standing still until the tracker has been ready for a second."""
        give_up = self.clock.now() + LONGEST_PREPARATION
        steady = 0
        while self.clock.now() < give_up:
            self.clock.advance(SHORT_STEP)
            self.tick()
            steady = steady + 1 if ready(self.controller.snapshot(self.site_time)) else 0
            if steady >= STEADY_TICKS:
                return
        raise RehearsalFailed(
            say("The simulated tracker waited an hour until {what}; check its settings.", what=what)
        )

    def tick(self, sun: SunPosition | None = None) -> tuple[Event, ...]:
        """Read, decide and write once at the present instant; the sun may come worked out in advance."""
        location, algorithm = self.location, self.config.algorithm
        now, at = self.clock.now(), self.site_time
        self._lit = sun = sun or self._sky.sun(location, algorithm, at)
        dawn, reading = self._sky.dawn(location, algorithm, at), self.drive.observe()
        weather = NOTHING_SENSED if self.weather is None else self.weather.sensed(at, sun, now)
        seen = Observation(now, at, sun, dawn, reading, True, location, 1, weather)
        self._told, events = self.controller.tick(seen)
        self.drive.obey(self._told)
        return events

    def _rests(self, seen: Snapshot) -> bool:
        return seen.activity is ActivityName.HOLDING
