"""The two axes of a mount and what each can do; the names stand for the first and the second axis."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated

from annotated_types import Ge, Le

from app.base.message import N_, say, with_format
from app.tracker.settings.declared import More, Setting, check
from app.tracker.settings.transmission import LinearActuator

ROUNDING_DEG = 1e-6


class Axis(StrEnum):
    """One of the two axes."""

    AZIMUTH = "azimuth"
    ELEVATION = "elevation"


class JogSpeed(StrEnum):
    """The operator's two speeds of hand motion."""

    SLOW = "slow"
    FAST = "fast"


@dataclass(frozen=True, slots=True)
class AxisConfig:
    """Soft limits, speeds and acceleration of one axis, in axis degrees (not wrapped).

    With an `actuator` the drive counts millimetres of its stroke; without one, degrees.
    """

    minimum_deg: Annotated[
        float,
        Ge(-720),
        Le(720),
        Setting(N_("Lower soft limit"), "°", help=N_("No motion goes below it."), more=More.LESS_ROOM),
    ]
    maximum_deg: Annotated[
        float,
        Ge(-720),
        Le(720),
        Setting(N_("Upper soft limit"), "°", help=N_("No motion goes above it."), more=More.ROOM),
    ]
    speed_dps: Annotated[
        float,
        Ge(0.001),
        Le(1000),
        Setting(
            N_("Rated speed"), "°/s", help=N_("Highest speed that the drive can sustain."), more=More.SPEED
        ),
    ]
    acceleration_dps2: Annotated[
        float,
        Ge(0.001),
        Le(1000),
        Setting(N_("Acceleration"), "°/s²", help=N_("How quickly speed changes."), more=More.SPEED),
    ]
    jog_slow_dps: Annotated[
        float,
        Ge(0.001),
        Le(1000),
        Setting(N_("Slow jog speed"), "°/s", help=N_("For the last degrees, with the hold-to-run buttons.")),
    ]
    jog_fast_dps: Annotated[
        float, Ge(0.001), Le(1000), Setting(N_("Fast jog speed"), "°/s", help=N_("At most the rated speed."))
    ]
    actuator: Annotated[LinearActuator, Setting(N_("Linear actuator"))] | None = None

    def __post_init__(self) -> None:
        check(self)
        if not self.minimum_deg < self.maximum_deg:
            raise ValueError(N_("The lower soft limit must lie below the upper one."))
        if max(self.jog_slow_dps, self.jog_fast_dps) > self.speed_dps:
            raise ValueError(N_("A jog speed must not exceed the axis's rated speed."))
        if self.actuator is not None:
            self._check_actuator(self.actuator)

    def contains(self, angle_deg: float) -> bool:
        """Return whether an axis angle lies within the soft limits."""
        return self.minimum_deg <= angle_deg <= self.maximum_deg

    def clamp(self, angle_deg: float) -> float:
        """Return the nearest angle within the soft limits."""
        if self.minimum_deg <= angle_deg <= self.maximum_deg:
            return angle_deg
        return min(self.maximum_deg, max(self.minimum_deg, angle_deg))

    def beyond_deg(self, angle_deg: float) -> float:
        """Return how far an axis angle lies outside the soft limits, 0 inside."""
        return abs(angle_deg - self.clamp(angle_deg))

    def _check_actuator(self, actuator: LinearActuator) -> None:
        """Raise `ValueError` where the actuator cannot turn the axis so far or so fast."""
        low_deg, high_deg = actuator.range_deg
        if self.minimum_deg < low_deg - ROUNDING_DEG or self.maximum_deg > high_deg + ROUNDING_DEG:
            raise ValueError(
                say(
                    "The actuator's stroke turns the axis from {low_deg} to {high_deg} degrees; the soft "
                    "limits must lie within that.",
                    low_deg=with_format(low_deg, ".2f"),
                    high_deg=with_format(high_deg, ".2f"),
                )
            )
        if not low_deg <= 0.0 <= high_deg:
            raise ValueError(
                say(
                    "The actuator's stroke turns the axis from {low_deg} to {high_deg} degrees; this "
                    "range must include 0, the home position.",
                    low_deg=with_format(low_deg, ".2f"),
                    high_deg=with_format(high_deg, ".2f"),
                )
            )
        slowest_dps = actuator.slowest_dps(self.minimum_deg, self.maximum_deg)
        if self.speed_dps > slowest_dps + ROUNDING_DEG:
            raise ValueError(
                say(
                    "At {speed_mm_s} mm/s, the slowest axis speed is {slowest_dps} degrees a second; the "
                    "rated speed must not exceed that.",
                    speed_mm_s=with_format(actuator.speed_mm_s, "g"),
                    slowest_dps=with_format(slowest_dps, ".3f"),
                )
            )


AZIMUTH_DEFAULT = AxisConfig(0.0, 360.0, 6.0, 6.0, 0.5, 3.0)
ELEVATION_DEFAULT = AxisConfig(0.0, 90.0, 4.0, 6.0, 0.5, 2.0)
