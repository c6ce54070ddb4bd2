"""A whole park in one pass: the closed loop of many trackers with a deadband, tick by tick, over arrays.

For each tick and tracker: the direction to face, axis angles within the limits, the distance from it, and
where that leaves the deadband a run of the trapezoidal drive until it is in position. The laws are the
controller's and the simulated drive's; a test compares every tick with them.
"""

from dataclasses import dataclass, replace
from math import ceil, copysign, cos, pi, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from app.fast.compiled import COMPILED, compiled, inlined
from app.fast.directions import Directions
from app.fast.trigonometry import sine_cosine
from app.sun.trigonometry import Array
from app.tracker.activities.setpoint_scheduler import UNWIND_DEG, trigger_deg
from app.tracker.settings.axes import AxisConfig
from app.tracker.settings.config import TrackerConfig

Columns = tuple[Array, Array, Array, Array, Array, Array]
"""Azimuth, elevation, nearest azimuth (degrees) and night, meant, up (0 or 1), one value a tick."""
AxisLaw = tuple[float, float, float, float]
"""Lower and upper soft limit (degrees), speed (degrees a second), acceleration."""
Tracker = tuple[float, float, float]
"""Distance at which a run begins, azimuth and elevation offset, degrees."""
Pair = tuple[float, float]
"""Azimuth and elevation of the axes, degrees."""

COUNTS_PER_DEG = 100.0
HALF_DEGREE = pi / 360.0
DEGREE = pi / 180.0
BLOCK = 128
"""Ticks that are judged in one go before the first of them that needs a closer look is sought."""
CLOSE = 1.0 - 1e-4
"""Distances from this share of the trigger on are worked out again without approximation."""
OUTSIDE = 2.0
"""More than any haversine: the nearest equivalent azimuth lies outside the limits or a turn away."""
AZIMUTH_TRAVEL, ELEVATION_TRAVEL, MOVING, WORST, TOTAL, WATCHED = range(6)


@dataclass(frozen=True, slots=True)
class ParkDay:
    """What each tracker did: columns with one value a tracker.

    `worst_off_deg` and `rms_off_deg` are distances from the place to be at while the sun is up, degrees.
    """

    moves: NDArray[np.int64]
    azimuth_travel_deg: Array
    elevation_travel_deg: Array
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
    moves, sums = np.zeros(len(deadband_deg), dtype=np.int64), np.zeros((len(deadband_deg), 6))
    triggers_deg = np.array([_trigger_deg(config, float(deadband)) for deadband in deadband_deg])
    trackers = np.column_stack((triggers_deg, azimuth_offset_deg, elevation_offset_deg))
    azimuth, elevation = _law(config.azimuth), _law(config.elevation)
    _park(_columns(directions), directions.step_s, azimuth, elevation, trackers, moves, sums)
    return ParkDay(
        moves=moves,
        azimuth_travel_deg=sums[:, AZIMUTH_TRAVEL],
        elevation_travel_deg=sums[:, ELEVATION_TRAVEL],
        moving_s=sums[:, MOVING] * directions.step_s,
        worst_off_deg=np.degrees(2.0 * np.arcsin(np.sqrt(np.minimum(1.0, sums[:, WORST])))),
        rms_off_deg=np.degrees(2.0 * np.sqrt(sums[:, TOTAL] / np.maximum(sums[:, WATCHED], 1.0))),
    )


def trace(
    config: TrackerConfig,
    directions: Directions,
    *,
    azimuth_offset_deg: float = 0.0,
    elevation_offset_deg: float = 0.0,
) -> tuple[Array, Array]:
    """Return what the encoders of one tracker read at each tick, axis degrees: azimuth and elevation."""
    readings = np.empty((2, len(directions.azimuth_deg)))
    tracker = (trigger_deg(config), azimuth_offset_deg, elevation_offset_deg)
    azimuth, elevation = _law(config.azimuth), _law(config.elevation)
    _follow(_columns(directions), directions.step_s, azimuth, elevation, tracker, np.zeros(6), readings)
    return readings[0], readings[1]


def _trigger_deg(config: TrackerConfig, deadband_deg: float) -> float:
    return trigger_deg(replace(config, deadband_deg=deadband_deg))


def _columns(directions: Directions) -> Columns:
    """Return the columns as numbers, as the compiled loops want them."""
    night, meant, up = (
        np.asarray(flags, dtype=np.float64) for flags in (directions.night, directions.meant, directions.up)
    )
    return directions.azimuth_deg, directions.elevation_deg, directions.near_deg, night, meant, up


def _law(axis: AxisConfig) -> AxisLaw:
    return axis.minimum_deg, axis.maximum_deg, axis.speed_dps, axis.acceleration_dps2


@inlined
def _reading(angle_deg: float) -> float:
    """Return what the encoder reads at an angle: whole counts."""
    return round(angle_deg * COUNTS_PER_DEG) / COUNTS_PER_DEG


