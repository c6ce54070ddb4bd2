"""Compiled loops (the extra `fast`): the sun, a park's closed loop, a year of four modes

The peers run in the same run, pvlib's compiled SPA in a process of its own: pvlib recompiles when both of its
forms are used in one. sg2 (Blanc and Wald 2012) is measured where it is installed (`pip install sg2`).
"""

import importlib
import importlib.util
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from time import perf_counter
from timeit import repeat

import numpy as np
import pandas as pd
import pvlib

from app.fast.compare import year_whm2
from app.fast.comparison import ClearSky
from app.fast.directions import directions
from app.fast.park import park_day
from app.fast.spa_table import build
from app.fast.sun import psa_plus_angles, spa_angles
from app.sun import fast
from app.sun.position import Algorithm, Location, sun_path
from app.sun.trigonometry import Array
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.values.mode import Mode
from bench.table import Row, at_most, beside

COMMAND = "python -m bench fast"
PLACE, HELD = Location(41.2867, 36.33, 50.0), Orientation(180.0, 55.0)
YEAR = 2026
BEGIN_S = datetime(YEAR, 1, 1, tzinfo=UTC).timestamp()
SPAN_S = 365 * 86_400.0 - 1.0
COMPILED_SPA = f"""
import os
os.environ["PVLIB_USE_NUMBA"] = "1"
import time
import numpy as np
from pvlib import spa
at = np.linspace({{begin}}, {{end}}, {{fewer}})
def call():
    begun = time.perf_counter()
    spa.solar_position_numba(at, {PLACE.latitude_deg}, {PLACE.longitude_deg}, 50.0, 1010.0, 10, 69, 0.57, 1)
    return time.perf_counter() - begun
call()
print(min(call() for _ in range(3)) / len(at) * 1e9)
"""


@dataclass(frozen=True, slots=True)
class Size:
    """How many positions, how many of them by slow peers, how many trackers, how often each is run."""

    positions: int = 1_000_000
    fewer: int = 200_000
    trackers: int = 1000
    rounds: int = 5


SMALL = Size(positions=2000, fewer=100, trackers=2, rounds=1)


def measure(size: Size = Size()) -> list[Row]:
    """Measure each, best of several runs."""
    return [*_sun(size), *_park(size), *_year(size)]


def _sun(size: Size) -> list[Row]:
    at = np.linspace(BEGIN_S, BEGIN_S + SPAN_S, size.positions)
    program = COMPILED_SPA.format(begin=at[0], end=at[-1], fewer=size.fewer)
    spa_ns = float(subprocess.run([sys.executable, "-c", program], capture_output=True, check=True).stdout)
    peers = [("pvlib SPA, numba", spa_ns)]
    if importlib.util.find_spec("sg2"):
        peers.append(("sg2", _sg2_ns(at, size)))
    table, many = build(at[0], at[-1]), f"{len(at):,} positions"
    building_ns = _ns(lambda: build(at[0], at[-1]), len(at), size.rounds)
    read_ns = _ns(lambda: spa_angles(table, PLACE, at), len(at), size.rounds)
    numpy_ns = _ns(lambda: sun_path(Algorithm("psa-plus"), PLACE, at), len(at), size.rounds)
    psa_ns = _ns(lambda: psa_plus_angles(PLACE, at), len(at), size.rounds)
    place = (PLACE.latitude_deg, PLACE.longitude_deg)
    one_ns = _ns(lambda: [fast.psa(BEGIN_S, *place) for _ in range(size.fewer)], size.fewer, size.rounds)
    return [
        *_against(f"PSA+ in NumPy, refraction included, {many}", numpy_ns, 160.0, peers),
        *_against(f"PSA+ compiled, {many}", psa_ns, 5.0, peers),
        *_against(f"SPA read from its table, compiled, {many}", read_ns, 3.0, peers),
        *_against(f"SPA by its table, its building included, {many}", read_ns + building_ns, None, peers),
        at_most("PSA, one position in plain Python", one_ns, 1000.0, "ns", COMMAND),
    ]


def _against(name: str, ours_ns: float, bound_ns: float | None, peers: list[tuple[str, float]]) -> list[Row]:
    bound = [] if bound_ns is None else [at_most(name, ours_ns, bound_ns, "ns", COMMAND)]
    ours = f"{ours_ns:,.1f} ns"
    return bound + [beside(name, ours, f"{who} {ns:,.0f} ns", ns / ours_ns, COMMAND) for who, ns in peers]


