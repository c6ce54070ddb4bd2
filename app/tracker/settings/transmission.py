"""Linear actuators: the triangle that turns a stroke in millimetres into the angle of an axis, and back.

The mechanism of C. Alexandru, Mathematics 2024, 12, 1034, doi:10.3390/math12071034: one end of the actuator
is held by the part that the axis turns against, the other by the part that turns. Between the ends of the
stroke the formulas hold exactly; beyond them the angle goes on in a straight line, as steep as the stroke is
anywhere, so that a reading of a drive that has lost its zero still means something.
"""

from dataclasses import dataclass
from math import acos, atan2, cos, degrees, hypot, radians, sin, sqrt
from typing import Annotated

from annotated_types import Ge, Le

from app.base.message import N_, say, with_format
from app.tracker.settings.declared import Setting, check

FARTHEST_MM = 100_000.0
Millimetres = Annotated[float, Ge(-FARTHEST_MM), Le(FARTHEST_MM)]
LEAST_TRANSMISSION_DEG = 10.0
MOST_TRANSMISSION_DEG = 170.0
ROUNDING_DEG = 1e-3


@dataclass(frozen=True, slots=True)
class Point:
    """A place in the frame of an axis, millimetres: z along the axis, a growing angle turns x towards y."""

    x_mm: Millimetres
    y_mm: Millimetres
    z_mm: Millimetres = 0.0


@dataclass(frozen=True, slots=True)
class LinearActuator:
    """An actuator between `base`, which stays, and `joint`, which turns with the axis, by its points.

    `joint` is where it is at the axis angle `at_deg`. The length runs from `retracted_mm` over `travel_mm`,
    at `speed_mm_s` or less. Raises `ValueError` for points that cannot have these lengths, and for a
    transmission angle outside of 10 to 170 degrees, where the actuator could jam.
    """

    base: Point
    joint: Point
    at_deg: Annotated[float, Ge(-720), Le(720), Setting(N_("Axis angle of the points"), "°")]
    retracted_mm: Annotated[float, Ge(0.1), Le(FARTHEST_MM), Setting(N_("Retracted length"), "mm")]
    travel_mm: Annotated[float, Ge(0.1), Le(FARTHEST_MM), Setting(N_("Stroke"), "mm")]
    speed_mm_s: Annotated[float, Ge(0.1), Le(FARTHEST_MM), Setting(N_("Speed"), "mm/s")]

    def __post_init__(self) -> None:
        check(self)
        held, arm, aside = _triangle(self)
        if min(held, arm) <= 0.0:
            raise ValueError(N_("Neither end of the actuator may lie on the axis: it could not turn it."))
        shortest, longest = hypot(held - arm, aside), hypot(held + arm, aside)
        if not shortest < self.retracted_mm < self.retracted_mm + self.travel_mm < longest:
            raise ValueError(
                say(
                    "With these points the actuator is between {shortest} and {longest} mm long; from "
                    "{retracted_mm} to {retracted_mm2} mm it cannot go.",
                    shortest=with_format(shortest, ".1f"),
                    longest=with_format(longest, ".1f"),
                    retracted_mm=with_format(self.retracted_mm, "g"),
                    retracted_mm2=with_format(self.retracted_mm + self.travel_mm, "g"),
                )
            )
        ends_deg = [_transmission_deg(self, self.retracted_mm + stroke) for stroke in (0.0, self.travel_mm)]
        if min(ends_deg) < LEAST_TRANSMISSION_DEG or max(ends_deg) > MOST_TRANSMISSION_DEG:
            raise ValueError(
                say(
                    "The transmission angle runs from {ends_deg} to {ends_deg2} degrees; it must stay "
                    "between 10 and 170, so that the actuator does not jam.",
                    ends_deg=with_format(min(ends_deg), ".1f"),
                    ends_deg2=with_format(max(ends_deg), ".1f"),
                )
            )

    @property
    def range_deg(self) -> tuple[float, float]:
        """Return the lowest and the highest axis angle within the stroke."""
        ends_deg = self.angle_deg(0.0), self.angle_deg(self.travel_mm)
        return min(ends_deg), max(ends_deg)

    def length_mm(self, angle_deg: float) -> float:
        """Return the distance of both ends at an axis angle."""
        held, arm, aside = _triangle(self)
        opening = radians(angle_deg - self.at_deg) + _phase(self)
        return sqrt(held * held + arm * arm + aside * aside - 2.0 * held * arm * cos(opening))

    def stroke_mm(self, angle_deg: float) -> float:
        """Return how far the actuator is driven out at an axis angle; a straight line beyond its ends."""
        low_deg, high_deg = self.range_deg
        inside_deg = min(high_deg, max(low_deg, angle_deg))
        beyond_deg = angle_deg - inside_deg
        stroke_mm = self.length_mm(inside_deg) - self.retracted_mm
        return stroke_mm + beyond_deg * _steepest_mm_per_deg(self) if beyond_deg else stroke_mm

    def angle_deg(self, stroke_mm: float) -> float:
        """Return the axis angle at a stroke: the inverse of `stroke_mm`."""
        held, arm, aside = _triangle(self)
        inside_mm = min(self.travel_mm, max(0.0, stroke_mm))
        length_mm = self.retracted_mm + inside_mm
        cosine = (held * held + arm * arm + aside * aside - length_mm * length_mm) / (2.0 * held * arm)
        opening_deg = degrees(acos(min(1.0, max(-1.0, cosine))))
        angle_deg = self.at_deg + _side(self) * opening_deg - degrees(_phase(self))
        beyond_mm = stroke_mm - inside_mm
        return angle_deg + beyond_mm / _steepest_mm_per_deg(self) if beyond_mm else angle_deg

    def mm_per_deg(self, angle_deg: float) -> float:
        """Return how far the actuator is driven out for a degree; negative where that turns the axis back."""
        low_deg, high_deg = self.range_deg
        if low_deg - ROUNDING_DEG <= angle_deg <= high_deg + ROUNDING_DEG:
            return _slope(self, angle_deg)
        return _steepest_mm_per_deg(self)

    def transmission_deg(self, angle_deg: float) -> float:
        """Return the angle at the joint between the actuator and the arm to the axis."""
        return _transmission_deg(self, self.length_mm(angle_deg))

    def slowest_dps(self, low_deg: float, high_deg: float) -> float:
        """Return how fast the actuator turns the axis where it turns it slowest, between two axis angles."""
        return self.speed_mm_s / abs(_steepest_between(self, low_deg, high_deg))


