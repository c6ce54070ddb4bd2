"""Sun sightings: what one says about a likely mistake, and how several correct the pointing."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import timedelta
from enum import StrEnum

import numpy as np

from app.base.angles import separation_deg, wrap180
from app.base.message import N_, Message, join, say, with_format
from app.sun.position import Algorithm, Location, SunPosition, sun_path, sun_position
from app.sun.trigonometry import SCALAR, Array
from app.tracker.commands.commands import CommandRejected
from app.tracker.memory.memory import Pointing, Sighting
from app.tracker.mounts.mount import PLAIN, to_axes
from app.tracker.values.reason import Reason

FEWEST_SIGHTINGS = 3
ALIGNED_DEG = 0.3
PARAMETER_PENALTY_DEG = 0.3
CLOCK_SEARCH = timedelta(hours=13)
WEAKEST_LEVERAGE = 0.15
"""Least singular value: an error of 0.1 degrees in a sighting then moves the result by 0.7 at most."""

LARGEST_LEAN_DEG = 15.0
ITERATIONS = 8
DIFFERENCE_DEG = 1e-4


class Mistake(StrEnum):
    """What is easily done wrong on site."""

    CLOCK = "clock"
    LONGITUDE_SIGN = "longitude_sign"
    LATITUDE_SIGN = "latitude_sign"
    SWAPPED = "swapped"
    MAGNETIC_NORTH = "magnetic_north"
    AZIMUTH_ZERO = "azimuth_zero"
    ELEVATION_ZERO = "elevation_zero"
    BOTH_ZEROS = "both_zeros"


@dataclass(frozen=True, slots=True)
class Cause:
    """A likely mistake: what to check, and how far off the sighting would still be without it, degrees.

    `shift_s` is, for the clock, what has to be added to it.
    """

    mistake: Mistake
    message: str
    residual_deg: float
    shift_s: float | None = None


def diagnose(
    sighting: Sighting,
    location: Location,
    algorithm: Algorithm = Algorithm.PSA,
    *,
    refraction: bool = True,
    magnetic_declination_deg: float | None = None,
) -> list[Cause]:
    """Return which mistakes explain at least half of a sighting's error, the most likely first.

    A mistake with a free quantity (minutes, degrees) fits more easily and needs a better residual to come
    first. Empty if panel and sun agree within 0.3 degrees. Magnetic declination is east positive.
    """
    error_deg = _off(sighting, sighting.sun_azimuth_deg, sighting.sun_elevation_deg)
    if error_deg < ALIGNED_DEG:
        return []
    sky = _Sky(sighting, location, algorithm, refraction)
    weighed = [
        *_place_mistakes(sky),
        *_clock_mistake(sky),
        *_zero_mistakes(sighting, magnetic_declination_deg),
    ]
    likely = [(free, cause) for free, cause in weighed if cause.residual_deg <= error_deg / 2.0]
    likely.sort(key=lambda entry: entry[1].residual_deg + entry[0] * PARAMETER_PENALTY_DEG)
    return [cause for _, cause in likely]


@dataclass(frozen=True, slots=True)
class _Sky:
    sighting: Sighting
    location: Location
    algorithm: Algorithm
    refraction: bool

    def off_deg(self, sun: SunPosition) -> float:
        elevation_deg = sun.apparent_elevation_deg if self.refraction else sun.elevation_deg
        return _off(self.sighting, sun.azimuth_deg, elevation_deg)


def _off(sighting: Sighting, azimuth_deg: float, elevation_deg: float) -> float:
    return separation_deg(
        sighting.panel_azimuth_deg, sighting.panel_elevation_deg, azimuth_deg, elevation_deg
    )


def _place_mistakes(sky: _Sky) -> Iterator[tuple[int, Cause]]:
    here = sky.location
    latitude, longitude = here.latitude_deg, here.longitude_deg
    places = [
        (
            Mistake.LONGITUDE_SIGN,
            N_("The longitude has the wrong sign: east is positive."),
            latitude,
            -longitude,
        ),
        (
            Mistake.LATITUDE_SIGN,
            N_("The latitude has the wrong sign: north is positive."),
            -latitude,
            longitude,
        ),
    ]
    if abs(longitude) <= 90.0:
        places.append((Mistake.SWAPPED, N_("Latitude and longitude are swapped."), longitude, latitude))
    for mistake, message, at_latitude, at_longitude in places:
        there = replace(here, latitude_deg=at_latitude, longitude_deg=at_longitude)
        residual_deg = sky.off_deg(sun_position(sky.algorithm, there, sky.sighting.at))
        yield 0, Cause(mistake, say("{message} Check step 1.", message=message), residual_deg)


def _clock_mistake(sky: _Sky) -> Iterator[tuple[int, Cause]]:
    """Try every minute of the day around, then every second around the best."""
    best_s = 0.0
    for reach_s, step_s in ((CLOCK_SEARCH.total_seconds(), 60.0), (60.0, 1.0)):
        shifts_s = best_s + np.arange(-reach_s, reach_s + step_s, step_s)
        best_s = float(shifts_s[np.argmin(_shifted_off(sky, shifts_s))])
    at = sky.sighting.at + timedelta(seconds=best_s)
    residual_deg = sky.off_deg(sun_position(sky.algorithm, sky.location, at))
    minutes, slow = abs(best_s) / 60.0, best_s > 0.0
    message = (
        say("The clock is {minutes} minutes slow.", minutes=with_format(minutes, ".1f"))
        if slow
        else say("The clock is {minutes} minutes fast.", minutes=with_format(minutes, ".1f"))
    )
    whole_hours = abs(best_s / 3600.0 - round(best_s / 3600.0)) < 0.05 and abs(best_s) > 1800.0
    zone = N_("Check step 2: the time zone or daylight saving time is probably wrong.")
    yield (
        1,
        Cause(
            Mistake.CLOCK,
            join(" ", (message, zone if whole_hours else N_("Check step 2."))),
            residual_deg,
            best_s,
        ),
    )


def _shifted_off(sky: _Sky, shifts_s: Array) -> Array:
    sun = sun_path(sky.algorithm, sky.location, sky.sighting.at.timestamp() + shifts_s)
    elevation = np.radians(sun.apparent_elevation_deg if sky.refraction else sun.elevation_deg)
    panel = np.radians(sky.sighting.panel_elevation_deg)
    turned = np.radians(sun.azimuth_deg - sky.sighting.panel_azimuth_deg)
    cosine = np.sin(elevation) * np.sin(panel) + np.cos(elevation) * np.cos(panel) * np.cos(turned)
    return np.asarray(-cosine, dtype=np.float64)


def _zero_mistakes(sighting: Sighting, declination_deg: float | None) -> Iterator[tuple[int, Cause]]:
    azimuth_deg = wrap180(sighting.panel_azimuth_deg - sighting.sun_azimuth_deg)
    elevation_deg = sighting.panel_elevation_deg - sighting.sun_elevation_deg
    without_azimuth_deg = _off(sighting, sighting.panel_azimuth_deg, sighting.sun_elevation_deg)
    without_elevation_deg = _off(sighting, sighting.sun_azimuth_deg, sighting.panel_elevation_deg)
    if declination_deg is not None:
        compass_deg = sighting.sun_azimuth_deg - declination_deg
        residual_deg = _off(sighting, compass_deg, sighting.sun_elevation_deg)
        message = say(
            "North was taken from a compass, which is {declination_deg} degrees off here.",
            declination_deg=with_format(declination_deg, "+.1f"),
        )
        yield (
            0,
            Cause(
                Mistake.MAGNETIC_NORTH,
                say("{message} Repeat step 3 with true north.", message=message),
                residual_deg,
            ),
        )
    message = say(
        "The azimuth home position is off: the axis reads {azimuth_deg} degrees too much.",
        azimuth_deg=with_format(azimuth_deg, "+.1f"),
    )
    if declination_deg is None:
        message = say("{message} If that is the declination here, a compass was used.", message=message)
    yield (
        1,
        Cause(Mistake.AZIMUTH_ZERO, say("{message} Repeat step 3.", message=message), without_azimuth_deg),
    )
    message = say(
        "The elevation home position is off: the axis reads {elevation_deg} degrees too much. Repeat step 3.",
        elevation_deg=with_format(elevation_deg, "+.1f"),
    )
    yield 1, Cause(Mistake.ELEVATION_ZERO, message, without_elevation_deg)
    if min(abs(azimuth_deg), abs(elevation_deg)) < ALIGNED_DEG:
        return
    message = say(
        "Both home positions are off, azimuth by {azimuth_deg} and elevation by {elevation_deg} degrees.",
        azimuth_deg=with_format(azimuth_deg, "+.1f"),
        elevation_deg=with_format(elevation_deg, "+.1f"),
    )
    yield 4, Cause(Mistake.BOTH_ZEROS, say("{message} Repeat step 3.", message=message), 0.0)


def pointing_of(sightings: Sequence[Sighting]) -> Pointing:
    """Return the correction that sightings fit to, none without any; raises as `fit` does."""
    return fit(sightings) if sightings else Pointing()


def fit(sightings: Sequence[Sighting]) -> Pointing:
    """Return the pointing correction that puts the sightings' suns on the axis angles read, least squares.

    Gauss-Newton on azimuth offset, elevation offset and lean; an azimuth error counts times the cosine of
    the elevation. `residual_deg` is the root mean square of what is left. Raises `CommandRejected` when the
    sightings cannot tell these four apart, or when the result is no plausible mast.
    """
    if len(sightings) < FEWEST_SIGHTINGS:
        raise _rejected(
            "too_few_sightings",
            say(
                "Three sightings are needed, spread over the day; there are {sightings}.",
                sightings=len(sightings),
            ),
            N_("Take more sightings, in the morning, around noon, and in the afternoon."),
        )
    start = _start(sightings)
    if float(np.linalg.svd(_derivatives(sightings, start), compute_uv=False)[-1]) < WEAKEST_LEVERAGE:
        raise _too_alike(sightings)
    solution = _solve(sightings, start)
    if max(abs(solution[2]), abs(solution[3])) > LARGEST_LEAN_DEG:
        raise _rejected(
            "implausible_lean",
            say(
                "According to the sightings, the mast leans by {solution} degrees.",
                solution=with_format(max(abs(solution[2:])), ".0f"),
            ),
            N_("This result is implausible. Check location and clock, and remove incorrect sightings."),
        )
    left = _misses(sightings, _pointing(solution))
    residual_deg = float(np.sqrt(np.mean(left[0] ** 2 + left[1] ** 2)))
    return replace(_pointing(solution), residual_deg=residual_deg)


def _start(sightings: Sequence[Sighting]) -> Array:
    """Return the mean azimuth error alone, so that no other error is near half a turn."""
    errors = np.radians([seen.panel_azimuth_deg - seen.sun_azimuth_deg for seen in sightings])
    mean = np.arctan2(np.sin(errors).sum(), np.cos(errors).sum())
    return np.array([float(np.degrees(mean)), 0.0, 0.0, 0.0])


def _solve(sightings: Sequence[Sighting], start: Array) -> Array:
    solution = start
    for _ in range(ITERATIONS):
        misses = _misses(sightings, _pointing(solution)).ravel()
        step = np.linalg.lstsq(_derivatives(sightings, solution), misses, rcond=None)[0]
        solution = solution + step
    return np.asarray(solution, dtype=np.float64)


def _pointing(solution: Array) -> Pointing:
    azimuth_deg, *others = (float(value) for value in solution)
    return Pointing(wrap180(azimuth_deg), *others)


def _derivatives(sightings: Sequence[Sighting], solution: Array) -> Array:
    """Return how both predicted axis angles (azimuth rows first) change with each of the four unknowns."""
    here = _misses(sightings, _pointing(solution)).ravel()
    columns = [
        (here - _misses(sightings, _pointing(solution + aside)).ravel()) / DIFFERENCE_DEG
        for aside in DIFFERENCE_DEG * np.eye(4)
    ]
    return np.array(columns).T


def _misses(sightings: Sequence[Sighting], pointing: Pointing) -> Array:
    """Return angles read less angles predicted, shape (2, sightings), azimuth times cos elevation."""
    rows = []
    for sighting in sightings:
        azimuth_deg, elevation_deg = to_axes(
            PLAIN, pointing, sighting.sun_azimuth_deg, sighting.sun_elevation_deg, SCALAR
        )
        shrink = SCALAR.cos(np.radians(sighting.sun_elevation_deg))
        off_deg = wrap180(sighting.panel_azimuth_deg - azimuth_deg)
        rows.append((off_deg * shrink, sighting.panel_elevation_deg - elevation_deg))
    return np.array(rows).T


def _too_alike(sightings: Sequence[Sighting]) -> CommandRejected:
    azimuths = [sighting.sun_azimuth_deg for sighting in sightings]
    return _rejected(
        "sightings_too_alike",
        say(
            "The sightings are too close together to tell a leaning mast from wrong home "
            "positions: the sun's azimuth was {azimuths} to {azimuths2} degrees.",
            azimuths=with_format(min(azimuths), ".0f"),
            azimuths2=with_format(max(azimuths), ".0f"),
        ),
        N_(
            "Take more sightings, in the morning, around noon, and in the evening, with sun azimuths "
            "at least 60 degrees apart."
        ),
    )


def _rejected(code: str, message: Message, hint: Message) -> CommandRejected:
    return CommandRejected(Reason(code, message, hint))
