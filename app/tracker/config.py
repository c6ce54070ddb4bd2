"""What an engineer sets for one tracker."""

from dataclasses import dataclass, field
from enum import StrEnum
from typing import assert_never

from app.sun.position import Algorithm
from app.tracker.axes import AZIMUTH_DEFAULT, ELEVATION_DEFAULT, Axis, AxisConfig
from app.tracker.orientation import Orientation as Orientation
from app.tracker.protections.config import PROTECTED, ProtectionConfig
from app.tracker.protections.machine_config import GUARDED, MachineProtection
from app.tracker.strategy import DEADBAND, NO_HYBRID, HybridConfig, Strategy

LEVEL = Orientation(180.0, 90.0)


class NightBehaviour(StrEnum):
    """Where the panel waits while the sun is down."""

    HOLD = "hold"
    SUNRISE = "sunrise"
    PARK = "park"


class DriveKind(StrEnum):
    """How the drive is reached."""

    SIMULATED = "simulated"
    MODBUS_TCP = "modbus-tcp"
    MODBUS_RTU = "modbus-rtu"
    MODBUS_RTU_OVER_TCP = "modbus-rtu-over-tcp"


class Parity(StrEnum):
    """The check bit of a character on a serial line."""

    NONE = "none"
    EVEN = "even"
    ODD = "odd"


@dataclass(frozen=True, slots=True)
class SerialConfig:
    """A serial line: its device, best by a name that stays (`/dev/serial/by-id/...`), and its characters."""

    port: str = ""
    baud_rate: int = 19200
    parity: Parity = Parity.EVEN
    stop_bits: int = 1

    def __post_init__(self) -> None:
        if not 300 <= self.baud_rate <= 4_000_000:
            raise ValueError("The baud rate must lie between 300 and 4000000.")
        if self.stop_bits not in (1, 2):
            raise ValueError("A character ends with 1 or 2 stop bits.")

    @property
    def bits(self) -> int:
        """Return how many bits one character of eight data bits takes."""
        return 9 + (self.parity is not Parity.NONE) + self.stop_bits


@dataclass(frozen=True, slots=True)
class AxisDrive:
    """How one axis hangs on its drive.

    `unit` None means the drive's unit, `steps_per_revolution` None the profile's; `gear_ratio` is motor
    revolutions for one revolution of the axis; `inverted` turns the direction round.
    """

    unit: int | None = None
    steps_per_revolution: float | None = None
    gear_ratio: float = 1.0
    inverted: bool = False

    def __post_init__(self) -> None:
        if not 0.0 < self.gear_ratio < 1e6:
            raise ValueError("The gear ratio must be above zero and below a million.")
        if self.steps_per_revolution is not None and not 0.0 < self.steps_per_revolution < 1e9:
            raise ValueError("The steps per revolution must be above zero and below 1e9.")


@dataclass(frozen=True, slots=True)
class DriveConfig:
    """Which drive moves the axes. Host and port count for Modbus TCP and RTU over TCP, serial for RTU."""

    kind: DriveKind = DriveKind.SIMULATED
    profile: str = "simulated-plc"
    host: str = "127.0.0.1"
    port: int = 5020
    unit: int = 1
    serial: SerialConfig = field(default_factory=SerialConfig)
    azimuth: AxisDrive = field(default_factory=AxisDrive)
    elevation: AxisDrive = field(default_factory=AxisDrive)

    def axis(self, axis: Axis) -> AxisDrive:
        """Return how one axis hangs on its drive."""
        return self.azimuth if axis is Axis.AZIMUTH else self.elevation

    @property
    def units(self) -> tuple[int, ...]:
        """Return the unit ids in use, azimuth's first; one if both axes share it."""
        return tuple(
            dict.fromkeys(
                self.unit if one.unit is None else one.unit for one in (self.azimuth, self.elevation)
            )
        )

    @property
    def line(self) -> str:
        """Return the name of the connection that drives share: the same text is the same line."""
        match self.kind:
            case DriveKind.SIMULATED:
                return ""
            case DriveKind.MODBUS_TCP | DriveKind.MODBUS_RTU_OVER_TCP:
                return f"{self.host}:{self.port}"
            case DriveKind.MODBUS_RTU:
                return self.serial.port
            case _ as never:
                assert_never(never)


