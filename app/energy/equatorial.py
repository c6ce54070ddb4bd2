"""The sun and an equatorial panel in solar time, as C. Alexandru has them.

"Simulation and Optimization of a Dual-Axis Solar Tracking Mechanism", Mathematics 12 (2024) 1034,
doi:10.3390/math12071034. Degrees and hours; hour angles are **positive in the morning**, as in that paper.
The paper's eq 7 writes the tilt where the declination of the panel's normal is meant; `cos_incidence` takes
the latter, and the tilt is turned into it by `panel_declination_deg`.
"""

from math import acos, cos, degrees, pi, radians, sin, tan

import numpy as np

from app.sun.trigonometry import PER_DEGREE, Array

NOON_H = 12.0
DEGREES_AN_HOUR = 15.0


def declination_deg(day_of_year: int) -> float:
    """Return the sun's declination, degrees; day 1 is 1 January."""
    return 23.45 * sin(radians(360.0 / 365.0 * (day_of_year - 80)))


def hour_angle_deg(solar_h: Array) -> Array:
    """Return the sun's hour angle at solar hours, degrees, positive in the morning."""
    return DEGREES_AN_HOUR * (NOON_H - solar_h)


def sin_altitude(latitude_deg: float, sun_declination_deg: float, solar_h: Array) -> Array:
    """Return the sine of the sun's altitude at solar hours."""
    latitude, declination = radians(latitude_deg), radians(sun_declination_deg)
    level = cos(latitude) * cos(declination) * np.cos(hour_angle_deg(solar_h) * PER_DEGREE)
    return np.asarray(sin(latitude) * sin(declination) + level, dtype=np.float64)


def daylight_h(latitude_deg: float, sun_declination_deg: float) -> tuple[float, float]:
    """Return sunrise and sunset, solar hours; 0 and 24 in polar day, 12 and 12 in polar night."""
    latitude = radians(max(-89.999, min(89.999, latitude_deg)))
    cos_half_day = -tan(latitude) * tan(radians(sun_declination_deg))
    half_day_h = degrees(acos(max(-1.0, min(1.0, cos_half_day)))) / DEGREES_AN_HOUR
    return NOON_H - half_day_h, NOON_H + half_day_h


def panel_declination_deg(latitude_deg: float, tilt_deg: float) -> float:
    """Return the declination of a panel's normal, whose tilt from the horizontal is towards the south."""
    return latitude_deg - tilt_deg


def cos_incidence(
    panel_hour_deg: Array, panel_declination_deg: float, sun_hour_deg: Array, sun_declination_deg: float
) -> Array:
    """Return the cosine of the angle of incidence (eq 7); negative when the sun is behind the panel."""
    panel, sun = radians(panel_declination_deg), radians(sun_declination_deg)
    turned = np.cos((panel_hour_deg - sun_hour_deg) * PER_DEGREE)
    return np.asarray(cos(panel) * cos(sun) * turned + sin(panel) * sin(sun), dtype=np.float64)


def extraterrestrial_wm2(day_of_year: int) -> float:
    """Return the sun's irradiance outside the air, W/m2 (eq 8); the phase of 2.72 is degrees."""
    return 1367.0 * (1.0 + 0.0334 * cos((0.9856 * day_of_year - 2.72) * pi / 180.0))
