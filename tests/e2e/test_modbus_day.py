"""A whole tracked day on a drive behind Modbus TCP: a real socket on a virtual clock."""

from datetime import UTC, datetime, timedelta
from math import nan

import numpy as np

from app.site.weather.sky import Sky
from app.sun.position import Algorithm, Location
from app.tracker.commands.commands import Command, Home, SelectMode, Track
from app.tracker.controller import Controller
from app.tracker.memory.memory import TrackerMemory
from app.tracker.memory.observation import Observation
from app.tracker.memory.recording import Frames
from app.tracker.settings.config import TrackerConfig
from app.tracker.state.snapshot import ActivityName, Snapshot
from app.tracker.values.mode import Mode
from tests.amount import amount
from tests.drives.rigs import Rig, modbus_rig
from tests.e2e.sky import separation_deg, spa_deg

SAMSUN = Location(41.2867, 36.33, 4.0)
SUNRISE, SUNSET = (datetime(2026, 6, 21, *at, tzinfo=UTC) for at in ((2, 20), (17, 5)))
TRACKER = TrackerConfig("T1", "Tracker 1", refraction=False)
SHORT, LONG = timedelta(milliseconds=200), timedelta(seconds=amount(15, 5))
SPA_LIMIT_DEG = 0.01


class Day:
    """One controller on a drive behind a socket; the site's time begins at sunrise."""

    def __init__(self, rig: Rig) -> None:
        self._rig = rig
        self._sky = Sky()
        self._ahead = SUNRISE - rig.clock.now()
        self._controller = Controller(TRACKER, TrackerMemory(), rig.drive.capabilities)

    @property
    def site_time(self) -> datetime:
        return self._rig.clock.now() + self._ahead

    @property
    def snapshot(self) -> Snapshot:
        return self._controller.snapshot(self.site_time)

    def ask(self, command: Command) -> None:
        self._controller.handle(command, self._rig.clock.now(), "technician")

    async def tick(self, period: timedelta) -> tuple[float, ...]:
        self._rig.clock.advance(period)
        at = self.site_time
        seen = Observation(
            self._rig.clock.now(),
            at,
            self._sky.sun(SAMSUN, Algorithm.PSA, at),
            self._sky.dawn(SAMSUN, Algorithm.PSA, at),
            await self._rig.drive.read(),
            True,
            SAMSUN,
            1,
        )
        command, _ = self._controller.tick(seen)
        await self._rig.drive.write(command)
        return (nan, at.timestamp(), *self._controller.frame()[2:])

    async def until(self, activity: ActivityName, *, in_position: bool = False) -> None:
        for _ in range(5000):
            await self.tick(SHORT)
            seen = self.snapshot
            if seen.activity is activity and seen.homed and (seen.in_position or not in_position):
                return
        raise AssertionError(f"not {activity}: {self.snapshot}")


async def test_the_panel_keeps_to_the_sun_of_spa_from_rise_to_set() -> None:
    async with modbus_rig() as rig:
        day = Day(rig)
        await day.tick(SHORT)
        day.ask(Home())
        await day.until(ActivityName.HOLDING)
        day.ask(SelectMode(Mode.DUAL))
        day.ask(Track())
        await day.until(ActivityName.TRACKING, in_position=True)
        rows = []
        while day.site_time < SUNSET:
            rows.append(await day.tick(LONG))

    frames = Frames(np.array(rows))
    sun = frames.column("sun_azimuth_deg"), frames.column("sun_elevation_deg")
    panel = frames.column("measured_azimuth_deg"), frames.column("measured_elevation_deg")
    spa = spa_deg(frames.column("sun_time_s"), SAMSUN.latitude_deg, SAMSUN.longitude_deg, SAMSUN.altitude_m)
    assert len(rows) > (SUNSET - SUNRISE) / LONG * 0.9
    assert separation_deg(*sun, *spa).max() < SPA_LIMIT_DEG
    assert separation_deg(*panel, *spa).max() <= TRACKER.deadband_deg + SPA_LIMIT_DEG
