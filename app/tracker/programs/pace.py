"""What a show asks of the axes when its path is run in a given duration.

Outside of repositioning, an axis may be asked for at most 95 % of its rated speed, so that it can catch up
what it loses while it gathers speed, and gathering that speed may take at most 5 % of the show. Repositioning
is what no axis can follow: unwinding from an end stop, and the swing of the first axis where the sun lies
along it (the keyhole, for azimuth near the zenith). It may take at most a fifth of the show.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import copysign

import numpy as np

from app.sun.trigonometry import Array
from app.tracker.mounts.mount import second_axis
from app.tracker.programs.path import Stretch
from app.tracker.settings.axes import AxisConfig
from app.tracker.settings.config import TrackerConfig

SPEED_SHARE = 0.95
RAMP_SHARE = 0.05
REPOSITIONING_SHARE = 0.20
KEYHOLE_DEG = 80.0
NIGHT_MARGIN_S = 0.5
SETTLE_S = 0.35
"""What a repositioning takes longer than from rest to rest: it ends on a target that moves."""


@dataclass(frozen=True, slots=True)
class Repositioning:
    """A span of the show, in seconds of the drive's time, in which the azimuth axis cannot be on the sun."""

    begin_s: float
    end_s: float
    from_deg: float
    to_deg: float
    unwinding: bool


@dataclass(frozen=True, slots=True)
class Night:
    """Between two stretches of sun: when it begins and ends, and when the axes leave for the next sunrise."""

    begin_s: float
    departs_s: float
    end_s: float

    @property
    def long_enough(self) -> bool:
        """Return whether the axes can be there in time."""
        return self.departs_s >= self.begin_s


@dataclass(frozen=True, slots=True)
class Pace:
    """A path run in `duration_s`: peak speeds outside of repositioning, the repositioning, the nights."""

    duration_s: float
    peak_azimuth_dps: float
    peak_elevation_dps: float
    repositionings: tuple[Repositioning, ...]
    nights: tuple[Night, ...]

    @property
    def repositioning_s(self) -> float:
        """Return how long the azimuth axis is not on the sun."""
        return sum(span.end_s - span.begin_s for span in self.repositionings)

    @property
    def repositions_in_time(self) -> bool:
        """Return whether repositioning leaves enough of the show, and ends before the show does."""
        ends_in_time = all(span.end_s <= self.duration_s for span in self.repositionings)
        return ends_in_time and self.repositioning_s <= REPOSITIONING_SHARE * self.duration_s


def usable_dps(axis: AxisConfig, duration_s: float) -> float:
    """Return the highest speed that a show of this duration may ask of an axis."""
    return min(SPEED_SHARE * axis.speed_dps, RAMP_SHARE * duration_s * axis.acceleration_dps2)


def feasible(pace: Pace, tracker: TrackerConfig) -> bool:
    """Return whether the axes can run the path at this pace."""
    return (
        pace.peak_azimuth_dps <= usable_dps(tracker.azimuth, pace.duration_s)
        and pace.peak_elevation_dps <= usable_dps(second_axis(tracker), pace.duration_s)
        and pace.repositions_in_time
        and all(night.long_enough for night in pace.nights)
    )


def pace(
    path: Sequence[Stretch], tracker: TrackerConfig, begin_s: float, acceleration: float, duration_s: float
) -> Pace:
    """Return what running the path asks of the axes; the show begins at `begin_s` of sun time (unix)."""
    spans: list[Repositioning] = []
    peaks = [(0.0, 0.0)]
    ends_s: list[tuple[float, float]] = []
    for stretch in path:
        samples = stretch.samples
        sun_s = np.linspace(samples.begin_s, samples.end_s, len(stretch.turns))
        elapsed_s = (sun_s - begin_s) / acceleration
        found = list(_repositionings(stretch, tracker.azimuth, elapsed_s, duration_s))
        peaks.append(_peaks(stretch, elapsed_s, found))
        ends_s.append((float(elapsed_s[0]), max([float(elapsed_s[-1]), *(span.end_s for span in found)])))
        spans += found
    nights = [
        Night(before[1], after[0] - _night_travel_s(left, right, tracker), after[0])
        for before, after, left, right in zip(ends_s, ends_s[1:], path, path[1:], strict=False)
    ]
    return Pace(
        duration_s,
        max(peak[0] for peak in peaks),
        max(peak[1] for peak in peaks),
        tuple(spans),
        tuple(nights),
    )


