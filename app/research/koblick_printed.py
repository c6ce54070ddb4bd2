"""Koblick's sun with single steps as Gezegin and Dirik print them, to measure what each misprint costs."""

from collections.abc import Callable
from dataclasses import dataclass
from math import degrees

import numpy as np

from app.sun import koblick
from app.sun.trigonometry import ARRAY, PER_DEGREE, PER_RADIAN, Array

OBLIQUITY_CONSTANT = 0.409115648642983
"""The number in eq 19, radians."""

ASTRONOMICAL_UNIT_KM = 149_598_000.0
DAY_ZERO = 2_451_543.5


def _orbit(anomaly_deg: Array, e: Array) -> tuple[Array, Array]:
    return koblick.orbit(koblick.eccentric_anomaly(anomaly_deg, e, ARRAY), e, ARRAY)


def _both(tilt_deg: Array) -> tuple[Array, Array]:
    return tilt_deg, tilt_deg


def _horizontal(angle_deg: Array, declination_deg: Array, latitude_deg: float) -> tuple[Array, Array]:
    return koblick.horizontal(angle_deg, declination_deg, latitude_deg, ARRAY)


@dataclass(frozen=True, slots=True)
class Printed:
    """Which steps are taken as printed; left out, each is the corrected one.

    `tilts` gives the obliquities in degrees whose cosine eq 18 and whose sine eq 19 takes, `z_sign` the sign
    of eq 18's second term, `equatorial_unit` what eqs 21 and 22 leave of a degree.
    """

    day: Callable[[Array], Array] = koblick.day_number
    eccentricity: Callable[[Array], Array] = koblick.eccentricity
    orbit: Callable[[Array, Array], tuple[Array, Array]] = _orbit
    longitude: Callable[[Array, Array], Array] = koblick.true_longitude
    tilts: Callable[[Array], tuple[Array, Array]] = _both
    horizontal: Callable[[Array, Array, float], tuple[Array, Array]] = _horizontal
    z_sign: float = -1.0
    altitude_term: float = 0.0
    equatorial_unit: float = 1.0

    def position(self, unix_s: Array, latitude_deg: float, longitude_deg: float) -> tuple[Array, Array]:
        """Return azimuth in [0, 360] and true elevation, degrees."""
        day = self.day(unix_s)
        e, w, m = self.eccentricity(day), koblick.perihelion(day), koblick.mean_anomaly(day, ARRAY)
        distance, true_anomaly = self.orbit(m, e)
        longitude = self.longitude(true_anomaly, w)
        right_ascension, declination = self._equatorial(longitude, koblick.obliquity(day), distance)
        greenwich = koblick.greenwich_sidereal_time(koblick.mean_longitude(w, m), ARRAY)
        hour = koblick.hour_of_day(unix_s, ARRAY)
        sidereal = koblick.local_sidereal_time(greenwich, hour, longitude_deg)
        angle = koblick.hour_angle(sidereal, right_ascension)
        return self.horizontal(angle, declination, latitude_deg)

    def _equatorial(self, longitude_deg: Array, tilt_deg: Array, distance: Array) -> tuple[Array, Array]:
        """Return right ascension and declination, degrees, with eqs 18 to 22 as asked."""
        tilt_of_cosine, tilt_of_sine = (one * PER_DEGREE for one in self.tilts(tilt_deg))
        sin_longitude = np.sin(longitude_deg * PER_DEGREE)
        out_of_ecliptic = np.zeros_like(sin_longitude)
        y = sin_longitude * np.cos(tilt_of_cosine) + self.z_sign * out_of_ecliptic * np.sin(tilt_of_sine)
        z = sin_longitude * np.sin(tilt_of_sine)
        right_ascension = np.arctan2(y, np.cos(longitude_deg * PER_DEGREE))
        shrunk = np.clip(z * distance / (distance - self.altitude_term), -1.0, 1.0)
        unit = PER_RADIAN * self.equatorial_unit
        return right_ascension * unit, np.arcsin(shrunk) * unit


