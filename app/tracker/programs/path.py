"""Where both axes must be while the sun is up, sampled over sun time: what no speed changes about a show.

The azimuth axis has end stops, so the same direction can be reached at several axis angles, 360 degrees apart
(branches). Each stretch of sun takes the branch that lasts longest, which makes the fewest unwindings.
"""

from dataclasses import dataclass
from datetime import datetime
from itertools import pairwise
from math import ceil, floor

import numpy as np
from numpy.typing import NDArray

from app.sun.events import crossings
from app.sun.position import SunPath, sun_path, sun_position
from app.sun.trigonometry import ARRAY, Array
from app.tracker.axes import AxisConfig
from app.tracker.config import TrackerConfig
from app.tracker.memory import Pointing
from app.tracker.mode import Mode
from app.tracker.mount import to_axes
from app.tracker.programs.plan import ShowPlan

SAMPLE_S = 10.0
FEWEST_SAMPLES = 50
EDGE_DEG = 1e-6


@dataclass(frozen=True, slots=True)
class Stretch:
    """One stretch of sun: columns over equal steps of sun time, from `begin_s` to `end_s` (unix seconds).

    `azimuth_deg` (continuous) and `elevation_deg` are axis angles without limits; adding `turns` whole turns
    gives the branch of the azimuth axis. What the axes are asked for is `axis_azimuth_deg` and
    `axis_elevation_deg`, inside the soft limits.
    """

    begin_s: float
    end_s: float
    sun_elevation_deg: Array
    azimuth_deg: Array
    elevation_deg: Array
    turns: NDArray[np.int64]
    axis_azimuth_deg: Array
    axis_elevation_deg: Array

    @property
    def step_s(self) -> float:
        """Return the sun time between two samples."""
        return (self.end_s - self.begin_s) / (len(self.turns) - 1)

    @property
    def missed_deg(self) -> Array:
        """Return by how much the soft limits keep the axes from the direction, the larger of the two."""
        azimuth_deg = np.abs(self.azimuth_deg + 360.0 * self.turns - self.axis_azimuth_deg)
        return np.maximum(azimuth_deg, np.abs(self.elevation_deg - self.axis_elevation_deg))


def stretches(plan: ShowPlan, tracker: TrackerConfig, pointing: Pointing) -> tuple[Stretch, ...]:
    """Return the plan's stretches of sun in order; each begins near where the axis was left by the last."""
    near_deg = (tracker.azimuth.minimum_deg + tracker.azimuth.maximum_deg) / 2.0
    found: list[Stretch] = []
    for begin, end in sun_up(plan):
        stretch = _stretch(plan, tracker, pointing, (begin.timestamp(), end.timestamp()), near_deg)
        near_deg = float(stretch.axis_azimuth_deg[-1])
        found.append(stretch)
    return tuple(found)


def sun_up(plan: ShowPlan) -> tuple[tuple[datetime, datetime], ...]:
    """Return when the sun is up (upper limb above the horizon) within the plan, in order."""
    turns = crossings(plan.algorithm, plan.location, plan.begin_at, plan.end_at)
    instants = [plan.begin_at, *(turn.at for turn in turns), plan.end_at]
    up = sun_position(plan.algorithm, plan.location, plan.begin_at).is_up
    spans = []
    for begin, end in pairwise(instants):
        if up and end > begin:
            spans.append((begin, end))
        up = not up
    return tuple(spans)


def _stretch(
    plan: ShowPlan, tracker: TrackerConfig, pointing: Pointing, span_s: tuple[float, float], near_deg: float
) -> Stretch:
    count = max(FEWEST_SAMPLES, ceil((span_s[1] - span_s[0]) / SAMPLE_S)) + 1
    sun = sun_path(plan.algorithm, plan.location, np.linspace(*span_s, count))
    azimuth_deg, elevation_deg = to_axes(pointing, *_directions(plan, sun), ARRAY)
    azimuth_deg = np.unwrap(azimuth_deg, period=360.0)
    turns = branches(tracker.azimuth, azimuth_deg, near_deg)
    return Stretch(
        *span_s,
        sun.elevation_deg,
        azimuth_deg,
        elevation_deg,
        turns,
        _clip(tracker.azimuth, azimuth_deg + 360.0 * turns),
        _clip(tracker.elevation, elevation_deg),
    )


def _directions(plan: ShowPlan, sun: SunPath) -> tuple[Array, Array]:
    """Return `mount.mode_direction` for many instants."""
    azimuth_deg = sun.azimuth_deg
    elevation_deg = sun.apparent_elevation_deg if plan.refraction else sun.elevation_deg
    if plan.mode in (Mode.FIXED, Mode.ELEVATION):
        azimuth_deg = np.full_like(azimuth_deg, plan.orientation.azimuth_deg)
    if plan.mode in (Mode.FIXED, Mode.AZIMUTH):
        elevation_deg = np.full_like(elevation_deg, plan.orientation.elevation_deg)
    return azimuth_deg, elevation_deg


def branches(axis: AxisConfig, azimuth_deg: Array, near_deg: float) -> NDArray[np.int64]:
    """Return for each sample of a continuous azimuth the whole turns to add, with the fewest changes.

    At the start and whenever a branch ends, the branch that lasts longest is taken; of equals the one
    nearest to where the axis is. A direction that no branch reaches ends none.
    """
    lowest = floor((axis.minimum_deg - float(azimuth_deg.max())) / 360.0)
    highest = ceil((axis.maximum_deg - float(azimuth_deg.min())) / 360.0)
    offers = np.arange(lowest, highest + 1)
    angles_deg = azimuth_deg + 360.0 * offers[:, np.newaxis]
    inside = (angles_deg >= axis.minimum_deg - EDGE_DEG) & (angles_deg <= axis.maximum_deg + EDGE_DEG)
    lasts = inside | ~inside.any(axis=0)
    turns = np.empty(len(azimuth_deg), dtype=np.int64)
    first = 0
    while first < len(turns):
        ends = [_end(row, first) for row in lasts]
        distances = np.abs(np.clip(angles_deg[:, first], axis.minimum_deg, axis.maximum_deg) - near_deg)
        best = min(range(len(offers)), key=lambda i: (-ends[i], distances[i]))
        turns[first : ends[best]] = offers[best]
        first = ends[best]
        near_deg = axis.clamp(float(angles_deg[best, first - 1]))
    return turns


def _end(lasts: NDArray[np.bool_], first: int) -> int:
    """Return the index behind the run of true values that begins at `first`."""
    gaps = np.flatnonzero(~lasts[first:])
    return first + int(gaps[0]) if gaps.size else len(lasts)


def _clip(axis: AxisConfig, angle_deg: Array) -> Array:
    return np.clip(angle_deg, axis.minimum_deg, axis.maximum_deg)
