"""What an equatorial panel collects in a day: held still, in steps, or following the sun.

Hours are solar hours, hour angles positive in the morning, tilts from the horizontal towards the south.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from app.base.message import N_
from app.energy.equatorial import (
    DEGREES_AN_HOUR,
    NOON_H,
    cos_incidence,
    daylight_h,
    hour_angle_deg,
    panel_declination_deg,
)
from app.energy.meliss import TURBIDITY, Beam, beam_of_day
from app.energy.quadrature import integral, nodes_between
from app.sun.trigonometry import Array

MORNING_H, EVENING_H = 6.0, 18.0


@dataclass(frozen=True, slots=True)
class SolarDay:
    """The light of one day at one latitude: what a program is judged by.

    `begin_h` and `end_h` bound the hours that are counted. Raises `ValueError` if they are not in order.
    """

    latitude_deg: float
    declination_deg: float
    beam: Beam
    begin_h: float
    end_h: float

    def __post_init__(self) -> None:
        if not 0.0 <= self.begin_h <= self.end_h <= 24.0:
            raise ValueError(
                N_("The counted hours of a day must be between 0 and 24 and in ascending order.")
            )


@dataclass(frozen=True, slots=True)
class Steps:
    """A step program: `angles_deg[0]` until `starts_h[0]`, then each next angle; a step lasts `step_h`.

    Angles fall from morning to evening. There is one angle more than there are starts.
    """

    starts_h: tuple[float, ...]
    angles_deg: tuple[float, ...]
    tilt_deg: float
    step_h: float = 0.0

    def __post_init__(self) -> None:
        if len(self.angles_deg) != len(self.starts_h) + 1:
            raise ValueError(N_("A step program has one more angle than steps."))
        if any(after - before < self.step_h - 1e-9 for before, after in pairwise(self.starts_h)):
            raise ValueError(N_("A step must end before the next begins; take fewer or shorter steps."))

    @property
    def travel_deg(self) -> float:
        """Return how far the panel turns in a day, the way back for the next morning included."""
        there = sum(abs(after - before) for before, after in pairwise(self.angles_deg))
        return there + abs(self.angles_deg[-1] - self.angles_deg[0])

    def angle_deg(self, solar_h: Array) -> Array:
        """Return the hour angle of the panel at solar hours, moving evenly while it steps."""
        if not self.starts_h:
            return np.full(solar_h.shape, self.angles_deg[0])
        step_h = max(self.step_h, 1e-12)
        at_h = np.ravel([(start, start + step_h) for start in self.starts_h])
        turned_deg = np.interp(solar_h, at_h, np.repeat(self.angles_deg, 2)[1:-1])
        return np.asarray(turned_deg, dtype=np.float64)

    def edges_h(self) -> tuple[float, ...]:
        """Return the instants at which the motion begins or ends, in order."""
        ends = (start + self.step_h for start in self.starts_h) if self.step_h else ()
        return tuple(sorted((*self.starts_h, *ends)))


def clear_day(
    latitude_deg: float,
    day_of_year: int,
    sun_declination_deg: float,
    *,
    turbidity: float = TURBIDITY,
    whole: bool = True,
) -> SolarDay:
    """Return a day of Meliss's model, from sunrise to sunset, or if not `whole` from 6 h to 18 h at most."""
    begin_h, end_h = daylight_h(latitude_deg, sun_declination_deg)
    if not whole:
        begin_h, end_h = max(begin_h, MORNING_H), min(end_h, EVENING_H)
    beam = beam_of_day(latitude_deg, sun_declination_deg, day_of_year, turbidity)
    return SolarDay(latitude_deg, sun_declination_deg, beam, begin_h, end_h)


def collected_whm2(day: SolarDay, angle_deg: Callable[[Array], Array], tilt_deg: float) -> float:
    """Return the beam energy, Wh/m2, of a panel whose hour angle is a smooth function of solar hours."""
    return integral(lambda at_h: _received_wm2(day, at_h, angle_deg(at_h), tilt_deg), day.begin_h, day.end_h)


def stepped_whm2(day: SolarDay, steps: Steps) -> float:
    """Return the beam energy of a step program, Wh/m2, integrated from one edge of its motion to the next."""
    inside = (edge for edge in steps.edges_h() if day.begin_h < edge < day.end_h)
    edges = (day.begin_h, *inside, day.end_h)
    total = 0.0
    for begin_h, end_h in pairwise(edges):
        at_h, weight_h = nodes_between(begin_h, end_h)
        total += float(_received_wm2(day, at_h, steps.angle_deg(at_h), steps.tilt_deg) @ weight_h)
    return total


def fixed_whm2(day: SolarDay, tilt_deg: float) -> float:
    """Return what a panel collects that stays in its noon position, Wh/m2."""
    return collected_whm2(day, np.zeros_like, tilt_deg)


def following_whm2(day: SolarDay, tilt_deg: float, range_deg: float = 180.0) -> float:
    """Return what a panel collects that follows the hour angle within +-`range_deg`, Wh/m2."""
    edges = (NOON_H - range_deg / DEGREES_AN_HOUR, NOON_H + range_deg / DEGREES_AN_HOUR)
    inside = (edge for edge in edges if day.begin_h < edge < day.end_h)
    spans = pairwise((day.begin_h, *inside, day.end_h))

    def received(at_h: Array) -> Array:
        angle_deg = np.clip(hour_angle_deg(at_h), -range_deg, range_deg)
        return _received_wm2(day, at_h, angle_deg, tilt_deg)

    return sum(integral(received, begin_h, end_h) for begin_h, end_h in spans)


def midpoint_h(angles_deg: tuple[float, ...], step_h: float = 0.0) -> tuple[float, ...]:
    """Return the best instants to step: the sun's hour angle is the mean of both angles in mid-step.

    That holds whatever the radiation, the tilt and the day, as long as the sun is not behind the panel.
    """
    return tuple(
        NOON_H - (before + after) / (2 * DEGREES_AN_HOUR) - step_h / 2
        for before, after in pairwise(angles_deg)
    )


def _received_wm2(day: SolarDay, at_h: Array, angle_deg: Array, tilt_deg: float) -> Array:
    facing = cos_incidence(
        angle_deg,
        panel_declination_deg(day.latitude_deg, tilt_deg),
        hour_angle_deg(at_h),
        day.declination_deg,
    )
    return np.asarray(day.beam(at_h) * np.maximum(facing, 0.0), dtype=np.float64)
