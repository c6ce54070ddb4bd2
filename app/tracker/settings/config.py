"""What an engineer sets for one tracker."""

from dataclasses import dataclass, field
from enum import StrEnum
from typing import Annotated, assert_never

from annotated_types import Ge, Le, Lt, MaxLen, MinLen

from app.base.message import N_
from app.sun.position import Algorithm
from app.tracker.settings.axes import AZIMUTH_DEFAULT, ELEVATION_DEFAULT, Axis, AxisConfig
from app.tracker.settings.declared import Parts, Setting, check
from app.tracker.settings.mechanics import GUARDED, MachineProtection
from app.tracker.settings.protections import PROTECTED, ProtectionConfig
from app.tracker.settings.strategy import (
    DEADBAND,
    LEAST_DEADBAND_DEG,
    MOST_DEADBAND_DEG,
    NO_HYBRID,
    HybridConfig,
    Strategy,
)
from app.tracker.values.orientation import Orientation as Orientation

LEVEL = Orientation(180.0, 90.0)
LONGEST_NAME = 60


class NightBehaviour(StrEnum):
    """Where the panel waits while the sun is down."""

    HOLD = "hold"
    SUNRISE = "sunrise"
    PARK = "park"


NIGHTS = (
    (NightBehaviour.SUNRISE.value, N_("Hold at sunrise position")),
    (NightBehaviour.HOLD.value, N_("Hold position")),
    (NightBehaviour.PARK.value, N_("Move to park")),
)


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

    port: Annotated[str, MaxLen(255), Setting(N_("Serial port"))] = ""
    baud_rate: Annotated[int, Ge(300), Le(4_000_000), Setting(N_("Baud rate"))] = 19200
    parity: Annotated[Parity, Setting(N_("Parity"))] = Parity.EVEN
    stop_bits: Annotated[int, Ge(1), Le(2), Setting(N_("Stop bits"))] = 1

    def __post_init__(self) -> None:
        check(self)

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

    unit: Annotated[int, Ge(0), Le(255), Setting(N_("Unit"), help=N_("Empty: the drive's."))] | None = None
    steps_per_revolution: (
        Annotated[
            float,
            Ge(0.001),
            Le(999_999_999),
            Setting(N_("Steps per motor turn"), help=N_("Empty: the profile's.")),
        ]
        | None
    ) = None
    gear_ratio: Annotated[
        float,
        Ge(0.0001),
        Le(999_999),
        Setting(N_("Gear ratio"), help=N_("Turns of the motor for one turn of the axis.")),
    ] = 1.0
    inverted: Annotated[bool, Setting(N_("Invert direction"))] = False

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True, slots=True)
class DriveConfig:
    """Which drive moves the axes. Host and port count for Modbus TCP and RTU over TCP, serial for RTU."""

    kind: Annotated[DriveKind, Setting(N_("Connection"))] = DriveKind.SIMULATED
    profile: Annotated[str, MinLen(1), MaxLen(64), Setting(N_("Profile"))] = "simulated-plc"
    host: Annotated[str, MinLen(1), MaxLen(253), Setting(N_("Host"))] = "127.0.0.1"
    port: Annotated[int, Ge(1), Le(65535), Setting(N_("Port"))] = 5020
    unit: Annotated[int, Ge(0), Le(255), Setting(N_("Unit"))] = 1
    serial: Annotated[SerialConfig, Setting(N_("Serial port"))] = field(default_factory=SerialConfig)
    azimuth: Annotated[AxisDrive, Setting(N_("Azimuth axis"))] = field(default_factory=AxisDrive)
    elevation: Annotated[AxisDrive, Setting(N_("Elevation axis"))] = field(default_factory=AxisDrive)

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

    ground_coverage_ratio: Annotated[
        float,
        Ge(0.01),
        Le(1),
        Setting(
            N_("Ground coverage ratio"), help=N_("Panel width divided by the distance between row axes.")
        ),
    ]
    cross_axis_tilt_deg: Annotated[float, Ge(-60), Le(60), Setting(N_("Slope across the rows"), "°")] = 0.0

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True, slots=True)
class MountConfig:
    """The first axis in the landscape, as pvlib has it.

    The axis lies along `axis_azimuth_deg` and dips by `axis_tilt_deg` in that direction, so that a panel at
    rotation zero faces it. An equatorial mount's axis dips by the latitude, to the south on the northern
    half of the globe and to the north on the southern. `panel_tilt_deg` is the fixed tilt from horizontal of
    a panel on a vertical axis. With `least_incidence`, elevation tracking turns to the smallest angle of
    incidence and not to the sun's elevation. What does not belong to the kind is not looked at.
    """

    kind: Annotated[MountKind, Setting(N_("Mount"))] = MountKind.AZIMUTH_ELEVATION
    axis_azimuth_deg: Annotated[float, Ge(0), Lt(360), Setting(N_("Azimuth of the axis"), "°")] = 180.0
    axis_tilt_deg: Annotated[float, Ge(0), Le(90), Setting(N_("Tilt of the axis"), "°")] = 0.0
    panel_tilt_deg: Annotated[float, Ge(0), Le(90), Setting(N_("Tilt of the panel"), "°")] = 45.0
    rows: Annotated[Rows, Setting(N_("Rows"))] | None = None
    least_incidence: Annotated[bool, Setting(N_("Least angle of incidence"))] = False

    def __post_init__(self) -> None:
        check(self)
        if self.rows is not None and self.kind not in ROW_KINDS:
            raise ValueError(
                N_(
                    "Only a horizontal or tilted single axis backtracks between rows: remove the "
                    "rows, or choose "
                    "another mount."
                )
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


TrackerName = Annotated[
    str,
    MinLen(1),
    MaxLen(LONGEST_NAME),
    Setting(N_("Name"), help=N_("Shown in the header, in lists, and in records.")),
]


@dataclass(frozen=True, slots=True)
class TrackerConfig:
    """Everything that is set, not measured, about one tracker."""

    tracker_id: str
    name: TrackerName
    azimuth: Annotated[AxisConfig, Setting(N_("Azimuth axis"))] = AZIMUTH_DEFAULT
    elevation: Annotated[AxisConfig, Setting(N_("Elevation axis"))] = ELEVATION_DEFAULT
    drive: Annotated[DriveConfig, Setting(N_("Drive"))] = field(default_factory=DriveConfig)
    algorithm: Annotated[
        Algorithm,
        Setting(
            N_("Sun algorithm"),
            help=N_("Error: greatest angle from NREL SPA with the sun up, 2000 to 2049. Usual: PSA."),
        ),
    ] = Algorithm.PSA
    refraction: Annotated[bool, Setting(N_("Follow the apparent sun, with refraction"))] = True
    deadband_deg: Annotated[
        float,
        Ge(LEAST_DEADBAND_DEG),
        Le(MOST_DEADBAND_DEG),
        Setting(N_("Deadband"), "°", help=N_("The panel moves when the pointing error exceeds this.")),
    ] = 0.5
    in_position_deg: Annotated[
        float,
        Ge(0.01),
        Le(5),
        Setting(
            N_("In-position tolerance"),
            "°",
            help=N_("A move is complete within this distance of its target."),
        ),
    ] = 0.05
    following_error_deg: Annotated[
        float,
        Ge(0.1),
        Le(20),
        Setting(N_("Following error"), "°", help=N_("An axis with a larger error is stopped with a fault.")),
    ] = 2.0
    night: Annotated[
        NightBehaviour,
        Setting(
            N_("At night"),
            help=N_("Position while the sun is down. Usual: hold at sunrise position."),
            choices=NIGHTS,
        ),
    ] = NightBehaviour.SUNRISE
    park: Annotated[
        Orientation,
        Setting(N_("Park")),
        Parts(
            azimuth_deg=Annotated[
                float, Ge(0), Le(360), Setting(N_("Park azimuth"), "°", help=N_("Clockwise from true north."))
            ],
            elevation_deg=Annotated[
                float,
                Ge(-90),
                Le(90),
                Setting(N_("Park elevation"), "°", help=N_("90 is a level panel, 0 an upright one.")),
            ],
        ),
    ] = LEVEL
    strategy: Annotated[
        Strategy,
        Setting(
            N_("Strategy"), help=N_("When the panel moves, and the pointing error allowed between moves.")
        ),
    ] = DEADBAND
    hybrid: Annotated[HybridConfig, Setting(N_("Correction by light sensors"))] = NO_HYBRID
    mount: Annotated[MountConfig, Setting(N_("Mount"))] = MountConfig()
    protection: Annotated[ProtectionConfig, Setting(N_("Protections"))] = PROTECTED
    machine: Annotated[MachineProtection, Setting(N_("Mechanics"))] = GUARDED

    @property
    def turning_deg(self) -> tuple[tuple[float, float], tuple[float, float] | None]:
        """Return the soft limits of first and second axis; None for a second axis that is not there."""
        first, second = self.azimuth, self.elevation
        ends = (second.minimum_deg, second.maximum_deg)
        return (first.minimum_deg, first.maximum_deg), None if self.mount.single_axis else ends

    def axis(self, axis: Axis) -> AxisConfig:
        """Return the configuration of one axis."""
        return self.azimuth if axis is Axis.AZIMUTH else self.elevation
