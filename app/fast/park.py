"""A whole park in one pass: the closed loop of many trackers with a deadband, tick by tick, over arrays.

For each tick and tracker: the direction to face, axis angles within the limits, the distance from it, and where
that leaves the deadband a run of the trapezoidal drive until it is in position. The laws are those of
`tracker.follow`, `tracker.mount` and the simulated drive; a test compares every tick with the real controller.
"""

from dataclasses import dataclass, replace
from math import ceil, copysign, cos, pi, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from app.fast.compiled import compiled, inlined
from app.fast.directions import Directions
from app.fast.trigonometry import sine_cosine
from app.sun.trigonometry import Array
from app.tracker.axes import AxisConfig
from app.tracker.config import TrackerConfig
from app.tracker.pursuit import UNWIND_DEG, trigger_deg

RESOLUTION_DEG = 0.01
HALF_DEGREE = pi / 360.0
DEGREE = pi / 180.0
BLOCK = 128
"""Ticks that are judged in one go before the first of them that needs a closer look is sought."""
OUTSIDE = 2.0
CLOSE = 1.0 - 1e-4
"""Distances from this share of the trigger on are computed again without approximation."""


@dataclass(frozen=True, slots=True)
class ParkDay:
    """What each tracker did: columns with one row a tracker.

    `worst_off_deg` and `rms_off_deg` are distances from the direction to face while the sun is up, degrees.
    """

    moves: NDArray[np.int64]
    travel_azimuth_deg: Array
    travel_elevation_deg: Array
    moving_s: Array
    worst_off_deg: Array
    rms_off_deg: Array


def park_day(
    config: TrackerConfig,
    directions: Directions,
    *,
    deadband_deg: Array,
    azimuth_offset_deg: Array,
    elevation_offset_deg: Array,
) -> ParkDay:
    """Return what trackers do that share a configuration but for deadband and pointing offsets.

    The three arrays have one value a tracker, degrees. Every tracker stands in place at the first tick.
    """
    counts = np.zeros(len(deadband_deg), dtype=np.int64)
    sums = np.zeros((len(deadband_deg), 6))
    triggers_deg = np.array([_trigger_deg(config, float(deadband)) for deadband in deadband_deg])
    _park(
        *_columns(directions),
        _axis(config.azimuth),
        _axis(config.elevation),
        triggers_deg,
        azimuth_offset_deg,
        elevation_offset_deg,
        counts,
        sums,
    )
    watched = np.maximum(sums[:, 5], 1.0)
    return ParkDay(
        moves=counts,
        travel_azimuth_deg=sums[:, 0],
        travel_elevation_deg=sums[:, 1],
        moving_s=sums[:, 2] * directions.step_s,
        worst_off_deg=np.degrees(2.0 * np.arcsin(np.sqrt(np.minimum(1.0, sums[:, 3])))),
        rms_off_deg=np.degrees(2.0 * np.sqrt(sums[:, 4] / watched)),
    )


def trace(
    config: TrackerConfig,
    directions: Directions,
    *,
    deadband_deg: float,
    azimuth_offset_deg: float = 0.0,
    elevation_offset_deg: float = 0.0,
) -> tuple[Array, Array]:
    """Return what the encoders of one tracker read at each tick, axis degrees: azimuth and elevation."""
    readings = np.empty((2, len(directions.azimuth_deg)))
    tracker = (_trigger_deg(config, deadband_deg), azimuth_offset_deg, elevation_offset_deg)
    _follow(
        *_columns(directions), _axis(config.azimuth), _axis(config.elevation), tracker, np.zeros(6), readings
    )
    return readings[0], readings[1]


def _trigger_deg(config: TrackerConfig, deadband_deg: float) -> float:
    return trigger_deg(replace(config, deadband_deg=deadband_deg))