class MountKind(StrEnum):
    """How the panel hangs on its axes."""

    AZIMUTH_ELEVATION = "azimuth-elevation"
    EQUATORIAL = "equatorial"
    HORIZONTAL_SINGLE_AXIS = "horizontal-single-axis"
    TILTED_SINGLE_AXIS = "tilted-single-axis"
    VERTICAL_SINGLE_AXIS = "vertical-single-axis"


@dataclass(frozen=True, slots=True)
class Rows:
    """Rows of single-axis trackers that would shade each other: with them the mount backtracks.

    `ground_coverage_ratio` is the width of a row's panel over the distance between two row axes;
    `cross_axis_tilt_deg` is the slope of the plane through the row axes, perpendicular to them, with the
    signs of pvlib's `tracking.singleaxis`.
    """

    ground_coverage_ratio: float
    cross_axis_tilt_deg: float = 0.0

    def __post_init__(self) -> None:
        if not 0.0 < self.ground_coverage_ratio <= 1.0:
            raise ValueError("The ground coverage ratio must be above 0 and at most 1.")
        if not -60.0 <= self.cross_axis_tilt_deg <= 60.0:
            raise ValueError("The slope across the rows must lie between -60 and 60 degrees.")


@dataclass(frozen=True, slots=True)
class MountConfig:
    """The first axis in the landscape, as pvlib has it.

    The axis lies along `axis_azimuth_deg` and dips by `axis_tilt_deg` in that direction, so that a panel at
    rotation zero faces it. An equatorial mount's axis dips by the latitude, to the south on the northern
    half of the globe and to the north on the southern. `panel_tilt_deg` is the fixed tilt from horizontal of
    a panel on a vertical axis. With `least_incidence`, elevation tracking turns to the smallest angle of
    incidence and not to the sun's elevation. What does not belong to the kind is not looked at.
    """

    kind: MountKind = MountKind.AZIMUTH_ELEVATION
    axis_azimuth_deg: float = 180.0
    axis_tilt_deg: float = 0.0
    panel_tilt_deg: float = 45.0
    rows: Rows | None = None
    least_incidence: bool = False

    def __post_init__(self) -> None:
        if not 0.0 <= self.axis_azimuth_deg < 360.0:
            raise ValueError("The azimuth of the axis must be at least 0 and below 360 degrees.")
        if not 0.0 <= self.axis_tilt_deg <= 90.0:
            raise ValueError("The tilt of the axis must lie between 0 and 90 degrees.")
        if not 0.0 <= self.panel_tilt_deg <= 90.0:
            raise ValueError("The tilt of the panel must lie between 0 and 90 degrees.")
        if self.rows is not None and self.kind not in ROW_KINDS:
            raise ValueError(
                "Only a horizontal or tilted single axis backtracks between rows: remove the rows, or choose "
                "another mount."
            )

    @property
    def single_axis(self) -> bool:
        """Return whether the mount has a first axis only."""
        return self.kind in SINGLE_AXIS_KINDS

    @property
    def axes(self) -> tuple[Axis, ...]:
        """Return the axes that the mount has; the names stand for first and second axis."""
        return (Axis.AZIMUTH,) if self.single_axis else (Axis.AZIMUTH, Axis.ELEVATION)


ROW_KINDS = frozenset({MountKind.HORIZONTAL_SINGLE_AXIS, MountKind.TILTED_SINGLE_AXIS})
SINGLE_AXIS_KINDS = ROW_KINDS | {MountKind.VERTICAL_SINGLE_AXIS}


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
    park: Orientation = LEVEL
    strategy: Strategy = DEADBAND
    hybrid: HybridConfig = NO_HYBRID
    mount: MountConfig = MountConfig()
    protection: ProtectionConfig = PROTECTED
    machine: MachineProtection = GUARDED

    @property
    def turning_deg(self) -> tuple[tuple[float, float], tuple[float, float] | None]:
        """Return the soft limits of first and second axis; None for a second axis that is not there."""
        first, second = self.azimuth, self.elevation
        ends = (second.minimum_deg, second.maximum_deg)
        return (first.minimum_deg, first.maximum_deg), None if self.mount.single_axis else ends

    def axis(self, axis: Axis) -> AxisConfig:
        """Return the configuration of one axis."""
        return self.azimuth if axis is Axis.AZIMUTH else self.elevation
