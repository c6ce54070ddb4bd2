"""The one place that knows which kinds of drives there are."""

from collections.abc import Callable
from datetime import timedelta
from pathlib import Path
from typing import assert_never

from app.base.clock import Clock
from app.drives.connections.adapters import drive_on
from app.drives.connections.buses import Buses
from app.drives.drive import Drive
from app.drives.linear_actuator import TransmittedDrive, has_actuators, in_millimetres
from app.drives.profile_library import ProfileLibrary
from app.drives.scaled import corrected
from app.modbus.bus import BusUnit
from app.simulation.kept_positions import KeptPositions
from app.simulation.simulated import SimulatedDrive
from app.simulation.simulated_machine import WATCHDOG
from app.simulation.sunlight import Sunlight
from app.sun.position import SunPosition
from app.tracker.settings.config import DriveKind, TrackerConfig

WATCHDOG_TICKS = 2.5


class DriveFactory:
    """Makes drives, and keeps the buses that they share; a process has one.

    Simulated drives keep their positions in `positions`, else in the data folder; without one they forget.
    If a tracker is corrected by light, its simulated drive has photo-sensors, and `sun` says where the sun
    stands over them. Its watchdog lets a tick of `tick` come late: a shorter one would stop every motion
    between two ticks.
    """

    def __init__(
        self,
        clock: Clock,
        data_dir: Path | None = None,
        *,
        positions: KeptPositions | None = None,
        sun: Callable[[], SunPosition | None] = lambda: None,
        tick: timedelta = timedelta(0),
    ) -> None:
        self.buses = Buses(clock)
        self.profiles = ProfileLibrary(data_dir / "profiles" if data_dir is not None else None)
        self._clock = clock
        if positions is None and data_dir is not None:
            positions = KeptPositions(data_dir / "drives")
        self._positions = positions
        self._sun = sun
        self._watchdog = max(WATCHDOG, WATCHDOG_TICKS * tick)

    def make(self, config: TrackerConfig) -> Drive:
        """Return the drive of a tracker, not yet connected, or raise `ProfileError` for a bad profile."""
        if has_actuators(config):
            return TransmittedDrive(self._counting(in_millimetres(config)), config)
        return self._counting(config)

    def _counting(self, config: TrackerConfig) -> Drive:
        """Return the drive as it counts: degrees of an axis, or millimetres of its actuator."""
        match config.drive.kind:
            case DriveKind.SIMULATED:
                return corrected(config, self._simulated)
            case DriveKind.MODBUS_TCP | DriveKind.MODBUS_RTU | DriveKind.MODBUS_RTU_OVER_TCP:
                return self._modbus(config)
            case _ as never:
                assert_never(never)

    def _simulated(self, config: TrackerConfig) -> Drive:
        light = Sunlight(config, self._sun) if config.hybrid.enabled else None
        memory = None if self._positions is None else self._positions.of(config.tracker_id)
        return SimulatedDrive(config, self._clock, memory=memory, light=light, watchdog=self._watchdog)

    def _modbus(self, config: TrackerConfig) -> Drive:
        profile = self.profiles.load(config.drive.profile)

        def unit_of(number: int) -> BusUnit:
            return self.buses.unit(config.drive, number, profile.timing)

        if profile.adapter.counts_degrees:
            return corrected(config, lambda own: drive_on(own, profile, unit_of, self._clock))
        return drive_on(config, profile, unit_of, self._clock)
