"""Spencer's declination and Lamm's equation of time, as Xia et al. (2015) use them.

Equation numbers are those of Xia et al., "High Precision Biaxial Solar Tracker". Declination: J. W.
Spencer, Search 2 (1971) 172. Equation of time: L. O. Lamm, Solar Energy 26 (1981) 465,
doi:10.1016/0038-092X(81)90229-2. Corrected: the sine that eq 3 lacks in its third term; the arctangent in
place of the arcsine of eq 2, which is wrong beyond the east-west line; the hour angle as 15 (hours - 12)
with the longitude's share. n is a day of the year, N a day of four years that begin with a leap year.
Angles are degrees, the hour angle is positive to the west.
"""

import math

from app.sun.cooper import horizontal, hour_angle
from app.sun.solar_days import day_and_hour, day_of_cycle, day_of_year
from app.sun.trigonometry import PER_RADIAN, T, Trigonometry

LAMM_H = (
    (2.0870e-4, 0.0),
    (9.2869e-3, -1.2229e-1),
    (-5.2258e-2, -1.5698e-1),
    (-1.3077e-3, -5.1602e-3),
    (-2.1867e-3, -2.9823e-3),
    (-1.5100e-4, -2.3463e-4),
)
"""Table 1: A and B of eq 4 for k = 0 to 5, hours."""

DECLINATION_PHASE_DAYS = 0.197
EQUATION_OF_TIME_PHASE_DAYS = -0.242
"""What the phase fix adds to the day, so that both series fit NREL SPA best from 2000 to 2049."""


def day_angle(n: T) -> T:
    """Return Gamma on day n of the year (beside eq 3), radians."""
    return (2.0 * math.pi / 365.0) * (n - 1.0)


def declination(angle: T, trig: Trigonometry[T]) -> T:
    """Return the declination at a day angle (eq 3, with the sine its third term lacks), degrees."""
    first = -0.399912 * trig.cos(angle) + 0.070257 * trig.sin(angle)
    second = -0.006758 * trig.cos(2.0 * angle) + 0.000907 * trig.sin(2.0 * angle)
    third = -0.002697 * trig.cos(3.0 * angle) + 0.00148 * trig.sin(3.0 * angle)
    return PER_RADIAN * (0.006918 + first + second + third)


def equation_of_time(cycle_day: T, trig: Trigonometry[T]) -> T:
    """Return apparent minus mean solar time on day N of four years (eq 4), hours."""
    angle = (2.0 * math.pi / 365.25) * cycle_day
    total = LAMM_H[0][0] + 0.0 * angle
    for k, (a, b) in enumerate(LAMM_H[1:], start=1):
        total = total + a * trig.cos(k * angle) + b * trig.sin(k * angle)
    return total


def position(unix_s: T, latitude_deg: float, longitude_deg: float, trig: Trigonometry[T]) -> tuple[T, T]:
    """Return azimuth from north clockwise in (-180, 180] and true elevation (eqs 1 and 2), degrees.

    Within 0.89 degrees of NREL SPA, 2000 to 2049: both series stand still for a whole day. Latitude north,
    longitude east positive.
    """
    day, hour = day_and_hour(unix_s, longitude_deg, trig)
    delta = declination(day_angle(day_of_year(day, trig)), trig)
    apparent_h = hour + equation_of_time(day_of_cycle(day, trig), trig)
    return horizontal(delta, hour_angle(apparent_h), latitude_deg, trig)


def phased_day_angle(cycle_day: T) -> T:
    """Return Gamma on a day and fraction of four years, radians: in place of the angle beside eq 3."""
    return (2.0 * math.pi / 365.25) * (cycle_day - 1.0 + DECLINATION_PHASE_DAYS)


def position_phase(
    unix_s: T, latitude_deg: float, longitude_deg: float, trig: Trigonometry[T]
) -> tuple[T, T]:
    """Return azimuth in (-180, 180] and true elevation, degrees, with the day's fraction and the phase fix.

    The coefficients stay as published; both series run on days of UT that flow, and are shifted in phase.
    Within 0.12 degrees of NREL SPA, 2000 to 2049. Latitude north, longitude east positive.
    """
    day, hour = day_and_hour(unix_s, 0.0, trig)
    cycle_day = day_of_cycle(day, trig) + hour / 24.0
    delta = declination(phased_day_angle(cycle_day), trig)
    apparent_h = equation_of_time(cycle_day + EQUATION_OF_TIME_PHASE_DAYS, trig) + hour + longitude_deg / 15.0
    return horizontal(delta, hour_angle(apparent_h), latitude_deg, trig)
