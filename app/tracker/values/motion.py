"""What a drive is told and what it answers: plain data, the same for simulated and real drives.

Both axes are in degrees of the axis, zero where the operator set it (north, horizon). Azimuth grows
clockwise (towards east), elevation grows upwards. An axis angle does not wrap.
"""

from dataclasses import dataclass
from enum import StrEnum

LARGEST = 1e6
"""No angle, speed, light or voltage of a tracker is larger, in the units used here."""


@dataclass(frozen=True, slots=True)
class Halt:
    """Ramp down and stay."""


@dataclass(frozen=True, slots=True)
class Velocity:
    """Turn at a signed speed until told otherwise."""

    velocity_dps: float


@dataclass(frozen=True, slots=True)
class Position:
    """Go to an axis angle at no more than a speed."""

    position_deg: float
    speed_dps: float


AxisCommand = Halt | Velocity | Position
HALT = Halt()


class RequestKind(StrEnum):
    """Something a drive does once."""

    SET_HOME_AZIMUTH = "set_home_azimuth"
    SET_HOME_ELEVATION = "set_home_elevation"
    HOME = "home"
    RESET_FAULT = "reset_fault"


@dataclass(frozen=True, slots=True)
class DriveRequest:
    """A numbered one-time request; the drive answers with the number in `Feedback.request_done`."""

    number: int
    kind: RequestKind


@dataclass(frozen=True, slots=True)
class DriveCommand:
    """What both axes shall do from now on. Written every tick: writing it feeds the drive's watchdog.

    `horn` sounds the horn, where there is one, to warn of a motion ahead.
    """

    azimuth: AxisCommand = HALT
    elevation: AxisCommand = HALT
    request: DriveRequest | None = None
    horn: bool = False


@dataclass(frozen=True, slots=True)
class AxisFeedback:
    """What one axis measures and reports."""

    position_deg: float
    velocity_dps: float
    moving: bool
    homed: bool
    at_lower_limit: bool = False
    at_upper_limit: bool = False
    at_origin: bool = False


@dataclass(frozen=True, slots=True)
class LightPair:
    """The two photo-sensors of one axis, W/m2: each looks out from the panel towards one side of its normal.

    `higher` looks where the axis angle grows: west and up on a panel that faces south.
    """

    lower_wm2: float
    higher_wm2: float


@dataclass(frozen=True, slots=True)
class LightReading:
    """What the photo-sensor pairs of both axes read."""

    azimuth: LightPair
    elevation: LightPair


@dataclass(frozen=True, slots=True)
class Feedback:
    """One complete, consistent reading of a drive.

    `boot_count` changes when the drive has restarted; `fault_code` is zero without a fault;
    `request_done` is the number of the last request that the drive completed, and `request_failed`
    says that it could not do it. `light` is None where the drive has no photo-sensors, `supply_v` where it
    does not tell its voltage; `local` says that the switch at the cabinet is on local.
    """

    azimuth: AxisFeedback
    elevation: AxisFeedback
    boot_count: int
    fault_code: int = 0
    homing: bool = False
    watchdog_tripped: bool = False
    request_done: int = 0
    request_failed: bool = False
    light: LightReading | None = None
    local: bool = False
    supply_v: float | None = None

    @property
    def is_possible(self) -> bool:
        """Return whether every number is one that a machine can have, none infinite and none missing."""
        axes = (self.azimuth, self.elevation)
        numbers = [number for axis in axes for number in (axis.position_deg, axis.velocity_dps)]
        if self.light is not None:
            pairs = (self.light.azimuth, self.light.elevation)
            numbers += [number for pair in pairs for number in (pair.lower_wm2, pair.higher_wm2)]
        if self.supply_v is not None:
            numbers.append(self.supply_v)
        return all(abs(number) <= LARGEST for number in numbers)


@dataclass(frozen=True, slots=True)
class DriveCapabilities:
    """What this drive can do; nobody has to find out by trying.

    `watchdog_s` is the time after which the drive itself ramps down without a fresh command, None
    where it has no such watchdog, and `watchdog_action` says what it does then. `automatic_homing` needs
    origin switches. `unverified` names the registers that nobody has tried on such a device yet.
    """

    automatic_homing: bool
    watchdog_s: float | None
    settable_clock: bool
    limit_switches: bool
    description: str
    verified: bool
    watchdog_action: str = ""
    unverified: tuple[str, ...] = ()