def _columns(directions: Directions) -> tuple[Array, ...]:
    """Return the columns as numbers, as the compiled loop wants them."""
    numbers = (directions.night, directions.meant, directions.up)
    return (
        directions.azimuth_deg,
        directions.elevation_deg,
        directions.near_deg,
        *(flags.astype(np.float64) for flags in numbers),
        np.array([directions.step_s]),
    )


def _axis(axis: AxisConfig) -> tuple[float, float, float, float]:
    return axis.minimum_deg, axis.maximum_deg, axis.speed_dps, axis.acceleration_dps2


@inlined
def _reading(angle_deg: float) -> float:
    """Return what the encoder reads at an angle: whole counts."""
    return round(angle_deg / RESOLUTION_DEG) * RESOLUTION_DEG


@inlined
def _within(azimuth_deg: float, near_deg: float, low_deg: float, high_deg: float) -> float:
    """Return the equivalent angle inside the limits nearest to another, else the nearer end (`mount.aim`)."""
    angle_deg = azimuth_deg + 360.0 * round((near_deg - azimuth_deg) / 360.0)
    if angle_deg < low_deg:
        angle_deg += 360.0 * ceil((low_deg - angle_deg) / 360.0)
    elif angle_deg > high_deg:
        angle_deg -= 360.0 * ceil((angle_deg - high_deg) / 360.0)
    if low_deg <= angle_deg <= high_deg:
        return angle_deg
    low_off_deg = abs((azimuth_deg - low_deg + 180.0) % 360.0 - 180.0)
    high_off_deg = abs((azimuth_deg - high_deg + 180.0) % 360.0 - 180.0)
    if low_off_deg == high_off_deg:
        return low_deg if abs(low_deg - near_deg) <= abs(high_deg - near_deg) else high_deg
    return low_deg if low_off_deg < high_off_deg else high_deg


@inlined
def _haversine(azimuth_off_deg: float, a_deg: float, b_deg: float) -> float:
    """Return the haversine of the distance of two directions of elevations a and b."""
    lift = sin((a_deg - b_deg) * HALF_DEGREE)
    turn = sin(azimuth_off_deg * HALF_DEGREE)
    return lift * lift + cos(a_deg * DEGREE) * cos(b_deg * DEGREE) * turn * turn


@inlined
def _travel_s(way_deg: float, speed_dps: float, acceleration_dps2: float) -> float:
    """Return how long an axis takes from rest to rest."""
    if way_deg * acceleration_dps2 <= speed_dps * speed_dps:
        return 2.0 * sqrt(way_deg / acceleration_dps2)
    return way_deg / speed_dps + speed_dps / acceleration_dps2


@inlined
def _way_deg(elapsed_s: float, way_deg: float, speed_dps: float, acceleration_dps2: float) -> float:
    """Return how far an axis has come on a way from rest to rest."""
    whole_s = _travel_s(way_deg, speed_dps, acceleration_dps2)
    if elapsed_s >= whole_s:
        return way_deg
    peak_dps = min(speed_dps, sqrt(way_deg * acceleration_dps2))
    ramp_s = peak_dps / acceleration_dps2
    if elapsed_s <= ramp_s:
        return 0.5 * acceleration_dps2 * elapsed_s * elapsed_s
    if elapsed_s <= whole_s - ramp_s:
        return 0.5 * peak_dps * ramp_s + peak_dps * (elapsed_s - ramp_s)
    left_s = whole_s - elapsed_s
    return way_deg - 0.5 * acceleration_dps2 * left_s * left_s


