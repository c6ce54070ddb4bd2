"""NREL SPA as a table: for each day cubics of the sun's hour angle at Greenwich and of its declination.

Reda and Andreas, "Solar position algorithm for solar radiation applications", Solar Energy 76 (2004)
577-589, doi:10.1016/j.solener.2003.12.003, as pvlib computes it. What changes with the observer is left out
of the table and added by whoever reads it.
"""

from dataclasses import dataclass
from datetime import UTC, datetime
from math import floor, radians

import numpy as np
from pvlib import spa

from app.sun.trigonometry import Array

DAY_S = 86400.0
NODES = np.cos(np.pi * (np.arange(6) + 0.5) / 6.0) / 2.0
"""Where in the day the cubics are fitted: Chebyshev points, days from noon."""
PARALLAX = radians(8.794 / 3600.0)
"""The sun's equatorial horizontal parallax at one astronomical unit (SPA eq 35)."""


@dataclass(frozen=True, slots=True)
class SpaTable:
    """Days since 1970 from `first_day` on; `terms` has a row for each.

    A row holds four coefficients each, of ascending powers of days from noon UT, for the hour angle at
    Greenwich (radians), the sine and the cosine of the declination, and the parallax (radians).
    """

    first_day: int
    terms: Array

    def covers(self, begin_unix_s: float, end_unix_s: float) -> bool:
        """Return whether two instants and what lies between them are inside the table."""
        last = self.first_day + len(self.terms)
        return self.first_day * DAY_S <= begin_unix_s and end_unix_s < last * DAY_S


def build(begin_unix_s: float, end_unix_s: float) -> SpaTable:
    """Return a table of the days from one instant to another, seconds since 1970 UTC, both included.

    Terrestrial time is ahead of UT by pvlib's `calculate_deltat` in the middle of each year.
    """
    first_day = floor(begin_unix_s / DAY_S)
    days = np.arange(first_day, floor(end_unix_s / DAY_S) + 1, dtype=np.float64)
    instants = ((days + 0.5)[:, None] + NODES[None, :]) * DAY_S
    delta_t = np.repeat([delta_t_s(day) for day in days], len(NODES))
    angle, declination, distance = _geocentric(instants.ravel(), delta_t)
    angle = np.unwrap(angle.reshape(instants.shape), axis=1)
    declination = declination.reshape(instants.shape)
    columns = [_cubics(angle), _cubics(np.sin(declination)), _cubics(np.cos(declination))]
    parallax = PARALLAX / distance.reshape(instants.shape).mean(axis=1, keepdims=True)
    return SpaTable(first_day, np.ascontiguousarray(np.hstack([*columns, parallax])))


def delta_t_s(day: float) -> float:
    """Return terrestrial time less UT in the year of a day since 1970, seconds."""
    year = datetime.fromtimestamp(day * DAY_S, UTC).year
    return float(spa.calculate_deltat(year, 6))


def _geocentric(unix_s: Array, delta_t: Array) -> tuple[Array, Array, Array]:
    """Return hour angle at Greenwich and declination, radians, and distance, astronomical units."""
    sidereal, right_ascension, declination = spa.solar_position_numpy(
        unix_s, 0.0, 0.0, 0.0, 1010.0, 10.0, delta_t, 0.5667, 1, sst=True
    )
    distance = spa.earthsun_distance(unix_s, delta_t, 1)
    return np.radians(sidereal - right_ascension), np.radians(declination), np.asarray(distance)


def _cubics(values: Array) -> Array:
    """Return the coefficients, ascending, of the cubic through each row's values at `NODES`."""
    return np.asarray(np.polynomial.polynomial.polyfit(NODES, values.T, 3).T, dtype=np.float64)