def orbit_of_degrees(anomaly_deg: Array, e: Array) -> tuple[Array, Array]:
    """Return distance and true anomaly by eqs 8 to 10 with sine and cosine of degrees, as printed."""
    taken_deg = anomaly_deg * PER_RADIAN
    eccentric_deg = anomaly_deg + koblick.eccentric_anomaly(taken_deg, e, ARRAY) - taken_deg
    return koblick.orbit(eccentric_deg * PER_RADIAN, e, ARRAY)


def longitude_of_radians(true_anomaly_deg: Array, perihelion_deg: Array) -> Array:
    """Return eq 13 with eq 12's radians added to degrees, as printed."""
    return koblick.true_longitude(true_anomaly_deg * PER_DEGREE, perihelion_deg)


def tilts_of_radians(tilt_deg: Array) -> tuple[Array, Array]:
    """Return the obliquity of eq 7 taken for radians, as its printed unit asks."""
    return tilt_deg * PER_RADIAN, tilt_deg * PER_RADIAN


def cosine_of_degrees(tilt_deg: Array) -> tuple[Array, Array]:
    """Return the obliquity with eq 18's cosine of degrees, as printed."""
    return tilt_deg * PER_RADIAN, tilt_deg


def constant_tilt_of_sine(tilt_deg: Array) -> tuple[Array, Array]:
    """Return the obliquity with eq 19's constant, as printed."""
    return tilt_deg, np.full_like(tilt_deg, constant_obliquity_deg())


def without_y(angle_deg: Array, declination_deg: Array, latitude_deg: float) -> tuple[Array, Array]:
    """Return eqs 31 to 34 with y_hor left at 0, with which a PLC begins: due south or due north."""
    azimuth_deg, elevation_deg = _horizontal(angle_deg, declination_deg, latitude_deg)
    south = np.cos(azimuth_deg * PER_DEGREE) < 0.0
    return np.where(south, 180.0, 0.0), elevation_deg


def calendar(unix_s: Array) -> tuple[Array, Array, Array, Array]:
    """Return year, month, day and decimal hour UT of instants."""
    at = unix_s.astype("datetime64[s]")
    years, months, days = (at.astype(f"datetime64[{unit}]") for unit in "YMD")
    year = years.astype(np.float64) + 1970.0
    month = (months - years).astype(np.float64) + 1.0
    day = (days - months).astype(np.float64) + 1.0
    return year, month, day, np.mod(unix_s, 86400.0) / 3600.0


def day_without_century_rule(unix_s: Array) -> Array:
    """Return the day of eq 2 from eq 1 with its century terms as printed, the month rule added."""
    year, month, day, hour = calendar(unix_s)
    early = month <= 2.0
    year, month = np.where(early, year - 1.0, year), np.where(early, month + 12.0, month)
    return _julian(year, month, day, hour, 2.0 + np.floor(year / 4.0)) - DAY_ZERO


def day_without_month_rule(unix_s: Array) -> Array:
    """Return the day of eq 2 from eq 1 with its century terms corrected and no month rule."""
    year, month, day, hour = calendar(unix_s)
    century = np.floor(year / 100.0)
    return _julian(year, month, day, hour, 2.0 - century + np.floor(century / 4.0)) - DAY_ZERO


def growing_eccentricity(day: Array) -> Array:
    """Return the eccentricity with the sign of eq 4 as printed."""
    return 0.016709 + 1.151e-9 * day


def constant_obliquity_deg() -> float:
    """Return the constant of eq 19 in degrees."""
    return degrees(OBLIQUITY_CONSTANT)


def _julian(year: Array, month: Array, day: Array, hour: Array, leap: Array) -> Array:
    days = np.floor(365.25 * (year + 4716.0)) + np.floor(30.6001 * (month + 1.0))
    return np.asarray(days + leap + day - 1524.5 + hour / 24.0, dtype=np.float64)
