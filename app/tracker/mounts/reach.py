"""Which part of a year's sun a tracker can face at a place, by its mount and its soft limits."""

from dataclasses import dataclass
from datetime import UTC, datetime

import numpy as np
from numpy.typing import NDArray

from app.sun.position import Location, SunPath, sun_path
from app.sun.trigonometry import ARRAY, PER_DEGREE, Array
from app.tracker.mounts.capabilities import default_mode
from app.tracker.mounts.kinematics import direction, followed
from app.tracker.mounts.mount import second_axis
from app.tracker.settings.axes import AxisConfig
from app.tracker.settings.config import TrackerConfig

STEP_S = 1200
DAY_S = 86_400
MONTHS_A_YEAR = 12
BEYOND_DEG = 0.5
"""An axis is beyond its limits from here on: half a degree below the horizon the sun has set."""


@dataclass(frozen=True, slots=True)
class Reach:
    """Of the time with the sun up: how much of it is beyond the soft limits, of the year and month by month.

    `mean_aoi_deg` is the mean angle between the sun and where the panel can face nearest to it, within the
    limits and with the rows turned back.
    """

    beyond_percent: float
    months_percent: tuple[float, ...]
    mean_aoi_deg: float


def reach(config: TrackerConfig, location: Location, year: int) -> Reach:
    """Return what of a year's sun the tracker can face when all its axes follow."""
    begin, end = (datetime(at, 1, 1, tzinfo=UTC).timestamp() for at in (year, year + 1))
    at_s = np.arange(begin, end, STEP_S, dtype=np.float64)
    sun = sun_path(config.algorithm, location, at_s)
    beyond, aoi_deg = reached(config, sun)
    months = at_s[sun.is_up].astype("datetime64[s]").astype("datetime64[M]").astype(int) % MONTHS_A_YEAR
    beyond, aoi_deg = beyond[sun.is_up], aoi_deg[sun.is_up]
    return Reach(
        beyond_percent=_percent(beyond),
        months_percent=tuple(_percent(beyond[months == month]) for month in range(MONTHS_A_YEAR)),
        mean_aoi_deg=float(aoi_deg.mean()) if aoi_deg.size else 0.0,
    )


def reached(config: TrackerConfig, sun: SunPath) -> tuple[NDArray[np.bool_], Array]:
    """Return for each sun whether it is beyond the soft limits, and the angle of incidence, degrees."""
    height_deg = sun.apparent_elevation_deg if config.refraction else sun.elevation_deg
    held = (config.park.azimuth_deg, config.park.elevation_deg)
    mode = default_mode(config.mount)
    first_deg, second_deg = followed(config.mount, mode, held, (sun.azimuth_deg, height_deg), ARRAY)
    first_reached_deg = _nearest(config.azimuth, first_deg)
    second = second_axis(config)
    second_reached_deg = np.clip(second_deg, second.minimum_deg, second.maximum_deg)
    missed_deg = np.maximum(
        np.abs(_wrapped(first_reached_deg - first_deg)), np.abs(second_reached_deg - second_deg)
    )
    faced = direction(config.mount, first_reached_deg, second_reached_deg, ARRAY)
    return missed_deg > BEYOND_DEG, _apart_deg(faced, (sun.azimuth_deg, height_deg))


def _nearest(axis: AxisConfig, angle_deg: Array) -> Array:
    """Return the equivalent angles nearest to the middle of the range, within the range."""
    middle_deg = (axis.minimum_deg + axis.maximum_deg) / 2.0
    near_deg = middle_deg + _wrapped(angle_deg - middle_deg)
    return np.asarray(np.clip(near_deg, axis.minimum_deg, axis.maximum_deg), dtype=np.float64)


def _wrapped(angle_deg: Array) -> Array:
    return np.asarray((angle_deg + 180.0) % 360.0 - 180.0, dtype=np.float64)


def _apart_deg(a: tuple[Array, Array], b: tuple[Array, Array]) -> Array:
    """Return the angle between directions given as azimuth and elevation."""
    turned = (a[0] - b[0]) * PER_DEGREE
    height_a, height_b = a[1] * PER_DEGREE, b[1] * PER_DEGREE
    cosine = np.sin(height_a) * np.sin(height_b) + np.cos(height_a) * np.cos(height_b) * np.cos(turned)
    return np.asarray(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))), dtype=np.float64)


def _percent(flags: NDArray[np.bool_]) -> float:
    return 100.0 * float(flags.mean()) if flags.size else 0.0
