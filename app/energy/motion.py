"""What the drives take, from the motion itself: travel, moves, and being switched on.

Axis angles are days times steps of the day; a day ends with the way back to where it began, the way it came,
so that no cable is wound up.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.base.message import N_
from app.energy.holding import turned_deg
from app.energy.ideal import AxisPath
from app.sun.trigonometry import Array

STILL_DEG = 1e-6


@dataclass(frozen=True, slots=True)
class DriveCosts:
    """Wh for a degree of either axis, Wh for every start of an axis, and W all day and night."""

    degree_wh: float = 0.02
    start_wh: float = 0.005
    standby_w: float = 0.5

    def __post_init__(self) -> None:
        if min(self.degree_wh, self.start_wh, self.standby_w) < 0.0:
            raise ValueError(N_("The drive energy for travel, starts, and standby cannot be below zero."))


@dataclass(frozen=True, slots=True)
class Travelled:
    """Travel in degrees and moves, one value a day, both axes together, the way back included."""

    travel_deg: Array
    moves: NDArray[np.int64]


def travelled(axes: AxisPath, *, without_rest: bool = False) -> Travelled:
    """Return how far and how often the axes move each day.

    An axis that follows `without_rest` starts once a day, however often its angle is asked for.
    """
    first, second = (_axis(angle_deg, without_rest) for angle_deg in (axes.first_deg, axes.second_deg))
    return Travelled(first.travel_deg + second.travel_deg, first.moves + second.moves)


def drives_wh(travelled: Travelled, costs: DriveCosts) -> Array:
    """Return the energy of the drives of each day, Wh."""
    moving_wh = costs.degree_wh * travelled.travel_deg + costs.start_wh * travelled.moves
    return np.asarray(moving_wh + 24.0 * costs.standby_w, dtype=np.float64)


def _axis(angle_deg: Array, without_rest: bool) -> Travelled:
    turns_deg = turned_deg(angle_deg[:, :-1], angle_deg[:, 1:])
    turns_deg = np.where(np.abs(turns_deg) < STILL_DEG, 0.0, turns_deg)
    back_deg = np.abs(turns_deg.sum(axis=1))
    starts = np.count_nonzero(turns_deg, axis=1)
    if without_rest:
        starts = np.minimum(starts, 1)
    travel_deg = np.abs(turns_deg).sum(axis=1) + back_deg
    return Travelled(np.asarray(travel_deg, dtype=np.float64), np.asarray(starts + (back_deg > STILL_DEG)))
