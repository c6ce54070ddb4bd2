"""The one place that knows which kinds of drives there are."""

from collections.abc import Callable
from pathlib import Path
from typing import assert_never
from urllib.parse import quote

from app.clock import Clock
from app.drives.adapters import drive_on
from app.drives.bus import BusUnit
from app.drives.buses import Buses
from app.drives.corrected import corrected
from app.drives.drive import Drive
from app.drives.profile_library import ProfileLibrary
from app.drives.simulated import SimulatedDrive
from app.drives.sunlight import Sunlight
from app.drives.transmitted import TransmittedDrive, has_actuators, in_millimetres
from app.sun.position import SunPosition
from app.tracker.config import DriveKind, TrackerConfig


class DriveFactory:
    """Makes drives, and keeps the buses that they share; a process has one.

    A simulated drive keeps its position memory in the data folder; without one it forgets. If its tracker is
    corrected by light, it has photo-sensors, and `sun` says where the sun stands over them.
    """

    def __init__(
        self,
        clock: Clock,
        data_dir: Path | None = None,
        *,
        sun: Callable[[], SunPosition | None] = lambda: None,
    ) -> None:
        self.buses = Buses(clock)
        self.profiles = ProfileLibrary(data_dir / "profiles" if data_dir is not None else None)
        self._clock = clock
        self._data_dir = data_dir
        self._sun = sun

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
        return SimulatedDrive(config, self._clock, memory=self._memory(config.tracker_id), light=light)

    def _memory(self, tracker_id: str) -> Path | None:
        if self._data_dir is None:
            return None
        return self._data_dir / "drives" / f"{quote(tracker_id, safe='')}.json"

    def _modbus(self, config: TrackerConfig) -> Drive:
        profile = self.profiles.load(config.drive.profile)

        def unit_of(number: int) -> BusUnit:
            return self.buses.unit(config.drive, number, profile.timing)

        if profile.adapter.counts_degrees:
            return corrected(config, lambda own: drive_on(own, profile, unit_of, self._clock))
        return drive_on(config, profile, unit_of, self._clock)
