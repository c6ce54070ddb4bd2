"""What an engineer sets for one tracker."""

from dataclasses import dataclass, field
from enum import StrEnum

from app.sun.position import Algorithm
from app.tracker.axes import AZIMUTH_DEFAULT, ELEVATION_DEFAULT, Axis, AxisConfig


class NightBehaviour(StrEnum):
    """Where the panel waits while the sun is down."""

    HOLD = "hold"
    SUNRISE = "sunrise"
    PARK = "park"


class DriveKind(StrEnum):
    """How the drive is reached."""

    SIMULATED = "simulated"
    MODBUS_TCP = "modbus-tcp"


@dataclass(frozen=True, slots=True)
class DriveConfig:
    """Which drive moves the axes; host, port and unit count only for Modbus TCP."""

    kind: DriveKind = DriveKind.SIMULATED
    profile: str = "simulated-plc"
    host: str = "127.0.0.1"
    port: int = 5020
    unit: int = 1


@dataclass(frozen=True, slots=True)
class Orientation:
    """A direction of the panel's normal: azimuth from north clockwise, elevation above the horizon."""

    azimuth_deg: float
    elevation_deg: float


@dataclass(frozen=True, slots=True)
class TrackerConfig:
    """Everything that is set, not measured, about one tracker."""

    tracker_id: str
    name: str
    azimuth: AxisConfig = AZIMUTH_DEFAULT
    elevation: AxisConfig = ELEVATION_DEFAULT
    drive: DriveConfig = field(default_factory=DriveConfig)
    algorithm: Algorithm = Algorithm.PSA
    refraction: bool = True
    deadband_deg: float = 0.5
    in_position_deg: float = 0.05
    following_error_deg: float = 2.0
    night: NightBehaviour = NightBehaviour.SUNRISE
    park: Orientation = Orientation(180.0, 90.0)

    def axis(self, axis: Axis) -> AxisConfig:
        """Return the configuration of one axis."""
        return self.azimuth if axis is Axis.AZIMUTH else self.elevation
