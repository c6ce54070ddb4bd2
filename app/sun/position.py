"""Where the sun stands: the algorithms by name, for one instant and for many."""

from dataclasses import dataclass
from datetime import datetime

import numpy as np
from numpy.typing import NDArray

from app.base.angles import wrap360
from app.base.message import N_, say
from app.sun.algorithms import PUBLISHED
from app.sun.algorithms import Algorithm as Algorithm
from app.sun.refraction import refraction_deg, refraction_path
from app.sun.trigonometry import Array

RISE_ELEVATION_DEG = -0.8333
"""True elevation of the sun's centre with its upper limb on the horizon: radius 0.2667, refraction 0.5667."""

FIRST_UNIX_S = -2_177_452_800.0
"""1901-01-01 UT."""

END_UNIX_S = 4_102_444_800.0
"""2100-01-01 UT."""

BLOCK = 8192
"""Positions computed at once: so many that their intermediate columns stay in the processor's cache."""


class InstantRefused(ValueError):
    """An instant for which no sun position can be given."""


@dataclass(frozen=True, slots=True)
class Location:
    """A place on Earth: latitude north positive, longitude east positive, altitude in metres."""

    latitude_deg: float
    longitude_deg: float
    altitude_m: float = 0.0

    def __post_init__(self) -> None:
        if not -90.0 <= self.latitude_deg <= 90.0:
            raise ValueError(
                say(
                    "Latitude must lie between -90 and 90 degrees, not {latitude_deg}.",
                    latitude_deg=self.latitude_deg,
                )
            )
        if not -180.0 <= self.longitude_deg <= 180.0:
            raise ValueError(
                say(
                    "Longitude must lie between -180 and 180 degrees, not {longitude_deg}.",
                    longitude_deg=self.longitude_deg,
                )
            )
        if not -500.0 <= self.altitude_m <= 9000.0:
            raise ValueError(
                say(
                    "Altitude must lie between -500 and 9000 meters, not {altitude_m}.",
                    altitude_m=self.altitude_m,
                )
            )


@dataclass(frozen=True, slots=True)
class SunPosition:
    """Azimuth clockwise from true north [0, 360), elevation without and with refraction, degrees."""

    azimuth_deg: float
    elevation_deg: float
    apparent_elevation_deg: float

    @property
    def is_up(self) -> bool:
        """Return whether the sun's upper limb is above the horizon."""
        return self.elevation_deg >= RISE_ELEVATION_DEG


@dataclass(frozen=True, slots=True)
class SunPath:
    """Sun positions as columns of equal length, with the units and signs of `SunPosition`."""

    azimuth_deg: Array
    elevation_deg: Array
    apparent_elevation_deg: Array

    @property
    def is_up(self) -> NDArray[np.bool_]:
        """Return for each position whether the sun's upper limb is above the horizon."""
        return self.elevation_deg >= RISE_ELEVATION_DEG


def sun_position(algorithm: Algorithm, location: Location, at: datetime) -> SunPosition:
    """Return where the sun stands at an aware instant; raises `InstantRefused` outside 1901 to 2099."""
    if at.tzinfo is None:
        raise InstantRefused(
            say("{at} has no time zone: give the instant with its offset, for example +00:00.", at=at)
        )
    unix_s = at.timestamp()
    if not FIRST_UNIX_S <= unix_s < END_UNIX_S:
        raise InstantRefused(
            say("The sun position is available for the years 1901 to 2099 (UTC), not for {at}.", at=at)
        )
    one = PUBLISHED[algorithm].one
    azimuth_deg, elevation_deg = one(unix_s, location.latitude_deg, location.longitude_deg)
    return SunPosition(wrap360(azimuth_deg), elevation_deg, elevation_deg + refraction_deg(elevation_deg))


def sun_path(algorithm: Algorithm, location: Location, at_unix_s: Array) -> SunPath:
    """Return where the sun stands at each of many instants, seconds since 1970 UTC, a one-dimensional array.

    Raises `InstantRefused` if any instant lies outside the years 1901 to 2099.
    """
    if at_unix_s.size and (at_unix_s.min() < FIRST_UNIX_S or at_unix_s.max() >= END_UNIX_S):
        raise InstantRefused(
            N_(
                "The sun position is available only for the years 1901 to 2099 (UTC); choose "
                "times in this range."
            )
        )
    many = PUBLISHED[algorithm].many
    columns = np.empty((3, at_unix_s.size))
    for first in range(0, at_unix_s.size, BLOCK):
        block = slice(first, first + BLOCK)
        azimuth_deg, elevation_deg = many(at_unix_s[block], location.latitude_deg, location.longitude_deg)
        columns[0, block], columns[1, block] = wrap360_path(azimuth_deg), elevation_deg
        columns[2, block] = elevation_deg + refraction_path(elevation_deg)
    return SunPath(*columns)


def wrap360_path(azimuth_deg: Array) -> Array:
    """Return azimuths from (-360, 360] in [0, 360), as `angles.wrap360` does."""
    wrapped = np.where(azimuth_deg < 0.0, azimuth_deg + 360.0, azimuth_deg)
    return np.where(wrapped >= 360.0, 0.0, wrapped)
