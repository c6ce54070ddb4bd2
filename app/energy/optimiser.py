"""The best step programs for a day: how many steps, when, to which angles, at which tilt.

Two facts make it exact. For given angles the best instants are known (`stepping.midpoint_h`). For given
instants the energy of each resting place is A cos(angle) + B sin(angle), so that its best angle is known too.
A search over a grid (dynamic programming: every number of steps in one pass, any irradiance) finds where to
begin; both facts in turn refine it, which never loses energy. What comes out is compared with equal steps by
the midpoint rule and is never below them.
"""

from dataclasses import dataclass, replace
from itertools import pairwise
from math import atan2, ceil, degrees, radians

import numpy as np
from numpy.typing import NDArray

from app.base.message import N_, say, with_format
from app.energy.equatorial import (
    DEGREES_AN_HOUR,
    NOON_H,
    cos_incidence,
    hour_angle_deg,
    panel_declination_deg,
)
from app.energy.stepping import SolarDay, Steps, midpoint_h, stepped_whm2
from app.sun.trigonometry import PER_DEGREE, PER_RADIAN, Array

CELL_H = 0.05
GRID_DEG = 1.0
FINE_CELLS = 5760
ROUNDS = 400
SETTLED_DEG = 1e-7
MOST_STEPS = 48


@dataclass(frozen=True, slots=True)
class Limits:
    """What the mechanism allows and what its motion costs.

    Hour angles stay within +-`range_deg`; a step takes `step_h` hours. `per_whm2` is the electric energy,
    Wh, that the panel makes of 1 Wh/m2 in its plane (area times efficiency). A degree of travel costs
    `degree_wh`, the way back included, and a move `move_wh`.
    """

    range_deg: float = 60.0
    step_h: float = 0.0
    per_whm2: float = 1.0
    degree_wh: float = 0.0
    move_wh: float = 0.0

    def __post_init__(self) -> None:
        if not 1.0 <= self.range_deg <= 120.0:
            raise ValueError(N_("The range to either side of noon lies between 1 and 120 degrees."))
        if not 0.0 <= self.step_h <= 1.0:
            raise ValueError(N_("A step takes between 0 and 60 minutes."))
        if self.per_whm2 <= 0.0:
            raise ValueError(N_("Panel area and efficiency must be above zero."))
        if min(self.degree_wh, self.move_wh) < 0.0:
            raise ValueError(N_("The energy of a move and of a degree of travel cannot be below zero."))


@dataclass(frozen=True, slots=True)
class Optimum:
    """The best program of one number of steps: what it collects, what is left after its motion is paid."""

    steps: Steps
    collected_whm2: float
    electric_wh: float
    drives_wh: float

    @property
    def count(self) -> int:
        """Return the number of steps, the way back not counted."""
        return len(self.steps.starts_h)

    @property
    def net_wh(self) -> float:
        """Return the electric energy less what the drives take."""
        return self.electric_wh - self.drives_wh


def best_programs(
    day: SolarDay, most_steps: int, limits: Limits, tilt_deg: float | None = None
) -> tuple[Optimum, ...]:
    """Return the best program of 0, 1, 2 ... `most_steps` steps, as far as that many fit into the range.

    Without `tilt_deg` the tilt is the best one for each program.
    """
    if not 0 <= most_steps <= MOST_STEPS:
        raise ValueError(say("Choose between 0 and {most_steps} steps.", most_steps=MOST_STEPS))
    searched = _search(day, most_steps, limits, tilt_deg)
    found = []
    for count in range(most_steps + 1):
        if not _fits(count, limits):
            break
        equal = equal_steps(day, count, limits, tilt_deg)
        refined = _refined(day, searched[count], limits, tilt_deg)
        found.append(max((judged(day, one, limits) for one in (equal, *refined)), key=lambda one: one.net_wh))
    return tuple(found)


def best_steps(day: SolarDay, count: int, limits: Limits, tilt_deg: float | None = None) -> Optimum:
    """Return the best program of so many steps; raises `ValueError` if they do not fit into the range."""
    if not _fits(count, limits):
        raise ValueError(
            say(
                "{count} steps of {step_h} minutes do not fit into +-{range_deg} degrees; take fewer "
                "or shorter steps.",
                count=count,
                step_h=with_format(limits.step_h * 60, "g"),
                range_deg=with_format(limits.range_deg, "g"),
            )
        )
    return best_programs(day, count, limits, tilt_deg)[count]


