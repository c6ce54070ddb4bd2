"""When the sun rises, transits and sets.

Rise and set are the instants when the sun's upper limb touches a flat horizon in an average atmosphere: true
elevation of its centre -0.8333 degrees, the almanac's convention. Transit is the crossing of the meridian
(hour angle zero). Between two neighbouring extremes of the elevation there is at most one rise or set, and
bisection finds it: no latitude is special.
"""

from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from enum import StrEnum
from itertools import pairwise
from math import atan2, cos, degrees, radians, sin

import numpy as np

from app.base.angles import wrap180
from app.base.message import N_
from app.sun.position import (
    RISE_ELEVATION_DEG,
    Algorithm,
    InstantRefused,
    Location,
    SunPosition,
    sun_path,
    sun_position,
)

SAMPLE = timedelta(minutes=10)
PRECISE = timedelta(milliseconds=10)
SIDEREAL_DPS = 15.0 / 3600.0
GOLDEN = (5**0.5 - 1) / 2


class PolarDay(StrEnum):
    """Why a day has neither rise nor set."""

    DAY = "polar_day"
    NIGHT = "polar_night"


@dataclass(frozen=True, slots=True)
class SunEvents:
    """The first rise, the transit and the last set of a civil day, aware UTC, None where there is none.

    `transit_elevation_deg` is the true elevation at transit. `polar` says why there is neither rise nor set.
    """

    rise: datetime | None
    transit: datetime | None
    set: datetime | None
    transit_elevation_deg: float | None
    polar: PolarDay | None


@dataclass(frozen=True, slots=True)
class Crossing:
    """The sun's upper limb crosses the horizon, upwards (a rise) or downwards (a set)."""

    at: datetime
    rising: bool


def day_events(algorithm: Algorithm, location: Location, begin: datetime, end: datetime) -> SunEvents:
    """Return what the sun does between two aware instants, the local midnights of a civil day.

    Raises `InstantRefused` for naive instants, an empty span, or outside the years 1901 to 2099.
    """
    found = crossings(algorithm, location, begin, end)
    rises = [crossing.at for crossing in found if crossing.rising]
    sets = [crossing.at for crossing in found if not crossing.rising]
    transit = _transit(algorithm, location, begin, end)
    return SunEvents(
        rise=rises[0] if rises else None,
        transit=transit,
        set=sets[-1] if sets else None,
        transit_elevation_deg=sun_position(algorithm, location, transit).elevation_deg if transit else None,
        polar=None if found else _polar(sun_position(algorithm, location, begin)),
    )


def next_rise(
    algorithm: Algorithm, location: Location, after: datetime, within: timedelta = timedelta(days=2)
) -> datetime | None:
    """Return the first sunrise after an aware instant, None if there is none within the given time."""
    rises = (found.at for found in crossings(algorithm, location, after, after + within) if found.rising)
    return next(rises, None)


def crossings(
    algorithm: Algorithm, location: Location, begin: datetime, end: datetime
) -> tuple[Crossing, ...]:
    """Return every rise and set in [begin, end), in order, aware UTC."""
    if begin.tzinfo is None or end.tzinfo is None or end <= begin:
        raise InstantRefused(N_("Give two instants with their time zone, the first before the second."))
    sky = _Elevation(algorithm, location)
    knots = _monotone_pieces(sky, begin.astimezone(UTC), end.astimezone(UTC))
    found = []
    for left, right in pairwise(knots):
        rising = sky.above(right)
        if sky.above(left) != rising:
            found.append(Crossing(_bisect(sky, left, right), rising))
    return tuple(found)


@dataclass(frozen=True, slots=True)
class _Elevation:
    algorithm: Algorithm
    location: Location

    def at(self, at: datetime) -> float:
        return sun_position(self.algorithm, self.location, at).elevation_deg

    def above(self, at: datetime) -> bool:
        return self.at(at) >= RISE_ELEVATION_DEG


def _monotone_pieces(sky: _Elevation, begin: datetime, end: datetime) -> list[datetime]:
    first, last = begin - SAMPLE, end + SAMPLE
    offsets = np.linspace(0.0, (last - first).total_seconds(), int((last - first) / SAMPLE) + 2)
    elevation = sun_path(sky.algorithm, sky.location, first.timestamp() + offsets).elevation_deg
    step = np.diff(elevation)
    turns = np.flatnonzero(step[1:] * step[:-1] <= 0.0) + 1
    instants = [first + timedelta(seconds=float(offset)) for offset in offsets]
    extremes = [_extreme(sky, instants[i - 1], instants[i + 1]) for i in turns.tolist()]
    return [begin, *(at for at in extremes if begin < at < end), end]


def _extreme(sky: _Elevation, left: datetime, right: datetime) -> datetime:
    """Golden-section search for the highest or lowest elevation between two instants."""
    middle = left + (right - left) / 2
    sign = 1.0 if sky.at(middle) >= (sky.at(left) + sky.at(right)) / 2 else -1.0
    while right - left > PRECISE:
        inner = (right - left) * GOLDEN
        if sign * sky.at(right - inner) >= sign * sky.at(left + inner):
            right = left + inner
        else:
            left = right - inner
    return left + (right - left) / 2


def _bisect(sky: _Elevation, left: datetime, right: datetime) -> datetime:
    was_above = sky.above(left)
    while right - left > PRECISE:
        middle = left + (right - left) / 2
        left, right = (middle, right) if sky.above(middle) == was_above else (left, middle)
    return right


def _transit(algorithm: Algorithm, location: Location, begin: datetime, end: datetime) -> datetime | None:
    """Follow the hour angle back to zero from the start of the day, then from a day later."""
    for guess in (begin, begin + timedelta(days=1)):
        at = guess.astimezone(UTC)
        angle = hour_angle_deg(location, sun_position(algorithm, location, at)) % 360.0
        at += timedelta(seconds=(360.0 - angle) / SIDEREAL_DPS)
        for _ in range(4):
            angle = wrap180(hour_angle_deg(location, sun_position(algorithm, location, at)))
            at -= timedelta(seconds=angle / SIDEREAL_DPS)
        if begin <= at < end:
            return at
    return None


def hour_angle_deg(location: Location, sun: SunPosition) -> float:
    """Return the sun's hour angle from its place in the sky, degrees in [-180, 180], west positive."""
    latitude = radians(location.latitude_deg)
    azimuth, elevation = radians(sun.azimuth_deg), radians(sun.elevation_deg)
    west = -sin(azimuth) * cos(elevation)
    equator = sin(elevation) * cos(latitude) - cos(elevation) * cos(azimuth) * sin(latitude)
    return degrees(atan2(west, equator))


def _polar(sun: SunPosition) -> PolarDay:
    return PolarDay.DAY if sun.is_up else PolarDay.NIGHT
