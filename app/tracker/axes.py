"""The two axes of a mount and what each can do; the names stand for the first and the second axis."""

from dataclasses import dataclass
from enum import StrEnum

from app.tracker.transmission import LinearActuator

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

    minimum_deg: float
    maximum_deg: float
    speed_dps: float
    acceleration_dps2: float
    jog_slow_dps: float
    jog_fast_dps: float
    actuator: LinearActuator | None = None

    def __post_init__(self) -> None:
        if not self.minimum_deg < self.maximum_deg:
            raise ValueError("The lower soft limit must lie below the upper one.")
        if min(self.speed_dps, self.acceleration_dps2, self.jog_slow_dps, self.jog_fast_dps) <= 0.0:
            raise ValueError("Speeds and acceleration must be above zero.")
        if max(self.jog_slow_dps, self.jog_fast_dps) > self.speed_dps:
            raise ValueError("A jog speed must not exceed the axis's rated speed.")
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
                f"The actuator's stroke turns the axis from {low_deg:.2f} to {high_deg:.2f} degrees; the "
                "soft limits must lie within that."
            )
        if not low_deg <= 0.0 <= high_deg:
            raise ValueError(
                f"The actuator's stroke turns the axis from {low_deg:.2f} to {high_deg:.2f} "
                "degrees; this range must include 0, the home position."
            )
        slowest_dps = actuator.slowest_dps(self.minimum_deg, self.maximum_deg)
        if self.speed_dps > slowest_dps + ROUNDING_DEG:
            raise ValueError(
                f"At {actuator.speed_mm_s:g} mm/s, the slowest axis speed is {slowest_dps:.3f} "
                "degrees a second; the rated speed must not exceed that."
            )


AZIMUTH_DEFAULT = AxisConfig(0.0, 360.0, 6.0, 6.0, 0.5, 3.0)
ELEVATION_DEFAULT = AxisConfig(0.0, 90.0, 4.0, 6.0, 0.5, 2.0)
