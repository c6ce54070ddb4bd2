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


@dataclass(frozen=True, slots=True)
class Printed:
    """Which steps are taken as printed; left out, each is the corrected one."""

    day: Callable[[Array], Array] = koblick.day_number
    eccentricity: Callable[[Array], Array] = koblick.eccentricity
    sine_obliquity_deg: float | None = None
    altitude_term: float = 0.0

    def position(self, unix_s: Array, latitude_deg: float, longitude_deg: float) -> tuple[Array, Array]:
        """Return azimuth in [0, 360] and true elevation, degrees."""
        day = self.day(unix_s)
        e, w, m = self.eccentricity(day), koblick.perihelion(day), koblick.mean_anomaly(day, ARRAY)
        distance, true_anomaly = koblick.orbit(koblick.eccentric_anomaly(m, e, ARRAY), e, ARRAY)
        longitude = koblick.true_longitude(true_anomaly, w)
        right_ascension, declination = self._equatorial(longitude, koblick.obliquity(day), distance)
        greenwich = koblick.greenwich_sidereal_time(koblick.mean_longitude(w, m), ARRAY)
        hour = koblick.hour_of_day(unix_s, ARRAY)
        sidereal = koblick.local_sidereal_time(greenwich, hour, longitude_deg)
        angle = koblick.hour_angle(sidereal, right_ascension)
        return koblick.horizontal(angle, declination, latitude_deg, ARRAY)

    def _equatorial(self, longitude_deg: Array, tilt_deg: Array, distance: Array) -> tuple[Array, Array]:
        """Return right ascension and declination, degrees, with eqs 19 and 20 as asked."""
        sine_tilt = tilt_deg if self.sine_obliquity_deg is None else np.array(self.sine_obliquity_deg)
        sin_longitude = np.sin(longitude_deg * PER_DEGREE)
        y = sin_longitude * np.cos(tilt_deg * PER_DEGREE)
        z = sin_longitude * np.sin(sine_tilt * PER_DEGREE)
        right_ascension = np.arctan2(y, np.cos(longitude_deg * PER_DEGREE))
        shrunk = np.clip(z * distance / (distance - self.altitude_term), -1.0, 1.0)
        return right_ascension * PER_RADIAN, np.arcsin(shrunk) * PER_RADIAN


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