@compiled
def _judge(
    azimuth_deg: Array,
    elevation_deg: Array,
    near_deg: Array,
    night: Array,
    meant: Array,
    stands: tuple[float, float, float],
    tracker: tuple[float, float, float],
    axes: tuple[float, float, float, float],
    away: Array,
) -> int:
    """Note the haversine of each tick's distance in `away`; return how many ticks need a closer look.

    It is `OUTSIDE` and more where the nearest equivalent azimuth is not to be gone to as it is.
    """
    azimuth_read_deg, elevation_read_deg, cos_elevation = stands
    _, azimuth_offset_deg, elevation_offset_deg = tracker
    low_deg, high_deg, bottom_deg, top_deg = axes
    limit = CLOSE * sin(tracker[0] * HALF_DEGREE) ** 2
    flagged = 0
    for i in range(azimuth_deg.size):
        near = azimuth_read_deg + night[i] * (near_deg[i] - azimuth_read_deg)
        angle = azimuth_deg[i] + azimuth_offset_deg
        angle += 360.0 * np.floor((near - angle) / 360.0 + 0.5)
        height = min(top_deg, max(bottom_deg, elevation_deg[i] + elevation_offset_deg))
        turn, _ = sine_cosine((angle - azimuth_read_deg) * HALF_DEGREE)
        lift, _ = sine_cosine((height - elevation_read_deg) * HALF_DEGREE)
        _, cos_height = sine_cosine(height * DEGREE)
        haversine = lift * lift + cos_elevation * cos_height * turn * turn
        outside = max(max(low_deg - angle, angle - high_deg), abs(angle - azimuth_read_deg) - UNWIND_DEG)
        away[i] = meant[i] * (haversine + (OUTSIDE if outside > 0.0 else 0.0))
        flagged += 1 if away[i] > limit else 0
    return flagged


@compiled
def _add_up(away: Array, meant: Array, up: Array, sums: Array) -> None:
    """Add the distances of quiet ticks to what is summed up while the sun is up."""
    total, watched = 0.0, 0.0
    for i in range(away.size):
        seen = meant[i] * up[i]
        away[i] *= seen
        total += away[i]
        watched += seen
    worst = 0
    for bits in away.view(np.int64):
        worst = max(worst, bits)
    sums[3] = max(sums[3], np.array([worst]).view(np.float64)[0])
    sums[4] += total
    sums[5] += watched


@inlined
def _target(
    i: int,
    azimuth_deg: Array,
    elevation_deg: Array,
    near_deg: float,
    tracker: tuple[float, float, float],
    limits: tuple[float, float, float, float],
) -> tuple[float, float]:
    """Return the axis angles of a tick: offsets added, within the limits, the cable not wound up further."""
    low_deg, high_deg, bottom_deg, top_deg = limits
    turned_deg = _within(azimuth_deg[i] + tracker[1], near_deg, low_deg, high_deg)
    return turned_deg, min(top_deg, max(bottom_deg, elevation_deg[i] + tracker[2]))


@inlined
def _count(haversine: float, seen: float, sums: Array) -> None:
    """Add one tick's distance to what is summed up while the sun is up."""
    sums[3] = max(sums[3], seen * haversine)
    sums[4] += seen * haversine
    sums[5] += seen


@compiled
def _run(
    i: int,
    azimuth_deg: Array,
    elevation_deg: Array,
    meant: Array,
    up: Array,
    step_s: float,
    azimuth: tuple[float, float, float, float],
    elevation: tuple[float, float, float, float],
    tracker: tuple[float, float, float],
    from_deg: tuple[float, float],
    to_deg: tuple[float, float],
    sums: Array,
    readings: Array,
) -> int:
    """Run from rest to rest, begun at a tick; return the tick at which both axes stand again."""
    limits = (azimuth[0], azimuth[1], elevation[0], elevation[1])
    turn_deg, lift_deg = to_deg[0] - from_deg[0], to_deg[1] - from_deg[1]
    whole_s = max(
        _travel_s(abs(turn_deg), azimuth[2], azimuth[3]), _travel_s(abs(lift_deg), elevation[2], elevation[3])
    )
    arrival = i + max(1, ceil(whole_s / step_s))
    for k in range(i + 1, min(arrival, azimuth_deg.size)):
        elapsed_s = (k - i) * step_s
        turned_deg = from_deg[0] + copysign(_way_deg(elapsed_s, abs(turn_deg), azimuth[2], azimuth[3]), turn_deg)
        lifted_deg = from_deg[1] + copysign(
            _way_deg(elapsed_s, abs(lift_deg), elevation[2], elevation[3]), lift_deg
        )
        read_deg = (_reading(turned_deg), _reading(lifted_deg))
        target_deg = _target(k, azimuth_deg, elevation_deg, read_deg[0], tracker, limits)
        _count(_haversine(target_deg[0] - read_deg[0], read_deg[1], target_deg[1]), meant[k] * up[k], sums)
        if readings.shape[1] > 0:
            readings[0, k], readings[1, k] = read_deg
    sums[0] += abs(turn_deg)
    sums[1] += abs(lift_deg)
    sums[2] += arrival - i
    return arrival


