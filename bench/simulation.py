"""Simulated days and shows: the real controller on a virtual clock"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from time import process_time

import numpy as np

from app.show.simulate import simulate, simulate_show
from app.sun.position import Location, sun_path
from app.tracker.memory.memory import Pointing
from app.tracker.programs.show import ShowPlan
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.values.mode import Mode
from bench.table import Row, at_most, beside

SAMSUN = Location(41.2867, 36.33, 4.0)
CONFIG = TrackerConfig("T1", "Tracker 1")
DAY_LIMIT_S = 0.7
MIDNIGHT = datetime(2026, 6, 20, 21, tzinfo=UTC)
COMMAND = "python -m bench simulation"


@dataclass(frozen=True, slots=True)
class Size:
    """How often each is run, how much of the day, and how long the simulated show is."""

    repeats: int = 3
    hours: int = 24
    show: timedelta = timedelta(minutes=3)


SMALL = Size(repeats=1, hours=1, show=timedelta(minutes=3))


def measure(size: Size = Size()) -> list[Row]:
    """Measure a day at 1 s ticks beside the bare loop of the same mathematics, and a show at 10 Hz."""
    plan, repeats = _plan(size.show), size.repeats
    day_s = _best(lambda: _day(size.hours), repeats)
    bare_s = _best(lambda: _bare_day(size.hours), repeats)
    show_s = _best(lambda: simulate_show(CONFIG, Pointing(), "Europe/Istanbul", plan), repeats)
    day = f"{size.hours} hours of one tracker at 1 s ticks, processor time"
    return [
        at_most(day, day_s, DAY_LIMIT_S, "s", COMMAND),
        beside(day, f"{day_s:.2f} s", f"bare loop {bare_s:.2f} s", bare_s / day_s, COMMAND),
        beside(
            f"a show of {size.show.total_seconds():g} s at 10 Hz, processor time", f"{show_s:.2f} s",
            "its duration", size.show.total_seconds() / show_s, COMMAND,
        ),
    ]  # fmt: skip


def _best(work: Callable[[], object], repeats: int) -> float:
    """Return the least processor time of a few runs, seconds: other programs do not count."""
    times = []
    for _ in range(repeats):
        begun = process_time()
        work()
        times.append(process_time() - begun)
    return min(times)


def _day(hours: int) -> object:
    held, end = Orientation(180.0, 45.0), MIDNIGHT + timedelta(hours=hours)
    return simulate(CONFIG, Pointing(), SAMSUN, "Europe/Istanbul", Mode.DUAL, held, MIDNIGHT, end)


def _plan(lasts: timedelta) -> ShowPlan:
    begin = datetime(2026, 6, 21, 2, 10, tzinfo=UTC)
    return ShowPlan("solstice", begin, begin + timedelta(hours=15), lasts, SAMSUN)


def _bare_day(hours: int) -> float:
    """Sun, deadband and two trapezoidal axes in one plain loop: no faults, no trust, no records."""
    begin = MIDNIGHT.timestamp()
    path = sun_path(CONFIG.algorithm, SAMSUN, begin + np.arange(3600.0 * hours + 1.0))
    azimuth_deg = elevation_deg = turned_deg = 0.0
    for sun_azimuth_deg, sun_elevation_deg in zip(
        path.azimuth_deg.tolist(), path.apparent_elevation_deg.tolist(), strict=True
    ):
        wanted_deg = max(0.0, sun_elevation_deg)
        if _apart_deg(azimuth_deg, elevation_deg, sun_azimuth_deg, wanted_deg) < 0.5:
            continue
        step_deg = max(-6.0, min(6.0, sun_azimuth_deg - azimuth_deg))
        azimuth_deg += step_deg
        elevation_deg += max(-4.0, min(4.0, wanted_deg - elevation_deg))
        turned_deg += abs(step_deg)
    return turned_deg


def _apart_deg(
    azimuth_deg: float, elevation_deg: float, to_azimuth_deg: float, to_elevation_deg: float
) -> float:
    a, b = math.radians(elevation_deg), math.radians(to_elevation_deg)
    half = math.radians(azimuth_deg - to_azimuth_deg) / 2
    return 2 * math.degrees(
        math.asin(math.sqrt(math.sin((a - b) / 2) ** 2 + math.cos(a) * math.cos(b) * math.sin(half) ** 2))
    )
