"""NREL SPA: Reda and Andreas, "Solar position algorithm for solar radiation applications" (2004), by pvlib.

Solar Energy 76, 577-589, doi:10.1016/j.solener.2003.12.003. Of pvlib only the file of this algorithm is
loaded, and only when it is first needed: it needs NumPy alone and is ready in 2 ms, where the whole package
takes a second and brings pandas.

SPA wants terrestrial time: UT plus delta T. Delta T is interpolated between measured values and held from
2025 on: it has stood still since 2017, and the usual polynomials (Espenak and Meeus) overshoot, 75 s for
2026 and 92 s for 2049. One second of it is worth 0.00001 degrees.
"""

import importlib.util
from collections.abc import Callable
from functools import cache, lru_cache
from math import cos, sin
from operator import mul
from pathlib import Path
from typing import Final

import numpy as np

from app.base.message import N_
from app.sun.psa import horizontal
from app.sun.trigonometry import PER_DEGREE, PER_RADIAN, SCALAR, Array

Many = Callable[..., tuple[Array, ...]]

SEA_LEVEL_M: Final = 0.0
PRESSURE_HPA: Final = 1010.0
TEMPERATURE_DEGC: Final = 10.0
REFRACTION_AT_HORIZON_DEG: Final = 0.5667
THREADS: Final = 1

DELTA_T = (
    (1900, -2.8),
    (1910, 10.5),
    (1920, 21.2),
    (1930, 24.0),
    (1940, 24.3),
    (1950, 29.1),
    (1960, 33.1),
    (1970, 40.2),
    (1980, 50.5),
    (1990, 56.9),
    (2000, 63.8),
    (2005, 64.7),
    (2010, 66.1),
    (2015, 67.6),
    (2020, 69.4),
    (2025, 69.1),
)
"""Year and measured delta T in seconds: NASA, "Delta T: historical values", and IERS from 2010 on."""

YEAR_S: Final = 31_556_952.0
"""A mean Gregorian year."""

SPAN_S: Final = 600.0
TURN_DPS: Final = 360.0 / 86_400.0


class AlgorithmMissing(ValueError):
    """An algorithm whose library is not installed."""


def delta_t_s(unix_s: Array) -> Array:
    """Return terrestrial time minus UT at each instant, seconds."""
    years, seconds = zip(*DELTA_T, strict=True)
    return np.asarray(np.interp(1970.0 + unix_s / YEAR_S, years, seconds), dtype=np.float64)


def position(unix_s: Array, latitude_deg: float, longitude_deg: float) -> tuple[Array, Array]:
    """Return azimuth from north clockwise in [0, 360] and true elevation at sea level, degrees.

    Latitude north, longitude east positive. Raises `AlgorithmMissing` where pvlib is not installed.
    """
    place = (latitude_deg, longitude_deg, SEA_LEVEL_M)
    air = (PRESSURE_HPA, TEMPERATURE_DEGC)
    found = _solar_position()(unix_s, *place, *air, delta_t_s(unix_s), REFRACTION_AT_HORIZON_DEG, THREADS)
    return found[4], found[3]


def position_of_one(unix_s: float, latitude_deg: float, longitude_deg: float) -> tuple[float, float]:
    """Return what `position` does, within 5e-7 degrees, for one instant; azimuth in (-180, 180].

    Instants that follow each other cost microseconds: through four nodes, ten minutes apart, hour angle and
    declination run on a cubic. What is interpolated is smooth: the Earth's even turn is taken out.
    The difference is not the cubic's: a Julian day in double precision counts time in steps of 40 us.
    """
    span = unix_s // SPAN_S
    begin_s = span * SPAN_S
    lags_deg, declinations_deg = _nodes(begin_s, latitude_deg, longitude_deg)
    weights = _cubic((unix_s - begin_s) / SPAN_S)
    angle_deg = sum(map(mul, weights, lags_deg)) + (unix_s - begin_s) * TURN_DPS
    declination_deg = sum(map(mul, weights, declinations_deg))
    zenith, azimuth = horizontal(declination_deg * PER_DEGREE, angle_deg * PER_DEGREE, latitude_deg, SCALAR)
    return azimuth * PER_RADIAN, 90.0 - zenith * PER_RADIAN


@lru_cache(maxsize=256)
def _nodes(begin_s: float, latitude_deg: float, longitude_deg: float) -> tuple[list[float], list[float]]:
    """Return hour angle less the Earth's turn since `begin_s`, and declination, at four instants, degrees."""
    after_s = np.array([-SPAN_S, 0.0, SPAN_S, 2.0 * SPAN_S])
    azimuth_deg, elevation_deg = position(begin_s + after_s, latitude_deg, longitude_deg)
    azimuth, elevation = azimuth_deg * PER_DEGREE, elevation_deg * PER_DEGREE
    sin_lat, cos_lat = sin(latitude_deg * PER_DEGREE), cos(latitude_deg * PER_DEGREE)
    north, up = np.cos(elevation) * np.cos(azimuth), np.sin(elevation)
    equator, pole = up * cos_lat - north * sin_lat, north * cos_lat + up * sin_lat
    west = -np.cos(elevation) * np.sin(azimuth)
    lag_deg = np.arctan2(west, equator) * PER_RADIAN - after_s * TURN_DPS
    lag_deg = lag_deg[1] + np.mod(lag_deg - lag_deg[1] + 180.0, 360.0) - 180.0
    return lag_deg.tolist(), (np.arctan2(pole, np.hypot(west, equator)) * PER_RADIAN).tolist()


def _cubic(u: float) -> tuple[float, float, float, float]:
    """Return the weights of values at -1, 0, 1 and 2 in the cubic through them, at `u`."""
    before, after, beyond = u + 1.0, u - 1.0, u - 2.0
    return (
        -u * after * beyond / 6.0,
        before * after * beyond / 2.0,
        -before * u * beyond / 2.0,
        before * u * after / 6.0,
    )


@cache
def _solar_position(package: str = "pvlib") -> Many:
    """Load pvlib's spa.py by its path, without the package around it."""
    found = importlib.util.find_spec(package)
    if found is None or found.origin is None:
        raise AlgorithmMissing(N_("NREL SPA needs pvlib: install it (pip install pvlib), or choose PSA+."))
    spec = importlib.util.spec_from_file_location("pvlib_spa_alone", Path(found.origin).with_name("spa.py"))
    if spec is None or spec.loader is None:
        raise AlgorithmMissing(N_("The installed pvlib has no spa.py: install pvlib 0.16, or choose PSA+."))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    calculate: Many = module.solar_position_numpy
    return calculate
