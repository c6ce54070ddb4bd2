"""Alexandru, "Simulation and Optimization of a Dual-Axis Solar Tracking Mechanism".

Mathematics 12 (2024) 1034, doi:10.3390/math12071034. Cooper's declination counted from day 80, one day off
Cooper's own, and an hour angle of apparent solar time that is positive in the morning. The paper gives
angles in solar time; the equation of time that leads there from the clock is Spencer's, as in `cooper`.
Angles are degrees.
"""

from app.sun import cooper
from app.sun.solar_days import day_and_hour, day_of_year
from app.sun.trigonometry import PER_DEGREE, T, Trigonometry


def declination(n: T, trig: Trigonometry[T]) -> T:
    """Return the declination on day N of the year (eq 8), degrees."""
    return 23.45 * trig.sin((360.0 / 365.0) * (n - 80.0) * PER_DEGREE)


def hour_angle(solar_h: T) -> T:
    """Return the hour angle at an hour of solar time (eq 8), degrees, positive in the morning."""
    return (12.0 - solar_h) * 15.0


def position(unix_s: T, latitude_deg: float, longitude_deg: float, trig: Trigonometry[T]) -> tuple[T, T]:
    """Return azimuth from north clockwise in (-180, 180] and true elevation, degrees.

    Within 1.87 degrees of NREL SPA, 2000 to 2049. Latitude north, longitude east positive.
    """
    day, hour = day_and_hour(unix_s, longitude_deg, trig)
    n = day_of_year(day, trig)
    solar_h = hour + cooper.spencer_equation_of_time(n, trig) / 60.0
    return cooper.horizontal(declination(n, trig), -hour_angle(solar_h), latitude_deg, trig)