@inlined
def _within(azimuth_deg: float, near_deg: float, low_deg: float, high_deg: float) -> float:
    """Return the equivalent angle inside the limits nearest to another, else the end nearest in the sky."""
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
def _haversine(place_deg: Pair, read_deg: Pair) -> float:
    """Return the haversine of the distance between two places of the axes."""
    lift = sin((place_deg[1] - read_deg[1]) * HALF_DEGREE)
    turn = sin((place_deg[0] - read_deg[0]) * HALF_DEGREE)
    return lift * lift + cos(place_deg[1] * DEGREE) * cos(read_deg[1] * DEGREE) * turn * turn


@inlined
def _travel_s(way_deg: float, law: AxisLaw) -> float:
    """Return how long an axis takes from rest to rest."""
    if way_deg * law[3] <= law[2] * law[2]:
        return 2.0 * sqrt(way_deg / law[3])
    return way_deg / law[2] + law[2] / law[3]


@inlined
def _way_deg(elapsed_s: float, way_deg: float, law: AxisLaw) -> float:
    """Return how far an axis has come on a way from rest to rest."""
    whole_s = _travel_s(way_deg, law)
    if elapsed_s >= whole_s:
        return way_deg
    peak_dps = min(law[2], sqrt(way_deg * law[3]))
    ramp_s = peak_dps / law[3]
    if elapsed_s <= ramp_s:
        return 0.5 * law[3] * elapsed_s * elapsed_s
    if elapsed_s <= whole_s - ramp_s:
        return 0.5 * peak_dps * ramp_s + peak_dps * (elapsed_s - ramp_s)
    left_s = whole_s - elapsed_s
    return way_deg - 0.5 * law[3] * left_s * left_s


@inlined
def _place(
    columns: Columns, i: int, near_deg: float, azimuth: AxisLaw, elevation: AxisLaw, tracker: Tracker
) -> Pair:
    """Return the axis angles to be at in a tick: offsets added, within the limits."""
    turned_deg = _within(columns[0][i] + tracker[1], near_deg, azimuth[0], azimuth[1])
    return turned_deg, min(elevation[1], max(elevation[0], columns[1][i] + tracker[2]))


@compiled
def _judge_each(
    columns: Columns, read_deg: Pair, tracker: Tracker, azimuth: AxisLaw, elevation: AxisLaw, away: Array
) -> int:
    """Note the haversine of each tick's distance in `away`; return how many ticks need a closer look."""
    azimuth_deg, elevation_deg, near_deg, night, meant, _ = columns
    cos_read = cos(read_deg[1] * DEGREE)
    limit = CLOSE * sin(tracker[0] * HALF_DEGREE) ** 2
    flagged = 0
    for i in range(azimuth_deg.size):
        near = read_deg[0] + night[i] * (near_deg[i] - read_deg[0])
        angle = azimuth_deg[i] + tracker[1]
        angle += 360.0 * np.floor((near - angle) / 360.0 + 0.5)
        height = min(elevation[1], max(elevation[0], elevation_deg[i] + tracker[2]))
        turn, _ = sine_cosine((angle - read_deg[0]) * HALF_DEGREE)
        lift, _ = sine_cosine((height - read_deg[1]) * HALF_DEGREE)
        _, cos_height = sine_cosine(height * DEGREE)
        haversine = lift * lift + cos_read * cos_height * turn * turn
        beyond = max(max(azimuth[0] - angle, angle - azimuth[1]), abs(angle - read_deg[0]) - UNWIND_DEG)
        away[i] = meant[i] * (haversine + (OUTSIDE if beyond > 0.0 else 0.0))
        flagged += 1 if away[i] > limit else 0
    return flagged


def _judge_all(
    columns: Columns, read_deg: Pair, tracker: Tracker, azimuth: AxisLaw, elevation: AxisLaw, away: Array
) -> int:
    """Do the same over arrays: without a compiler that is quicker by far than the loop."""
    azimuth_deg, elevation_deg, near_deg, night, meant, _ = columns
    angle = azimuth_deg + tracker[1]
    near = read_deg[0] + night * (near_deg - read_deg[0])
    angle += 360.0 * np.floor((near - angle) / 360.0 + 0.5)
    height = np.clip(elevation_deg + tracker[2], elevation[0], elevation[1])
    turn = np.sin((angle - read_deg[0]) * HALF_DEGREE)
    lift = np.sin((height - read_deg[1]) * HALF_DEGREE)
    haversine = lift * lift + cos(read_deg[1] * DEGREE) * np.cos(height * DEGREE) * turn * turn
    beyond = (angle < azimuth[0]) | (angle > azimuth[1]) | (np.abs(angle - read_deg[0]) > UNWIND_DEG)
    found = away[: angle.size]
    found[:] = meant * (haversine + OUTSIDE * beyond)
    return int(np.count_nonzero(found > CLOSE * sin(tracker[0] * HALF_DEGREE) ** 2))


_judge = _judge_each if COMPILED else _judge_all


