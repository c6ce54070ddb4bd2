"""What a strategy holds instead of the ideal axis angles, over many days at once.

All arrays are days times steps of the day. A held place is the ideal one of some instant, so that a strategy
that goes by the sun is an array of the indices of these instants. A step program has places of its own:
`programmed.program_axes`.
"""

from typing import assert_never

import numpy as np
from numpy.typing import NDArray

from app.base.message import N_
from app.energy.ideal import AxisPath
from app.sun.trigonometry import PER_DEGREE, PER_RADIAN, Array
from app.tracker.settings.strategy import (
    Continuous,
    Deadband,
    EncoderDeadband,
    Interval,
    IntervalAim,
    Stepped,
    Strategy,
)

Indices = NDArray[np.intp]
Flags = NDArray[np.bool_]


def turned_deg(from_deg: Array, to_deg: Array) -> Array:
    """Return by how much an angle changes, the shorter way round, in [-180, 180) degrees."""
    return np.mod(to_deg - from_deg + 180.0, 360.0) - 180.0


def separations_deg(a: AxisPath, b: AxisPath) -> Array:
    """Return the angle between the places of two paths: longitude and latitude on a sphere."""
    half_first = np.sin((a.first_deg - b.first_deg) * PER_DEGREE / 2) ** 2
    half_second = np.sin((a.second_deg - b.second_deg) * PER_DEGREE / 2) ** 2
    cosines = np.cos(a.second_deg * PER_DEGREE) * np.cos(b.second_deg * PER_DEGREE)
    haversine = np.clip(half_second + cosines * half_first, 0.0, 1.0)
    return np.asarray(2.0 * np.arcsin(np.sqrt(haversine)) * PER_RADIAN, dtype=np.float64)


def held_axes(
    strategy: Strategy, ideal: AxisPath, up: Flags, *, step_min: float, deadband_deg: float
) -> AxisPath:
    """Return where a strategy that goes by the sun stands at every instant.

    While the sun is down the panel waits where it will be at sunrise; in a day without sun it stays.
    """
    columns = _dawn(up)
    match strategy:
        case Continuous():
            return _taken(ideal, columns)
        case Deadband():
            return _taken(ideal, _deadband(ideal, columns, deadband_deg))
        case EncoderDeadband():
            return AxisPath(
                _counted(ideal.first_deg, columns, strategy.band_deg),
                _counted(ideal.second_deg, columns, strategy.band_deg),
            )
        case Interval():
            return _taken(ideal, _interval(strategy, columns, step_min))
        case Stepped():
            raise ValueError(N_("A step program has its own positions; use `program_axes`."))
    assert_never(strategy)


def _dawn(up: Flags) -> Indices:
    """Return for every instant itself while the sun is up, before it sunrise, after it sunset."""
    count = up.shape[1]
    first = np.where(up.any(axis=1), up.argmax(axis=1), 0)
    last = np.where(up.any(axis=1), count - 1 - up[:, ::-1].argmax(axis=1), 0)
    return np.clip(np.arange(count)[None, :], first[:, None], last[:, None])


def _taken(ideal: AxisPath, columns: Indices) -> AxisPath:
    return AxisPath(
        np.take_along_axis(ideal.first_deg, columns, axis=1),
        np.take_along_axis(ideal.second_deg, columns, axis=1),
    )


def _deadband(ideal: AxisPath, columns: Indices, deadband_deg: float) -> Indices:
    """Return the instants that are held: a new one as soon as the panel is off by more than the deadband."""
    days = np.arange(len(columns))
    held = columns[:, 0].copy()
    chosen = np.empty_like(columns)
    for step in range(columns.shape[1]):
        wanted = columns[:, step]
        now = AxisPath(ideal.first_deg[days, wanted], ideal.second_deg[days, wanted])
        stood = AxisPath(ideal.first_deg[days, held], ideal.second_deg[days, held])
        held = np.where(separations_deg(now, stood) > deadband_deg, wanted, held)
        chosen[:, step] = held
    return chosen


def _counted(ideal_deg: Array, columns: Indices, band_deg: float) -> Array:
    """Return the angles of one axis that runs by itself as soon as it is off by its band."""
    wanted_deg = np.take_along_axis(ideal_deg, columns, axis=1)
    held_deg = np.empty_like(wanted_deg)
    stood_deg = wanted_deg[:, 0]
    for step in range(wanted_deg.shape[1]):
        off_deg = np.abs(turned_deg(stood_deg, wanted_deg[:, step]))
        stood_deg = np.where(off_deg >= band_deg, wanted_deg[:, step], stood_deg)
        held_deg[:, step] = stood_deg
    return held_deg


def _interval(strategy: Interval, columns: Indices, step_min: float) -> Indices:
    steps = max(1, round(strategy.minutes / step_min))
    begun = np.arange(columns.shape[1]) // steps * steps
    aimed = begun + (steps // 2 if strategy.aim is IntervalAim.MIDDLE else 0)
    return np.clip(aimed[None, :], columns[:, :1], columns[:, -1:])
