"""The two axes of an azimuth-elevation mount and what each can do."""

from dataclasses import dataclass
from enum import StrEnum


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
    """Soft limits, speeds and acceleration of one axis, in axis degrees (not wrapped)."""

    minimum_deg: float
    maximum_deg: float
    speed_dps: float
    acceleration_dps2: float
    jog_slow_dps: float
    jog_fast_dps: float

    def __post_init__(self) -> None:
        if not self.minimum_deg < self.maximum_deg:
            raise ValueError("The lower soft limit must lie below the upper one.")
        if self.maximum_deg - self.minimum_deg > 720.0:
            raise ValueError("An axis range above 720 degrees is not plausible; check the soft limits.")
        if min(self.speed_dps, self.acceleration_dps2, self.jog_slow_dps, self.jog_fast_dps) <= 0.0:
            raise ValueError("Speeds and acceleration must be above zero.")
        if max(self.jog_slow_dps, self.jog_fast_dps) > self.speed_dps:
            raise ValueError("A jog speed must not exceed the axis's rated speed.")

    def contains(self, angle_deg: float) -> bool:
        """Return whether an axis angle lies within the soft limits."""
        return self.minimum_deg <= angle_deg <= self.maximum_deg

    def clamp(self, angle_deg: float) -> float:
        """Return the nearest angle within the soft limits."""
        return min(self.maximum_deg, max(self.minimum_deg, angle_deg))

    def beyond_deg(self, angle_deg: float) -> float:
        """Return how far an axis angle lies outside the soft limits, 0 inside."""
        return abs(angle_deg - self.clamp(angle_deg))


AZIMUTH_DEFAULT = AxisConfig(0.0, 360.0, 6.0, 6.0, 0.5, 3.0)
ELEVATION_DEFAULT = AxisConfig(0.0, 90.0, 4.0, 6.0, 0.5, 2.0)
