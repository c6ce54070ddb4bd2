"""Where both axes must be while the sun is up, sampled over sun time: what no speed changes about a show.

The azimuth axis has end stops, so the same direction can be reached at several axis angles, 360 degrees apart
(branches). Each stretch of sun takes the branch that lasts longest, which makes the fewest unwindings. Where
the sun is beyond an end stop for less time than unwinding takes, the axis waits at the stop instead.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from itertools import pairwise
from math import ceil, floor

import numpy as np
from numpy.typing import NDArray

from app.sun.events import crossings
from app.sun.position import sun_path, sun_position
from app.sun.trigonometry import ARRAY, Array
from app.tracker.memory.memory import Pointing
from app.tracker.mounts.kinematics import along_deg, direction, followed
from app.tracker.mounts.mount import second_axis, to_axes
from app.tracker.programs.plan import ShowPlan
from app.tracker.settings.axes import AxisConfig
from app.tracker.settings.config import MountConfig, TrackerConfig

SAMPLE_S = 10.0
FEWEST_SAMPLES = 50
EDGE_DEG = 1e-6
FARTHEST_BEYOND_DEG = 15.0


@dataclass(frozen=True, slots=True)
class Samples:
    """One stretch of sun: columns over equal steps of sun time, from `begin_s` to `end_s` (unix seconds).

    `azimuth_deg` (continuous) and `elevation_deg` are angles of first and second axis without limits;
    `sun_along_deg` is how far the sun lies along the first axis (its elevation, where that axis is upright).
    """

    begin_s: float
    end_s: float
    sun_along_deg: Array
    azimuth_deg: Array
    elevation_deg: Array

    @property
    def step_s(self) -> float:
        """Return the sun time between two samples."""
        return (self.end_s - self.begin_s) / (len(self.azimuth_deg) - 1)


@dataclass(frozen=True, slots=True)
class Stretch:
    """What the axes are asked for over one stretch of sun, inside the soft limits, a column each.

    `turns` whole turns added to the continuous azimuth give the branch of the azimuth axis.
    """

    samples: Samples
    turns: NDArray[np.int64]
    azimuth_deg: Array
    elevation_deg: Array

    @property
    def missed_deg(self) -> Array:
        """Return by how much the soft limits keep the axes from the direction, the larger of the two."""
        azimuth_deg = np.abs(self.samples.azimuth_deg + 360.0 * self.turns - self.azimuth_deg)
        return np.maximum(azimuth_deg, np.abs(self.samples.elevation_deg - self.elevation_deg))


def sampled(plan: ShowPlan, mount: MountConfig, pointing: Pointing) -> tuple[Samples, ...]:
    """Return the plan's stretches of sun in order."""
    return tuple(
        _samples(plan, mount, pointing, begin.timestamp(), end.timestamp()) for begin, end in sun_up(plan)
    )


def stretches(path: Sequence[Samples], tracker: TrackerConfig, unwinding_s: float) -> tuple[Stretch, ...]:
    """Return what the axes are asked for; each stretch begins near where the azimuth axis was left.

    `unwinding_s` is how much sun time one turn of the azimuth axis takes.
    """
    axis = tracker.azimuth
    near_deg = (axis.minimum_deg + axis.maximum_deg) / 2.0
    found: list[Stretch] = []
    for samples in path:
        turns = branches(axis, samples.azimuth_deg, near_deg, int(unwinding_s / samples.step_s))
        azimuth_deg = _clip(axis, samples.azimuth_deg + 360.0 * turns)
        elevation_deg = _clip(second_axis(tracker), samples.elevation_deg)
        found.append(Stretch(samples, turns, azimuth_deg, elevation_deg))
        near_deg = float(azimuth_deg[-1])
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


def _samples(plan: ShowPlan, mount: MountConfig, pointing: Pointing, begin_s: float, end_s: float) -> Samples:
    count = max(FEWEST_SAMPLES, ceil((end_s - begin_s) / SAMPLE_S)) + 1
    sun = sun_path(plan.algorithm, plan.location, np.linspace(begin_s, end_s, count))
    height_deg = sun.apparent_elevation_deg if plan.refraction else sun.elevation_deg
    held = (plan.orientation.azimuth_deg, plan.orientation.elevation_deg)
    angles_deg = followed(mount, plan.mode, held, (sun.azimuth_deg, height_deg), ARRAY)
    along = along_deg(mount, sun.azimuth_deg, sun.elevation_deg, ARRAY)
    azimuth_deg, elevation_deg = to_axes(mount, pointing, *direction(mount, *angles_deg, ARRAY), ARRAY)
    azimuth_deg = np.unwrap(azimuth_deg, period=360.0)
    return Samples(begin_s, end_s, along, azimuth_deg, elevation_deg)


def branches(axis: AxisConfig, azimuth_deg: Array, near_deg: float, patience: int = 0) -> NDArray[np.int64]:
    """Return for each sample of a continuous azimuth the whole turns to add, with the fewest changes.

    At the start and whenever a branch ends, the branch that lasts longest is taken; of equals the one that is
    less often beyond its end stop, then the one nearest to where the axis is. A branch does not end where no
    other reaches the direction either, nor by being beyond its end stop for at most `patience` samples and 15
    degrees.
    """
    lowest = floor((axis.minimum_deg - float(azimuth_deg.max())) / 360.0)
    highest = ceil((axis.maximum_deg - float(azimuth_deg.min())) / 360.0)
    offers = np.arange(lowest, highest + 1)
    angles_deg = azimuth_deg + 360.0 * offers[:, np.newaxis]
    beyond_deg = np.maximum(axis.minimum_deg - angles_deg, angles_deg - axis.maximum_deg)
    outside = beyond_deg > EDGE_DEG
    ends = outside & ~outside.all(axis=0)
    for row, row_deg in zip(ends, beyond_deg, strict=True):
        _bear(row, row_deg, patience)
    turns = np.empty(len(azimuth_deg), dtype=np.int64)
    first = 0
    while first < len(turns):
        best = _longest(ends, outside, np.abs(angles_deg[:, first] - near_deg), first)
        last = _end(ends[best], first)
        turns[first:last] = offers[best]
        near_deg = axis.clamp(float(angles_deg[best, last - 1]))
        first = last
    return turns


def _bear(ends: NDArray[np.bool_], beyond_deg: Array, patience: int) -> None:
    """Clear the runs that are short enough to wait at the end stop."""
    edges = np.flatnonzero(np.diff(ends, prepend=False, append=False))
    for begin, end in edges.reshape(-1, 2).tolist():
        if end - begin <= patience and beyond_deg[begin:end].max() <= FARTHEST_BEYOND_DEG:
            ends[begin:end] = False


def _longest(ends: NDArray[np.bool_], outside: NDArray[np.bool_], distance_deg: Array, first: int) -> int:
    """Return which branch to take at a sample."""

    def merit(branch: int) -> tuple[int, int, float]:
        last = _end(ends[branch], first)
        return -last, int(outside[branch, first:last].sum()), float(distance_deg[branch])

    return min(range(len(ends)), key=merit)


def _end(ends: NDArray[np.bool_], first: int) -> int:
    """Return the index, from `first` on, at which a branch ends."""
    found = np.flatnonzero(ends[first:])
    return first + int(found[0]) if found.size else len(ends)


def _clip(axis: AxisConfig, angle_deg: Array) -> Array:
    return np.clip(angle_deg, axis.minimum_deg, axis.maximum_deg)