@compiled
def _add_up(away: Array, meant: Array, up: Array, sums: Array) -> None:
    """Add up the distances of quiet ticks while the sun is up.

    The greatest is sought among the bits of the numbers, which for positive ones are in the same order: that
    becomes vector code, a comparison of the numbers themselves does not.
    """
    total, watched = 0.0, 0.0
    for i in range(away.size):
        seen = meant[i] * up[i]
        away[i] *= seen
        total += away[i]
        watched += seen
    greatest = 0
    for bits in away.view(np.int64):
        greatest = max(greatest, bits)
    sums[WORST] = max(sums[WORST], np.array([greatest]).view(np.float64)[0])
    sums[TOTAL] += total
    sums[WATCHED] += watched


@inlined
def _add(haversine: float, seen: float, sums: Array) -> None:
    """Add one tick's distance, if it is seen."""
    sums[WORST] = max(sums[WORST], seen * haversine)
    sums[TOTAL] += seen * haversine
    sums[WATCHED] += seen


@compiled
def _run(
    columns: Columns,
    i: int,
    step_s: float,
    azimuth: AxisLaw,
    elevation: AxisLaw,
    tracker: Tracker,
    from_deg: Pair,
    to_deg: Pair,
    sums: Array,
    readings: Array,
) -> int:
    """Run from rest to rest, begun at a tick; return the tick at which both axes stand again."""
    turn_deg, lift_deg = to_deg[0] - from_deg[0], to_deg[1] - from_deg[1]
    whole_s = max(_travel_s(abs(turn_deg), azimuth), _travel_s(abs(lift_deg), elevation))
    arrival = i + max(1, ceil(whole_s / step_s))
    for k in range(i + 1, min(arrival, columns[0].size)):
        elapsed_s = (k - i) * step_s
        turned_deg = from_deg[0] + copysign(_way_deg(elapsed_s, abs(turn_deg), azimuth), turn_deg)
        lifted_deg = from_deg[1] + copysign(_way_deg(elapsed_s, abs(lift_deg), elevation), lift_deg)
        read_deg = (_reading(turned_deg), _reading(lifted_deg))
        place_deg = _place(columns, k, read_deg[0], azimuth, elevation, tracker)
        _add(_haversine(place_deg, read_deg), columns[4][k] * columns[5][k], sums)
        if readings.size:
            readings[0, k], readings[1, k] = read_deg
    sums[AZIMUTH_TRAVEL] += abs(turn_deg)
    sums[ELEVATION_TRAVEL] += abs(lift_deg)
    sums[MOVING] += arrival - i
    return arrival


@compiled
def _quiet(
    columns: Columns,
    begin: int,
    read_deg: Pair,
    azimuth: AxisLaw,
    elevation: AxisLaw,
    tracker: Tracker,
    sums: Array,
    away: Array,
) -> int:
    """Return the next tick that needs a closer look, at most a block on, and add up those before it."""
    end = min(begin + BLOCK, columns[0].size)
    one, two, three, four, five, six = columns
    span = slice(begin, end)
    block = (one[span], two[span], three[span], four[span], five[span], six[span])
    if _judge(block, read_deg, tracker, azimuth, elevation, away):
        limit = CLOSE * sin(tracker[0] * HALF_DEGREE) ** 2
        end = begin
        while away[end - begin] <= limit:
            end += 1
    _add_up(away[: end - begin], five[begin:end], six[begin:end], sums)
    return end


@compiled
def _follow(
    columns: Columns,
    step_s: float,
    azimuth: AxisLaw,
    elevation: AxisLaw,
    tracker: Tracker,
    sums: Array,
    readings: Array,
) -> int:
    """Follow the directions with one tracker; return its moves, add up the rest, note readings if wanted."""
    limit = sin(tracker[0] * HALF_DEGREE) ** 2
    away = np.empty(BLOCK)
    at_deg = _place(columns, 0, columns[2][0], azimuth, elevation, tracker)
    moves, i = 0, 0
    while i < columns[0].size:
        read_deg = (_reading(at_deg[0]), _reading(at_deg[1]))
        begin, i = i, _quiet(columns, i, read_deg, azimuth, elevation, tracker, sums, away)
        if readings.size:
            readings[0, begin : i + 1], readings[1, begin : i + 1] = read_deg
        if i == columns[0].size:
            break
        near_deg = columns[2][i] if columns[3][i] else read_deg[0]
        place_deg = _place(columns, i, near_deg, azimuth, elevation, tracker)
        off = _haversine(place_deg, read_deg)
        _add(off, columns[4][i] * columns[5][i], sums)
        if columns[4][i] and (off > limit or abs(read_deg[0] - place_deg[0]) > UNWIND_DEG):
            moves += 1
            i = _run(columns, i, step_s, azimuth, elevation, tracker, at_deg, place_deg, sums, readings)
            at_deg = place_deg
        else:
            i += 1
    return moves


@compiled
def _park(
    columns: Columns,
    step_s: float,
    azimuth: AxisLaw,
    elevation: AxisLaw,
    trackers: Array,
    moves: NDArray[np.int64],
    sums: Array,
) -> None:
    """Follow the directions with every tracker."""
    unnoted = np.empty((2, 0))
    for k in range(moves.size):
        tracker = (trackers[k, 0], trackers[k, 1], trackers[k, 2])
        moves[k] = _follow(columns, step_s, azimuth, elevation, tracker, sums[k], unnoted)
