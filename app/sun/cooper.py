"""Cooper's declination with the angles of Nalini and Hemavathi (2023).

Nalini and Hemavathi, "The Mathematical Model for Solar Angles Calculation in Automatic Solar Panel Tracker
Using PLC and SCADA"; equation numbers are theirs. Declination: P. I. Cooper, Solar Energy 12 (1969)
333-346, doi:10.1016/0038-092X(69)90047-4. Equation of time, which the paper leaves out: J. W. Spencer,
Search 2 (1971) 172. The paper has no rule for the hour angle and none for the branch of the azimuth: both
are added here. Angles are degrees, the hour angle is positive to the west.
"""

import math

from app.sun import psa
from app.sun.solar_days import day_and_hour, day_of_year
from app.sun.trigonometry import PER_DEGREE, PER_RADIAN, T, Trigonometry

MINUTES_A_RADIAN = 229.18


def declination(n: T, trig: Trigonometry[T]) -> T:
    """Return the declination on day n of the year (eq 3; its 0.9863 is 360/365 rounded), degrees."""
    return 23.45 * trig.sin(0.9863 * (284.0 + n) * PER_DEGREE)


def spencer_equation_of_time(n: T, trig: Trigonometry[T]) -> T:
    """Return apparent minus mean solar time on day n of the year, minutes (Spencer; not in the paper)."""
    angle = (2.0 * math.pi / 365.0) * (n - 1.0)
    first = 0.001868 * trig.cos(angle) - 0.032077 * trig.sin(angle)
    second = 0.014615 * trig.cos(2.0 * angle) + 0.04089 * trig.sin(2.0 * angle)
    return MINUTES_A_RADIAN * (0.000075 + first - second)


def hour_angle(solar_h: T) -> T:
    """Return the hour angle at an hour of solar time, degrees, west positive (the paper has no rule)."""
    return (solar_h - 12.0) * 15.0


def horizontal(declination_deg: T, angle_deg: T, latitude_deg: float, trig: Trigonometry[T]) -> tuple[T, T]:
    """Return azimuth in (-180, 180] and elevation, degrees (eqs 16 and 17).

    By the four-quadrant arctangent, which gives the branch that the arccosine of eq 17 leaves open.
    """
    zenith, azimuth = psa.horizontal(declination_deg * PER_DEGREE, angle_deg * PER_DEGREE, latitude_deg, trig)
    return azimuth * PER_RADIAN, 90.0 - zenith * PER_RADIAN


def position(unix_s: T, latitude_deg: float, longitude_deg: float, trig: Trigonometry[T]) -> tuple[T, T]:
    """Return azimuth from north clockwise in (-180, 180] and true elevation, degrees, as the paper prints it.

    Within 4.16 degrees of NREL SPA, 2000 to 2049: mean solar time stands for apparent solar time. Latitude
    north, longitude east positive.
    """
    day, hour = day_and_hour(unix_s, longitude_deg, trig)
    delta = declination(day_of_year(day, trig), trig)
    return horizontal(delta, hour_angle(hour), latitude_deg, trig)


def position_with_equation_of_time(
    unix_s: T, latitude_deg: float, longitude_deg: float, trig: Trigonometry[T]
) -> tuple[T, T]:
    """Return azimuth in (-180, 180] and true elevation, degrees, with Spencer's equation of time added.

    Within 1.50 degrees of NREL SPA, 2000 to 2049. Latitude north, longitude east positive.
    """
    day, hour = day_and_hour(unix_s, longitude_deg, trig)
    n = day_of_year(day, trig)
    apparent_h = hour + spencer_equation_of_time(n, trig) / 60.0
    return horizontal(declination(n, trig), hour_angle(apparent_h), latitude_deg, trig)
