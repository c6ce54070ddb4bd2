"""A field of trackers under changing weather and with faults: it lives on, and every tick is looked at."""

import asyncio
import gc
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from random import Random

from app.base.clock import VirtualClock
from app.link.messages import Order, ReportWeather, SetClock, SetLocation, SiteCommand
from app.simulation.faults import Fault, FaultKind
from app.simulation.simulated import SimulatedDrive
from app.site.loop.loop import TrackerLoop
from app.site.publishing.health import resident_bytes
from app.site.recording.gathering import BackgroundWriter
from app.site.site import Site, SiteOptions
from app.tracker.commands.commands import (
    Command,
    CommandRejected,
    Home,
    ResetFault,
    SelectMode,
    Stop,
    Track,
)
from app.tracker.memory.memory import SiteState, TrackerMemory, TrackerState
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import TrackerConfig
from app.tracker.state.snapshot import ActivityName
from app.tracker.values.mode import Mode
from app.tracker.weather.weather import Weather
from tests.site.plant import SAMSUN, settle
from tests.tracker.witness import AUTOMATIC, LIVE

PERIOD = timedelta(seconds=2)
WATCHDOG = timedelta(seconds=6)
TICKS_A_MINUTE = 30
FAULTS = (
    FaultKind.STALL,
    FaultKind.WRONG_DIRECTION,
    FaultKind.ENCODER_JUMP,
    FaultKind.POWER_LOSS,
    FaultKind.DRIVE_FAULT,
    FaultKind.SILENCE,
    FaultKind.FROZEN_POSITION,
)
A_FAULT_EVERY_MIN = 15
MENDED_AFTER_MIN = 4
PAGE_BYTES = 4096
LONGEST_SEARCH_TICKS = 90
STORM = range(3, 5)
A_LOOK_AT_MEMORY_EVERY_MIN = 10


@dataclass
class Seen:
    """What was seen so far: activities, faults that were suffered, stows, and the memory in use, bytes."""

    activities: set[ActivityName] = field(default_factory=set)
    faults: int = 0
    memory_bytes: list[int] = field(default_factory=list)


class Field:
    """Trackers of one site on a virtual clock, whose weather and faults come from one seed."""

    def __init__(
        self, trackers: int, begin: datetime, seed: int, writer: BackgroundWriter | None = None
    ) -> None:
        self.clock = VirtualClock(begin)
        self.drives: dict[str, SimulatedDrive] = {}
        self.chance = Random(seed)
        self.seen = Seen()
        self._wind_mps, self._broken = 6.0, dict[str, int]()
        states = tuple(
            TrackerState(TrackerConfig(f"T{number}", f"Tracker {number}"), TrackerMemory())
            for number in range(1, trackers + 1)
        )
        options = SiteOptions(period=PERIOD)
        self.site = Site(self.clock, self._make_drive, SiteState(), states, writer=writer, options=options)

    async def live(self, minutes: int) -> None:
        """Commission every tracker, let time pass, look at every tick."""
        await self.site.start()
        await self.ask(SetLocation(SAMSUN, "Europe/Istanbul"))
        await self.ask(SetClock("system"))
        for name in self.drives:
            await self._get_going(name)
        for minute in range(minutes):
            await self._change_weather(storm=minute in STORM)
            for name in self.drives:
                await self._suffer(name)
            for _ in range(TICKS_A_MINUTE):
                await self._tick()
            if (minute + 1) % A_LOOK_AT_MEMORY_EVERY_MIN == 0:
                self.seen.memory_bytes.append(held_bytes())
        await self.site.close()

    async def ask(self, command: Command | SiteCommand, tracker_id: str | None = None) -> bool:
        """Give an order and return whether it was taken."""
        asking = asyncio.create_task(self.site.execute(Order(command, "technician", tracker_id)))
        while not asking.done():
            await settle()
        try:
            await asking
        except CommandRejected:
            return False
        return True

    def _make_drive(self, config: TrackerConfig) -> SimulatedDrive:
        self.drives[config.tracker_id] = SimulatedDrive(config, self.clock, watchdog=WATCHDOG)
        return self.drives[config.tracker_id]

    async def _get_going(self, name: str) -> None:
        for command in (Stop(), ResetFault(), Home()):
            await self.ask(command, name)
            await self._tick()
        loop, waited = self.site.model.tracker(name), 0
        while loop.controller.activity is ActivityName.HOMING and waited < LONGEST_SEARCH_TICKS:
            await self._tick()
            waited += 1
        for command in (SelectMode(Mode.DUAL), Track()):
            await self.ask(command, name)
            await self._tick()

    async def _change_weather(self, *, storm: bool) -> None:
        """Let the wind wander, storms come and go, and a sensor be silent for a while."""
        self._wind_mps = min(28.0, max(0.0, self._wind_mps + self.chance.gauss(0.0, 1.5)))
        if self.chance.random() < 1 / 60:
            self._wind_mps = self.chance.choice((2.0, 22.0))
        if storm:
            self._wind_mps = 22.0
        if storm or self.chance.random() < 0.9:
            irradiance_wm2 = self.chance.choice((20.0, 400.0, 900.0))
            snow_kg = 5.0 if self.chance.random() < 0.02 else 0.0
            await self.ask(
                ReportWeather(Weather(self._wind_mps, irradiance_wm2=irradiance_wm2, snow_kg=snow_kg))
            )

    async def _suffer(self, name: str) -> None:
        """Break a drive now and then; after a while somebody mends it and gets the tracker going."""
        left = self._broken.get(name)
        if left is None:
            if self.chance.random() < 1 / A_FAULT_EVERY_MIN:
                kind, axis = self.chance.choice(FAULTS), self.chance.choice(tuple(Axis))
                self.drives[name].inject(Fault(kind, axis, 9.0))
                self._broken[name] = MENDED_AFTER_MIN
                self.seen.faults += 1
        elif left > 0:
            self._broken[name] = left - 1
        else:
            del self._broken[name]
            self.drives[name].end_injected_faults()
            await self._get_going(name)

    async def _tick(self) -> None:
        end = self.clock.now() + PERIOD
        while self.clock.now() < end:
            self.clock.move_to(min(end, self.clock.next_wake or end))
            await settle()
        for loop in self.site.model.loops.values():
            self._look(loop)

    def _look(self, loop: TrackerLoop) -> None:
        activity = loop.controller.activity
        self.seen.activities.add(activity)
        assert loop.broken is None, loop.broken
        assert self.site.alive
        if loop.moving and activity in AUTOMATIC:
            assert loop.memory.home is not None
            assert loop.memory.fault_code is None
        if loop.controller._state.setpoints.axes.azimuth_deg is not None and loop.moving:
            assert activity in LIVE | {ActivityName.HOLDING, ActivityName.STOPPING, ActivityName.STOWED}


def held_bytes() -> int:
    """Return the memory that this process has in use once what is not needed is gone."""
    gc.collect()
    return resident_bytes() or 0