def _sg2_ns(every: Array, size: Size) -> float:
    sg2 = importlib.import_module("sg2")
    place = np.array([[PLACE.longitude_deg, PLACE.latitude_deg, PLACE.altitude_m]])
    at = (every[:: len(every) // size.fewer] * 1000.0).astype("datetime64[ms]")
    return _ns(lambda: sg2.sun_position(place, at, ["topoc.gamma_S0", "topoc.alpha_S"]), len(at), size.rounds)


def _park(size: Size) -> list[Row]:
    config = TrackerConfig("T1", "Tracker 1")
    seconds = datetime(YEAR, 6, 20, 21, tzinfo=UTC).timestamp() + np.arange(86_400.0)
    random = np.random.default_rng(1)
    deadbands_deg = random.uniform(0.3, 1.0, size.trackers)
    offsets_deg = random.normal(0.0, 0.5, (2, size.trackers))

    def day() -> None:
        aims = directions(config, Mode.DUAL, HELD, PLACE, seconds)
        park_day(
            config,
            aims,
            deadband_deg=deadbands_deg,
            azimuth_offset_deg=offsets_deg[0],
            elevation_offset_deg=offsets_deg[1],
        )

    def angles() -> None:
        sun = _sun_of(seconds)
        for _ in range(size.trackers):
            pvlib.tracking.singleaxis(*sun)

    took_s = _ns(day, 1, size.rounds) / 1e9
    spa_s = _ns(angles, 1, 1) / 1e9
    name = f"{size.trackers:,} tracker-days, closed loop, a tick a second, one core"
    a_tick_ns = took_s / size.trackers / 86_400 * 1e9
    told = f"{took_s:.2f} s ({a_tick_ns:.1f} ns a tick)"
    peer = f"pvlib's single axis for as many, angles alone {spa_s:.1f} s"
    return [
        at_most(name, took_s, 0.4 * size.trackers / 1000.0, "s", COMMAND, ours=told),
        beside(name, told, peer, spa_s / took_s, COMMAND),
    ]


def _sun_of(at_unix_s: Array) -> tuple[Array, Array]:
    path = sun_path(Algorithm.PSA, PLACE, at_unix_s)
    return 90.0 - path.apparent_elevation_deg, path.azimuth_deg


def _year(size: Size) -> list[Row]:
    sky = ClearSky(PLACE.altitude_m)
    ours_s = _ns(lambda: year_whm2(PLACE, YEAR, HELD, sky), 1, size.rounds) / 1e9
    times = pd.date_range(f"{YEAR}-01-01", f"{YEAR + 1}-01-01", freq="1min", tz="UTC", inclusive="left")
    begun = perf_counter()
    theirs = _pvlib_whm2(times, sky)
    theirs_s = perf_counter() - begun
    ours = year_whm2(PLACE, YEAR, HELD, sky)
    off = max(abs(ours[mode] / theirs[mode] - 1.0) for mode in ours)
    name = f"a year of four modes at one minute, the table of the sun included ({off:.0e} off pvlib)"
    peer = f"pvlib pipeline, NumPy {theirs_s:.1f} s"
    return [
        at_most(name, ours_s, 0.05, "s", COMMAND),
        beside(name, f"{ours_s:.3f} s", peer, theirs_s / ours_s, COMMAND),
    ]


def _pvlib_whm2(times: pd.DatetimeIndex, sky: ClearSky) -> dict[Mode, float]:
    sun = pvlib.solarposition.get_solarposition(
        times,
        PLACE.latitude_deg,
        PLACE.longitude_deg,
        PLACE.altitude_m,
        pressure=101_000.0,
        temperature=10.0,
    )
    relative = pvlib.atmosphere.get_relative_airmass(sun.apparent_zenith)
    mass = pvlib.atmosphere.get_absolute_airmass(relative, pvlib.atmosphere.alt2pres(PLACE.altitude_m))
    outside = pvlib.irradiance.get_extra_radiation(times.day_of_year.to_numpy())
    air = pvlib.clearsky.ineichen(
        sun.apparent_zenith, mass, sky.linke_turbidity, PLACE.altitude_m, dni_extra=outside
    )
    tilt, lifted = 90.0 - HELD.elevation_deg, sun.apparent_zenith.clip(0.0, 90.0)
    panels = {
        Mode.FIXED: (tilt, HELD.azimuth_deg),
        Mode.AZIMUTH: (tilt, sun.azimuth),
        Mode.ELEVATION: (lifted, HELD.azimuth_deg),
        Mode.DUAL: (lifted, sun.azimuth),
    }
    return {mode: _plane_whm2(sun, air, outside, sky, panel) for mode, panel in panels.items()}


def _plane_whm2(
    sun: pd.DataFrame, air: pd.DataFrame, outside: Array, sky: ClearSky, panel: tuple[object, object]
) -> float:
    plane = pvlib.irradiance.get_total_irradiance(
        *panel,
        sun.apparent_zenith,
        sun.azimuth,
        air.dni,
        air.ghi,
        air.dhi,
        dni_extra=outside,
        albedo=sky.albedo,
        model="haydavies",
    )
    return float(plane.poa_global.where(sun.apparent_elevation > 0.0).sum() / 60.0)


def _ns(call: Callable[[], object], count: int, rounds: int) -> float:
    """Return nanoseconds for each of `count` things of a call, best of several after one to compile."""
    call()
    return min(repeat(call, number=1, repeat=rounds)) / count * 1e9
