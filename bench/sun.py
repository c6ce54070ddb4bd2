"""Sun position: PSA, PSA+ and Koblick against pvlib's NREL SPA"""

import timeit
from collections.abc import Callable
from datetime import UTC, datetime

import numpy as np
import pandas as pd
import pvlib

from app.sun.algorithms import PUBLISHED
from app.sun.position import BLOCK, Algorithm, Location, sun_path, sun_position
from bench.table import Row

PLACE = Location(41.2867, 36.33)
AT = datetime(2026, 6, 21, 9, 30, tzinfo=UTC)
MANY = np.linspace(AT.timestamp(), AT.timestamp() + 365 * 86400.0, 200_000)
COMMAND = "python -m bench sun"
LIMIT_NS = {1: 3000.0, len(MANY): 200.0}
BARE_LIMIT_NS = {1: 1000.0, BLOCK: 170.0}
PRECISE = (Algorithm.PSA, Algorithm.PSA_PLUS, Algorithm.KOBLICK)


def measure() -> list[Row]:
    """Measure one position and many, both with refraction, best of several runs."""
    rows = []
    instant, instants = pd.DatetimeIndex([AT]), np.asarray(MANY)
    one_ns = _best_ns(lambda: _spa_one(instant), calls=20)
    many_ns = _best_ns(lambda: _spa_many(instants), calls=1) / len(MANY)
    for algorithm in PRECISE:
        ours_ns = _best_ns(lambda algorithm=algorithm: sun_position(algorithm, PLACE, AT), calls=20_000)
        rows.append(_row(f"{algorithm} one position", ours_ns, one_ns, LIMIT_NS[1]))
        ours_ns = _best_ns(lambda algorithm=algorithm: sun_path(algorithm, PLACE, MANY), calls=2) / len(MANY)
        rows.append(_row(f"{algorithm} {len(MANY):,} positions", ours_ns, many_ns, LIMIT_NS[len(MANY)]))
        rows.extend(_bare(algorithm, one_ns, many_ns))
    return rows


def _bare(algorithm: Algorithm, one_ns: float, many_ns: float) -> list[Row]:
    """Measure the algorithm's own functions: no refraction, no checks; many in one block of the cache."""
    place, block = (PLACE.latitude_deg, PLACE.longitude_deg), MANY[:BLOCK]
    published, at = PUBLISHED[algorithm], AT.timestamp()
    one = _best_ns(lambda: published.one(at, *place), calls=20_000)
    many = _best_ns(lambda: published.many(block, *place), calls=50) / BLOCK
    return [
        _row(f"{algorithm} one position, bare", one, one_ns, BARE_LIMIT_NS[1]),
        _row(f"{algorithm} {BLOCK:,} positions, bare", many, many_ns, BARE_LIMIT_NS[BLOCK]),
    ]


def _spa_one(instant: pd.DatetimeIndex) -> object:
    return pvlib.solarposition.spa_python(instant, PLACE.latitude_deg, PLACE.longitude_deg)


def _spa_many(instants: np.ndarray) -> object:
    place = (PLACE.latitude_deg, PLACE.longitude_deg, 0.0)
    return pvlib.spa.solar_position_numpy(instants, *place, 1010.0, 10.0, 69.0, 0.5667, 1)


def _best_ns(call: Callable[[], object], calls: int) -> float:
    return min(timeit.repeat(call, number=calls, repeat=5)) / calls * 1e9


def _row(name: str, ours_ns: float, peer_ns: float, limit_ns: float) -> Row:
    ours = f"{ours_ns:,.0f} ns (at most {limit_ns:,.0f})"
    return Row(name, ours, f"pvlib SPA {peer_ns:,.0f} ns", f"1 : {peer_ns / ours_ns:,.0f}", COMMAND)
