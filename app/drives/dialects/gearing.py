"""Degrees of an axis as the steps and speeds of the motor behind its gear."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from app.drives.profile import Profile
from app.tracker.settings.config import AxisDrive


@dataclass(frozen=True, slots=True)
class Gearing:
    """`steps_per_revolution` of the motor, its revolutions for one of the axis, and direction (1 or -1)."""

    steps_per_revolution: float
    gear_ratio: float = 1.0
    direction: int = 1

    @property
    def steps_per_deg(self) -> float:
        """Return the steps of one degree of the axis, without direction."""
        return self.steps_per_revolution * self.gear_ratio / 360.0

    def steps(self, axis_deg: float) -> int:
        """Return the motor's signed steps for an axis angle."""
        return round(axis_deg * self.steps_per_deg * self.direction)

    def degrees(self, steps: float) -> float:
        """Return the axis angle of motor steps."""
        return steps / self.steps_per_deg * self.direction + 0.0

    def speed(self, speed_dps: float, unit: str) -> float:
        """Return an axis speed in a drive's unit; one step or revolution a minute is the least, not zero."""
        value = abs(speed_dps) * SPEEDS[unit](self)
        return max(1.0, value) if speed_dps else 0.0

    def velocity(self, speed_dps: float, unit: str) -> float:
        """Return a signed axis speed in a drive's unit, turned to the motor's direction."""
        sign = self.direction if speed_dps > 0.0 else -self.direction
        return sign * self.speed(speed_dps, unit)

    def velocity_dps(self, value: float, unit: str) -> float:
        """Return the signed axis speed of a drive's value."""
        return value / SPEEDS[unit](self) * self.direction + 0.0

    def ramp(self, acceleration_dps2: float, unit: str) -> float:
        """Return an axis acceleration in a drive's unit, at least 1."""
        return max(1.0, RAMPS[unit](self, acceleration_dps2))


def gearing_of(profile: Profile, axis: AxisDrive) -> Gearing:
    """Return the gearing of an axis: its own steps per revolution, or the profile's."""
    steps = axis.steps_per_revolution or profile.steps_per_revolution
    return Gearing(steps, axis.gear_ratio, -1 if axis.inverted else 1)


def _rpm(gearing: Gearing) -> float:
    return gearing.gear_ratio / 6.0


SPEEDS: Mapping[str, Callable[[Gearing], float]] = {
    "steps/s": lambda gearing: gearing.steps_per_deg,
    "rpm": _rpm,
}
"""Units of speed that a drive may speak, each as drive units for one degree a second of the axis."""

RAMPS: Mapping[str, Callable[[Gearing, float], float]] = {
    "steps/s2": lambda gearing, dps2: dps2 * gearing.steps_per_deg,
    "ms/1000rpm": lambda gearing, dps2: 1e6 / (dps2 * _rpm(gearing)),
}
"""Units in which a drive may take an acceleration in degrees a second squared of the axis."""