def _triangle(actuator: LinearActuator) -> tuple[float, float, float]:
    """Return the distances of base and joint from the axis, and from each other along it."""
    base, joint = actuator.base, actuator.joint
    return hypot(base.x_mm, base.y_mm), hypot(joint.x_mm, joint.y_mm), joint.z_mm - base.z_mm


def _phase(actuator: LinearActuator) -> float:
    """Return the angle at the axis from the base to the joint where it is given, in (-pi, pi], radians."""
    base, joint = actuator.base, actuator.joint
    across = base.x_mm * joint.y_mm - base.y_mm * joint.x_mm
    return atan2(across, base.x_mm * joint.x_mm + base.y_mm * joint.y_mm)


def _side(actuator: LinearActuator) -> float:
    """Return on which side of the base the joint turns, 1 or -1: the whole stroke lies on one."""
    return -1.0 if _phase(actuator) < 0.0 else 1.0


def _slope(actuator: LinearActuator, angle_deg: float) -> float:
    """Return the derivative of the length, millimetres a degree."""
    held, arm, _ = _triangle(actuator)
    opening = radians(angle_deg - actuator.at_deg) + _phase(actuator)
    return radians(held * arm * sin(opening) / actuator.length_mm(angle_deg))


def _steepest_mm_per_deg(actuator: LinearActuator) -> float:
    return _steepest_between(actuator, *actuator.range_deg)


def _steepest_between(actuator: LinearActuator, low_deg: float, high_deg: float) -> float:
    """Return the slope, with its sign, where a degree takes the longest stroke."""
    straight_deg = actuator.at_deg - degrees(_phase(actuator))
    steepest_deg = straight_deg + _side(actuator) * degrees(acos(_steepest(actuator)))
    inside_deg = min(high_deg, max(low_deg, steepest_deg))
    return max((_slope(actuator, angle) for angle in (low_deg, high_deg, inside_deg)), key=abs)


def _steepest(actuator: LinearActuator) -> float:
    """Return the cosine of the opening at which a degree takes the longest stroke.

    There the derivative of sin(opening) / length is zero: with length^2 = s - q cos(opening), the cosine c
    solves q c^2 / 2 - s c + q / 2 = 0.
    """
    held, arm, aside = _triangle(actuator)
    total, product = held * held + arm * arm + aside * aside, 2.0 * held * arm
    return (total - sqrt(total * total - product * product)) / product


def _transmission_deg(actuator: LinearActuator, length_mm: float) -> float:
    held, arm, aside = _triangle(actuator)
    flat = length_mm * length_mm - aside * aside
    cosine = (arm * arm + flat - held * held) / (2.0 * arm * length_mm)
    return degrees(acos(min(1.0, max(-1.0, cosine))))