def travel_s(axis: AxisConfig, distance_deg: float) -> float:
    """Return how long an axis needs from rest to rest over a distance, seconds."""
    return float(_travel_s(axis, np.array([distance_deg]))[0])


def underway_deg(axis: AxisConfig, span: Repositioning, elapsed_s: float) -> float:
    """Return where the azimuth axis is while it repositions, from rest to rest, axis degrees."""
    distance_deg = abs(span.to_deg - span.from_deg)
    whole_s = travel_s(axis, distance_deg)
    ramp_s = min(axis.speed_dps / axis.acceleration_dps2, whole_s / 2.0)
    gone_s = min(max(elapsed_s - span.begin_s, 0.0), whole_s)
    gathering_s, braking_s = min(gone_s, ramp_s), max(0.0, gone_s - (whole_s - ramp_s))
    steady_s = gone_s - gathering_s - braking_s
    speed_dps = axis.acceleration_dps2 * ramp_s
    gone_deg = 0.5 * axis.acceleration_dps2 * (gathering_s**2 - braking_s**2) + speed_dps * (
        steady_s + braking_s
    )
    return span.from_deg + copysign(gone_deg, span.to_deg - span.from_deg)


def _travel_s(axis: AxisConfig, distance_deg: Array) -> Array:
    """Return the time of a trapezoid, or of a triangle where the rated speed is not reached."""
    ramp_s = axis.speed_dps / axis.acceleration_dps2
    trapezoid_s = distance_deg / axis.speed_dps + ramp_s
    triangle_s = 2.0 * np.sqrt(distance_deg / axis.acceleration_dps2)
    return np.where(distance_deg >= axis.speed_dps * ramp_s, trapezoid_s, triangle_s)


def _repositionings(
    stretch: Stretch, axis: AxisConfig, elapsed_s: Array, duration_s: float
) -> Iterator[Repositioning]:
    """Yield the spans from where the axis loses the sun to where, at rated speed, it is on it again."""
    azimuth_deg, sun_deg = stretch.azimuth_deg, stretch.samples.sun_along_deg
    unwinds = np.diff(stretch.turns) != 0
    too_fast = _speeds(azimuth_deg, elapsed_s) > usable_dps(axis, duration_s)
    keyhole = np.maximum(sun_deg[1:], sun_deg[:-1]) >= KEYHOLE_DEG
    free_s = 0.0
    for i in np.flatnonzero(unwinds | (too_fast & keyhole)).tolist():
        begin_s = float(elapsed_s[i + 1] if unwinds[i] else elapsed_s[i])
        if begin_s < free_s:
            continue
        needed_s = _travel_s(axis, np.abs(azimuth_deg[i + 1 :] - azimuth_deg[i])) + SETTLE_S
        caught_up = np.flatnonzero(begin_s + needed_s <= elapsed_s[i + 1 :])
        j = int(caught_up[0]) if caught_up.size else -1
        free_s = begin_s + float(needed_s[j])
        end_deg = float(azimuth_deg[i + 1 :][j])
        yield Repositioning(begin_s, free_s, float(azimuth_deg[i]), end_deg, bool(unwinds[i]))


def _peaks(stretch: Stretch, elapsed_s: Array, spans: Sequence[Repositioning]) -> tuple[float, float]:
    """Return the highest speeds asked of azimuth, outside of repositioning, and of elevation."""
    follows = np.diff(stretch.turns) == 0
    for span in spans:
        follows &= (elapsed_s[:-1] < span.begin_s) | (elapsed_s[:-1] >= span.end_s)
    azimuth_dps = _speeds(stretch.azimuth_deg, elapsed_s)[follows]
    elevation_dps = _speeds(stretch.elevation_deg, elapsed_s)
    return float(azimuth_dps.max(initial=0.0)), float(elevation_dps.max(initial=0.0))


def _speeds(angle_deg: Array, elapsed_s: Array) -> Array:
    return np.abs(np.diff(angle_deg)) / float(elapsed_s[1] - elapsed_s[0])


def _night_travel_s(left: Stretch, right: Stretch, tracker: TrackerConfig) -> float:
    azimuth_deg = abs(float(right.azimuth_deg[0] - left.azimuth_deg[-1]))
    elevation_deg = abs(float(right.elevation_deg[0] - left.elevation_deg[-1]))
    needed_s = max(travel_s(tracker.azimuth, azimuth_deg), travel_s(second_axis(tracker), elevation_deg))
    return needed_s + NIGHT_MARGIN_S if needed_s > 0.0 else 0.0
