"""Sun position: PSA, PSA+ and Koblick against pvlib's NREL SPA"""

import timeit
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime

import numpy as np
import pandas as pd
import pvlib

from app.sun.algorithms import PUBLISHED
from app.sun.position import BLOCK, Algorithm, Location, sun_path, sun_position
from app.sun.trigonometry import Array
from bench.table import Row, at_most, beside

PLACE = Location(41.2867, 36.33)
AT = datetime(2026, 6, 21, 9, 30, tzinfo=UTC)
COMMAND = "python -m bench sun"
ONE_LIMIT_NS, MANY_LIMIT_NS, BARE_LIMIT_NS = 3000.0, 200.0, 1000.0
BLOCK_LIMIT_NS = 160.0
PRECISE = (Algorithm.PSA, Algorithm.PSA_PLUS, Algorithm.KOBLICK)


@dataclass(frozen=True, slots=True)
class Size:
    """How many positions at once, and how often one alone."""

    many: int = 200_000
    calls: int = 20_000


SMALL = Size(many=BLOCK, calls=20)


def measure(size: Size = Size()) -> list[Row]:
    """Measure one position and many, both with refraction, best of several runs."""
    instant = pd.DatetimeIndex([AT])
    many = np.linspace(AT.timestamp(), AT.timestamp() + 365 * 86400.0, size.many)
    one_ns = _best_ns(lambda: _spa_one(instant), calls=max(1, size.calls // 1000))
    many_ns = _best_ns(lambda: _spa_many(many), calls=1) / len(many)
    return [
        row
        for algorithm in PRECISE
        for row in (*_whole(algorithm, many, size, one_ns, many_ns), *_bare(algorithm, many, size))
    ]


def _whole(algorithm: Algorithm, many: Array, size: Size, one_ns: float, many_ns: float) -> list[Row]:
    """Measure what the product calls, beside pvlib's SPA."""
    ours_one_ns = _best_ns(lambda: sun_position(algorithm, PLACE, AT), calls=size.calls)
    ours_many_ns = _best_ns(lambda: sun_path(algorithm, PLACE, many), calls=2) / len(many)
    one, all_of_them = f"{algorithm} one position", f"{algorithm} {len(many):,} positions"
    return [
        at_most(one, ours_one_ns, ONE_LIMIT_NS, "ns", COMMAND),
        _against(one, ours_one_ns, one_ns),
        at_most(all_of_them, ours_many_ns, MANY_LIMIT_NS, "ns", COMMAND),
        _against(all_of_them, ours_many_ns, many_ns),
    ]


def _bare(algorithm: Algorithm, many: Array, size: Size) -> list[Row]:
    """Measure the algorithm's own functions: no refraction, no checks; many in one block of the cache."""
    place, block = (PLACE.latitude_deg, PLACE.longitude_deg), many[:BLOCK]
    published, at = PUBLISHED[algorithm], AT.timestamp()
    one_ns = _best_ns(lambda: published.one(at, *place), calls=size.calls)
    block_ns = _best_ns(lambda: published.many(block, *place), calls=50) / BLOCK
    return [
        at_most(f"{algorithm} one position, bare", one_ns, BARE_LIMIT_NS, "ns", COMMAND),
        at_most(f"{algorithm} {BLOCK:,} positions, bare", block_ns, BLOCK_LIMIT_NS, "ns", COMMAND),
    ]


def _spa_one(instant: pd.DatetimeIndex) -> object:
    return pvlib.solarposition.spa_python(instant, PLACE.latitude_deg, PLACE.longitude_deg)


def _spa_many(instants: Array) -> object:
    place = (PLACE.latitude_deg, PLACE.longitude_deg, 0.0)
    return pvlib.spa.solar_position_numpy(instants, *place, 1010.0, 10.0, 69.0, 0.5667, 1)


def _best_ns(call: Callable[[], object], calls: int) -> float:
    return min(timeit.repeat(call, number=calls, repeat=5)) / calls * 1e9


def _against(name: str, ours_ns: float, peer_ns: float) -> Row:
    return beside(name, f"{ours_ns:,.0f} ns", f"pvlib SPA {peer_ns:,.0f} ns", peer_ns / ours_ns, COMMAND)
