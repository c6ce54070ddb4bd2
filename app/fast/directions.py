"""Where a tracker shall face at each tick of a day: the same for all trackers of one site and mode."""

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta

import numpy as np
from numpy.typing import NDArray

from app.sun.events import next_rise
from app.sun.position import Location, SunPath, SunPosition, sun_path, sun_position
from app.sun.trigonometry import Array
from app.tracker.activities.tracking import night_near_deg
from app.tracker.mounts.mount import mode_direction
from app.tracker.settings.config import NightBehaviour, Orientation, TrackerConfig
from app.tracker.supervision.weather_protection import TWILIGHT_DEG
from app.tracker.values.mode import Mode

NO_DAWN_FOR = timedelta(hours=1)


@dataclass(frozen=True, slots=True)
class Directions:
    """Columns with one row a tick, `step_s` seconds apart; angles of the sky in degrees.

    `meant` is False where the panel stays wherever it is; at `night` the azimuth nearest to `near_deg` is
    taken instead of the one nearest to the panel; `up` tells whether the sun is.
    """

    step_s: float
    azimuth_deg: Array
    elevation_deg: Array
    near_deg: Array
    night: NDArray[np.bool_]
    meant: NDArray[np.bool_]
    up: NDArray[np.bool_]


def directions(
    config: TrackerConfig, mode: Mode, held: Orientation, location: Location, at_unix_s: Array
) -> Directions:
    """Return what `config` in a mode aims at, at equidistant instants in seconds since 1970 UTC."""
    sun = sun_path(config.algorithm, location, at_unix_s)
    height_deg = sun.apparent_elevation_deg if config.refraction else sun.elevation_deg
    night = (height_deg < TWILIGHT_DEG) & (mode is not Mode.FIXED)
    azimuth_deg, elevation_deg = _by_day(mode, held, sun, height_deg)
    near_deg, meant = np.zeros(len(at_unix_s)), np.ones(len(at_unix_s), dtype=np.bool_)
    for begin, end in _spans(night):
        for span, dawn in _dawns(config, location, at_unix_s, begin, end):
            found = _by_night(config, mode, held, dawn)
            near_deg[span] = night_near_deg(config, location, dawn)
            meant[span] = found is not None
            if found is not None:
                azimuth_deg[span], elevation_deg[span] = found.azimuth_deg, found.elevation_deg
    step_s = float(at_unix_s[1] - at_unix_s[0])
    return Directions(step_s, azimuth_deg, elevation_deg, near_deg, night, meant, sun.is_up)


def _by_day(mode: Mode, held: Orientation, sun: SunPath, height_deg: Array) -> tuple[Array, Array]:
    """Return a mode's direction at each tick: the sun's angle where an axis follows, else the held one."""
    azimuth_deg = np.full_like(height_deg, held.azimuth_deg)
    elevation_deg = np.full_like(height_deg, held.elevation_deg)
    if mode in (Mode.AZIMUTH, Mode.DUAL):
        azimuth_deg = sun.azimuth_deg.copy()
    if mode in (Mode.ELEVATION, Mode.DUAL):
        elevation_deg = height_deg.copy()
    return azimuth_deg, elevation_deg


def _by_night(
    config: TrackerConfig, mode: Mode, held: Orientation, dawn: SunPosition | None
) -> Orientation | None:
    """Return where the panel waits for the sun; None: wherever it is."""
    match config.night:
        case NightBehaviour.HOLD:
            return None
        case NightBehaviour.PARK:
            return config.park
        case NightBehaviour.SUNRISE if dawn is not None:
            return mode_direction(mode, held, dawn, refraction=config.refraction)
        case _:
            return None


def _spans(flags: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return begin and end of each run of ticks that are flagged."""
    edges = np.flatnonzero(np.diff(flags, prepend=False, append=False))
    return [(int(begin), int(end)) for begin, end in edges.reshape(-1, 2)]


def _dawns(
    config: TrackerConfig, location: Location, at_unix_s: Array, begin: int, end: int
) -> Iterator[tuple[slice, SunPosition | None]]:
    """Yield a night's ticks with the sunrise they wait for, None where there is none within two days."""
    while begin < end:
        at = datetime.fromtimestamp(float(at_unix_s[begin]), UTC)
        rise = next_rise(config.algorithm, location, at)
        dawn = None if rise is None else sun_position(config.algorithm, location, rise)
        until = at + NO_DAWN_FOR if rise is None else rise
        last = max(begin + 1, min(end, int(np.searchsorted(at_unix_s, until.timestamp()))))
        yield slice(begin, last), dawn
        begin = last