@compiled
def _follow(
    azimuth_deg: Array,
    elevation_deg: Array,
    near_deg: Array,
    night: Array,
    meant: Array,
    up: Array,
    step: Array,
    azimuth: tuple[float, float, float, float],
    elevation: tuple[float, float, float, float],
    tracker: tuple[float, float, float],
    sums: Array,
    readings: Array,
) -> int:
    """Follow the directions with one tracker; return its moves, add up the rest, note readings if wanted."""
    limits = (azimuth[0], azimuth[1], elevation[0], elevation[1])
    limit = sin(tracker[0] * HALF_DEGREE) ** 2
    noted = readings.shape[1] > 0
    at_deg = _target(0, azimuth_deg, elevation_deg, near_deg[0], tracker, limits)
    away = np.empty(BLOCK)
    moves, i = 0, 0
    while i < azimuth_deg.size:
        read_deg = (_reading(at_deg[0]), _reading(at_deg[1]))
        stands = (read_deg[0], read_deg[1], cos(read_deg[1] * DEGREE))
        end = min(i + BLOCK, azimuth_deg.size)
        block = slice(i, end)
        flagged = _judge(
            azimuth_deg[block], elevation_deg[block], near_deg[block], night[block], meant[block], stands,
            tracker, limits, away,
        )  # fmt: skip
        if flagged:
            end = i
            while away[end - i] <= CLOSE * limit:
                end += 1
        _add_up(away[: end - i], meant[i:end], up[i:end], sums)
        if noted:
            readings[0, i:end], readings[1, i:end] = read_deg
        i = end
        if i == azimuth_deg.size:
            break
        near = near_deg[i] if night[i] else read_deg[0]
        target_deg = _target(i, azimuth_deg, elevation_deg, near, tracker, limits)
        off = _haversine(target_deg[0] - read_deg[0], read_deg[1], target_deg[1])
        _count(off, meant[i] * up[i], sums)
        if noted:
            readings[0, i], readings[1, i] = read_deg
        if meant[i] and (off > limit or abs(read_deg[0] - target_deg[0]) > UNWIND_DEG):
            moves += 1
            i = _run(
                i, azimuth_deg, elevation_deg, meant, up, step[0], azimuth, elevation, tracker, at_deg,
                target_deg, sums, readings,
            )  # fmt: skip
            at_deg = target_deg
        else:
            i += 1
    return moves


@compiled
def _park(
    azimuth_deg: Array,
    elevation_deg: Array,
    near_deg: Array,
    night: Array,
    meant: Array,
    up: Array,
    step: Array,
    azimuth: tuple[float, float, float, float],
    elevation: tuple[float, float, float, float],
    triggers_deg: Array,
    azimuth_offset_deg: Array,
    elevation_offset_deg: Array,
    moves: NDArray[np.int64],
    sums: Array,
) -> None:
    """Follow the directions with every tracker."""
    unnoted = np.empty((2, 0))
    for k in range(triggers_deg.size):
        tracker = (triggers_deg[k], azimuth_offset_deg[k], elevation_offset_deg[k])
        moves[k] = _follow(
            azimuth_deg, elevation_deg, near_deg, night, meant, up, step, azimuth, elevation, tracker,
            sums[k], unnoted,
        )  # fmt: skip