def best_number(programs: tuple[Optimum, ...]) -> Optimum:
    """Return the program that leaves most after its motion is paid; of equal ones the one of fewer steps."""
    return max(programs, key=lambda one: (one.net_wh, -one.count))


def equal_steps(day: SolarDay, count: int, limits: Limits, tilt_deg: float | None = None) -> Steps:
    """Return equal steps over the whole range at the instants of the midpoint rule."""
    angles = np.linspace(limits.range_deg, -limits.range_deg, count + 1) if count else np.zeros(1)
    return _program(day, angles, limits, tilt_deg)


def judged(day: SolarDay, steps: Steps, limits: Limits) -> Optimum:
    """Return what a program is worth."""
    collected_whm2 = stepped_whm2(day, steps)
    moves = len(steps.starts_h) + 1 if steps.starts_h else 0
    drives_wh = limits.degree_wh * steps.travel_deg + limits.move_wh * moves
    return Optimum(steps, collected_whm2, limits.per_whm2 * collected_whm2, drives_wh)


def best_tilt_deg(day: SolarDay, steps: Steps) -> float:
    """Return the tilt at which a program collects most, degrees from the horizontal towards the south."""
    edges_h = np.linspace(day.begin_h, day.end_h, FINE_CELLS + 1)
    at_h = (edges_h[:-1] + edges_h[1:]) / 2
    beam = day.beam(at_h)
    turned = np.cos((steps.angle_deg(at_h) - hour_angle_deg(at_h)) * PER_DEGREE)
    declination = radians(day.declination_deg)
    along, above = float(beam @ turned) * np.cos(declination), float(beam.sum()) * np.sin(declination)
    if along <= 0.0:
        return day.latitude_deg - day.declination_deg
    return day.latitude_deg - degrees(atan2(above, along))


def _fits(count: int, limits: Limits) -> bool:
    """Return whether so many equal steps end before the next begins."""
    return count < 2 or 2 * limits.range_deg / count / DEGREES_AN_HOUR >= limits.step_h


def _program(day: SolarDay, angles_deg: Array, limits: Limits, tilt_deg: float | None) -> Steps:
    angles = tuple(angles_deg.tolist())
    ideal_deg = day.latitude_deg - day.declination_deg
    steps = Steps(midpoint_h(angles, limits.step_h), angles, ideal_deg, limits.step_h)
    return replace(steps, tilt_deg=best_tilt_deg(day, steps) if tilt_deg is None else tilt_deg)


def _search(day: SolarDay, most_steps: int, limits: Limits, tilt_deg: float | None) -> tuple[Array, ...]:
    """Return the angles of the best program on the grid for every number of steps from none on."""
    grid_deg = np.linspace(limits.range_deg, -limits.range_deg, 2 * ceil(limits.range_deg / GRID_DEG) + 1)
    cells_wh = _cells(day, grid_deg, limits, tilt_deg)
    value = np.full((most_steps + 1, len(grid_deg)), -np.inf)
    value[0] = -2.0 * limits.degree_wh * grid_deg
    came_from = np.empty((len(cells_wh), *value.shape), dtype=np.int16)
    here = np.arange(len(grid_deg), dtype=np.int16)
    for number, cell_wh in enumerate(cells_wh):
        came_from[number] = here
        best, where = _running_best(value)
        moved = best[:-1, :-1] > value[1:, 1:]
        value[1:, 1:] = np.where(moved, best[:-1, :-1], value[1:, 1:])
        came_from[number, 1:, 1:] = np.where(moved, where[:-1, :-1], came_from[number, 1:, 1:])
        value += cell_wh
    value += 2.0 * limits.degree_wh * grid_deg
    return tuple(grid_deg[_trace(came_from, value, count)] for count in range(most_steps + 1))


def _cells(day: SolarDay, grid_deg: Array, limits: Limits, tilt_deg: float | None) -> Array:
    """Return the electric energy of every short span of the day at every angle of the grid, Wh."""
    count = max(1, ceil((day.end_h - day.begin_h) / CELL_H))
    edges_h = np.linspace(day.begin_h, day.end_h, count + 1)
    at_h = ((edges_h[:-1] + edges_h[1:]) / 2)[:, None]
    ideal_deg = day.latitude_deg - day.declination_deg
    panel_deg = panel_declination_deg(day.latitude_deg, ideal_deg if tilt_deg is None else tilt_deg)
    facing = cos_incidence(grid_deg, panel_deg, hour_angle_deg(at_h), day.declination_deg)
    span_h = (day.end_h - day.begin_h) / count
    return np.asarray(limits.per_whm2 * span_h * day.beam(at_h) * np.maximum(facing, 0.0))


