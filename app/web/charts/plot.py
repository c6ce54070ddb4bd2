"""A plain chart with linear axes: curves, each with its own dashes, or bars side by side."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.web.charts.axis import Box, Scale, StepOf, Tick, around, number, number_step
from app.web.charts.path import line

BOX = Box(84.0, 1060.0, 44.0, 340.0)
MOST_PARTS = 5


@dataclass(frozen=True, slots=True)
class PlotLine:
    """A curve: its name, the number of its dashes, SVG path data."""

    label: str
    dashes: int
    path: str


@dataclass(frozen=True, slots=True)
class PlotBars:
    """The bars of one kind: their name, the number of their pattern, SVG path data of all of them."""

    label: str
    pattern: int
    path: str


@dataclass(frozen=True, slots=True)
class RightAxis:
    """A second axis upwards, at the right: its name with unit, and its numbers."""

    upwards: str
    rows: tuple[Tick, ...]


@dataclass(frozen=True, slots=True)
class Plot:
    """A chart ready for its template: title, names of its axes with units, grid, curves and bars."""

    box: Box
    title: str
    across: str
    upwards: str
    columns: tuple[Tick, ...]
    rows: tuple[Tick, ...]
    lines: tuple[PlotLine, ...]
    bars: tuple[PlotBars, ...] = ()
    right: RightAxis | None = None


Curve = tuple[str, Sequence[float], Sequence[float]]
"""Name, places across, values upwards."""


def line_plot(
    title: str,
    across: str,
    upwards: str,
    marks: Sequence[float],
    curves: Sequence[Curve],
    *,
    low: float = 0.0,
    steps: StepOf = number_step,
    right: tuple[str, Sequence[Curve]] | None = None,
) -> Plot:
    """Return curves over one axis; `marks` number the axis across from its first to its last.

    The axis upwards goes in `steps` from `low`, or from below the least value where that is lower. `right`
    names a second axis upwards, from zero, and gives its curves.
    """
    x = BOX.across(marks[0], marks[-1])
    rows = _rows(curves, low, steps)
    lines = _lines(curves, x, rows, 1)
    second = None
    if right is not None:
        second_rows = _rows(right[1], 0.0, number_step)
        second = RightAxis(right[0], _numbered(second_rows))
        lines += _lines(right[1], x, second_rows, len(curves) + 1)
    return Plot(BOX, title, across, upwards, x.ticks(marks, number), _numbered(rows), lines, right=second)


def bar_plot(
    title: str,
    across: str,
    upwards: str,
    names: Sequence[str],
    kinds: Sequence[tuple[str, Sequence[float]]],
    low: float = 0.0,
) -> Plot:
    """Return bars side by side in one group a name, from `low` upwards."""
    rows = around(low, max([low + 1e-3, *(value for _, values in kinds for value in values)]), MOST_PARTS)
    x, y = BOX.across(0.0, len(names)), _scale(rows)
    share = 0.8 / len(kinds)
    width = x.at(share) - x.at(0.0)
    bars = []
    for place, (label, values) in enumerate(kinds):
        begin = 0.1 + place * share
        boxes = [
            f"M{x.at(index + begin):.1f} {BOX.bottom}V{y.at(value):.1f}h{width:.1f}V{BOX.bottom}z"
            for index, value in enumerate(values)
        ]
        bars.append(PlotBars(label, place + 1, "".join(boxes)))
    columns = tuple(Tick(round(x.at(index + 0.5), 1), name) for index, name in enumerate(names))
    return Plot(BOX, title, across, upwards, columns, _numbered(rows), (), tuple(bars))


def _rows(curves: Sequence[Curve], low: float, steps: StepOf) -> tuple[float, ...]:
    values = [value for _, _, column in curves for value in column]
    return around(min([low, *values]), max([low + 1.0, *values]), MOST_PARTS, steps)


def _scale(rows: Sequence[float]) -> Scale:
    return BOX.upwards(rows[0], rows[-1])


def _numbered(rows: Sequence[float]) -> tuple[Tick, ...]:
    return _scale(rows).ticks(rows, number)


def _lines(curves: Sequence[Curve], x: Scale, rows: Sequence[float], dashes: int) -> tuple[PlotLine, ...]:
    """Return the curves that have any points, numbered by their dashes from a first number on."""
    y = _scale(rows)
    return tuple(
        PlotLine(label, style, line(x.at(np.asarray(xs, dtype=float)), y.at(np.asarray(ys, dtype=float))))
        for style, (label, xs, ys) in enumerate(curves, start=dashes)
        if len(xs)
    )
