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
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np

from app.sun.trigonometry import Array

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
    """Return what `position` does, for one instant."""
    azimuth_deg, elevation_deg = position(np.array([unix_s]), latitude_deg, longitude_deg)
    return float(azimuth_deg[0]), float(elevation_deg[0])


@cache
def _solar_position(package: str = "pvlib") -> Many:
    """Load pvlib's spa.py by its path, without the package around it."""
    found = importlib.util.find_spec(package)
    if found is None or found.origin is None:
        raise AlgorithmMissing("NREL SPA needs pvlib: install it (pip install pvlib), or choose PSA+.")
    spec = importlib.util.spec_from_file_location("pvlib_spa_alone", Path(found.origin).with_name("spa.py"))
    if spec is None or spec.loader is None:
        raise AlgorithmMissing("The installed pvlib has no spa.py: install pvlib 0.16, or choose PSA+.")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    calculate: Many = module.solar_position_numpy
    return calculate