def _running_best(value: Array) -> tuple[Array, NDArray[np.int16]]:
    """Return for every angle the best value of it and all before it, and at which angle that is."""
    best = np.maximum.accumulate(value, axis=1)
    at_best = np.where(value == best, np.arange(value.shape[1], dtype=np.int16), np.int16(0))
    return best, np.maximum.accumulate(at_best, axis=1)


def _trace(came_from: NDArray[np.int16], value: Array, count: int) -> list[int]:
    """Return the indices of the angles of the best program with so many steps, from evening to morning."""
    at = int(value[count].argmax())
    visited, left = [at], count
    for row in came_from[::-1]:
        before = int(row[left, at])
        if before != at:
            visited.append(before)
            at, left = before, left - 1
    return visited[::-1]


def _refined(day: SolarDay, angles_deg: Array, limits: Limits, tilt_deg: float | None) -> tuple[Steps, ...]:
    """Return the program in which angles and instants are each the best for the other; none if it is none."""
    if day.end_h <= day.begin_h:
        return ()
    at_h, cosines, sines = _moments(day)
    facing = _facing(day, limits, tilt_deg)
    for _ in range(ROUNDS):
        switch_h = NOON_H - (angles_deg[:-1] + angles_deg[1:]) / (2 * DEGREES_AN_HOUR)
        edges_h = np.concatenate(([day.begin_h], np.clip(switch_h, day.begin_h, day.end_h), [day.end_h]))
        along = facing * np.diff(np.interp(edges_h, at_h, cosines))
        across = facing * np.diff(np.interp(edges_h, at_h, sines))
        better_deg = _centres(along, across, angles_deg, limits)
        settled = np.abs(better_deg - angles_deg).max() < SETTLED_DEG
        angles_deg = better_deg
        if settled:
            break
    if any(after > before for before, after in pairwise(angles_deg.tolist())):
        return ()
    try:
        return (_program(day, angles_deg, limits, tilt_deg),)
    except ValueError:
        return ()


def _facing(day: SolarDay, limits: Limits, tilt_deg: float | None) -> float:
    """Return what 1 Wh/m2 of beam is worth per cosine of the hour angle between panel and sun, Wh."""
    ideal_deg = day.latitude_deg - day.declination_deg
    panel_deg = panel_declination_deg(day.latitude_deg, ideal_deg if tilt_deg is None else tilt_deg)
    return limits.per_whm2 * float(np.cos(panel_deg * PER_DEGREE) * np.cos(day.declination_deg * PER_DEGREE))


def _moments(day: SolarDay) -> tuple[Array, Array, Array]:
    """Return instants, and the beam times cosine and sine of the hour angle summed up to each."""
    edges_h = np.linspace(day.begin_h, day.end_h, FINE_CELLS + 1)
    at_h = (edges_h[:-1] + edges_h[1:]) / 2
    beam_wh = day.beam(at_h) * (day.end_h - day.begin_h) / FINE_CELLS
    angle = hour_angle_deg(at_h) * PER_DEGREE
    cosines = np.concatenate(([0.0], np.cumsum(beam_wh * np.cos(angle))))
    sines = np.concatenate(([0.0], np.cumsum(beam_wh * np.sin(angle))))
    return edges_h, cosines, sines


def _centres(along: Array, across: Array, angles_deg: Array, limits: Limits) -> Array:
    """Return the best angle of each resting place within the range; one without light stays as it is.

    The first and the last also carry the price of travel, there and back: their best angle lies nearer to
    noon by the arcsine of the price over the light.
    """
    light = np.hypot(along, across)
    lit = light > 1e-9 * max(float(light.max()), 1e-12)
    centre_deg = np.where(lit, np.arctan2(across, along) * PER_RADIAN, angles_deg)
    if len(centre_deg) > 1 and limits.degree_wh > 0.0:
        price = 2.0 * limits.degree_wh * PER_RADIAN
        for end, sign in ((0, -1.0), (-1, 1.0)):
            if lit[end]:
                centre_deg[end] += sign * PER_RADIAN * np.arcsin(min(1.0, price / light[end]))
    return np.clip(centre_deg, -limits.range_deg, limits.range_deg)
