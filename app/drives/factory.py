"""The one place that knows which kinds of drives there are."""

from pathlib import Path
from typing import assert_never
from urllib.parse import quote

from app.clock import Clock
from app.drives.drive import Drive, DriveError
from app.drives.plc import PlcDrive
from app.drives.profile import Adapter, load_profile
from app.drives.simulated import SimulatedDrive
from app.tracker.config import DriveKind, TrackerConfig


def make_drive(config: TrackerConfig, clock: Clock, data_dir: Path | None) -> Drive:
    """Return the drive of a tracker, not yet connected, or raise `ProfileError` for a bad profile.

    A simulated drive keeps its position memory in the data folder; without one it forgets.
    """
    match config.drive.kind:
        case DriveKind.SIMULATED:
            memory = (
                data_dir / "drives" / f"{quote(config.tracker_id, safe='')}.json"
                if data_dir is not None
                else None
            )
            return SimulatedDrive(config, clock, memory=memory)
        case DriveKind.MODBUS_TCP:
            return _modbus(config, clock)
        case DriveKind.MODBUS_RTU | DriveKind.MODBUS_RTU_OVER_TCP:
            raise DriveError(f"A drive on {config.drive.kind} cannot be reached by this version.")
        case _ as never:
            assert_never(never)


def _modbus(config: TrackerConfig, clock: Clock) -> Drive:
    profile = load_profile(config.drive.profile)
    match profile.adapter:
        case Adapter.PLC:
            return PlcDrive(config, profile, clock)
