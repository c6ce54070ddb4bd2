"""A plain chart with linear axes: curves, each with its own dashes, or bars side by side."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, floor, log10

from app.web.ui.drawings import Tick

LEFT, RIGHT, TOP, BOTTOM = 84.0, 1060.0, 44.0, 340.0
MOST_TICKS = 6
NICE = (1.0, 2.0, 2.5, 5.0, 10.0)


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
class Scale:
    """A second axis upwards, at the right: its name with unit, and its numbers."""

    upwards: str
    rows: tuple[Tick, ...]


@dataclass(frozen=True, slots=True)
class Plot:
    """A chart ready for its template: title, names of its axes with units, grid, curves and bars."""

    title: str
    across: str
    upwards: str
    columns: tuple[Tick, ...]
    rows: tuple[Tick, ...]
    lines: tuple[PlotLine, ...]
    bars: tuple[PlotBars, ...] = ()
    right: Scale | None = None


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
    right: tuple[str, Sequence[Curve]] | None = None,
) -> Plot:
    """Return curves over one axis; `marks` number the axis across from its first to its last.

    The axis upwards goes from `low`, or from below the least value where that is lower. `right` names a
    second axis upwards, from zero, and gives its curves.
    """
    rows = _rows(curves, low)
    lines = _lines(curves, rows, marks, 1)
    second = None
    if right is not None:
        second_rows = _rows(right[1], 0.0)
        second = Scale(right[0], _numbered(second_rows))
        lines += _lines(right[1], second_rows, marks, len(curves) + 1)
    columns = tuple(Tick(round(_across(mark, marks), 1), f"{mark:g}") for mark in marks)
    return Plot(title, across, upwards, columns, _numbered(rows), lines, right=second)


def bar_plot(
    title: str,
    across: str,
    upwards: str,
    names: Sequence[str],
    kinds: Sequence[tuple[str, Sequence[float]]],
    low: float = 0.0,
) -> Plot:
    """Return bars side by side in one group a name, from `low` upwards."""
    rows = nice_ticks(low, max([low + 1e-3, *(value for _, values in kinds for value in values)]))
    group = (RIGHT - LEFT) / len(names)
    width = 0.8 * group / len(kinds)
    bars = []
    for number, (label, values) in enumerate(kinds):
        begin = LEFT + 0.1 * group + number * width
        boxes = [
            f"M{begin + index * group:.1f} {BOTTOM}V{_height(value, rows):.1f}h{width:.1f}V{BOTTOM}z"
            for index, value in enumerate(values)
        ]
        bars.append(PlotBars(label, number + 1, "".join(boxes)))
    columns = tuple(Tick(round(LEFT + (index + 0.5) * group, 1), name) for index, name in enumerate(names))
    return Plot(title, across, upwards, columns, _numbered(rows), (), tuple(bars))


def nice_ticks(least: float, most: float) -> tuple[float, ...]:
    """Return round numbers from at or below the least to at or above the most value."""
    rough = max(most - least, 1e-9) / (MOST_TICKS - 1)
    power = 10.0 ** floor(log10(rough))
    step = next(nice * power for nice in NICE if nice * power >= rough * (1 - 1e-9))
    first, last = floor(least / step + 1e-9), ceil(most / step - 1e-9)
    return tuple(number * step for number in range(first, max(first + 1, last) + 1))


def _rows(curves: Sequence[Curve], low: float) -> tuple[float, ...]:
    values = [value for _, _, column in curves for value in column]
    return nice_ticks(min([low, *values]), max([low + 1.0, *values]))


def _lines(
    curves: Sequence[Curve], rows: Sequence[float], marks: Sequence[float], dashes: int
) -> tuple[PlotLine, ...]:
    """Return the curves that have any points, numbered by their dashes from a first number on."""

    def place(x: float, y: float) -> str:
        return f"{_across(x, marks):.1f} {_height(y, rows):.1f}"

    return tuple(
        PlotLine(label, number, "M" + "L".join(place(x, y) for x, y in zip(xs, ys, strict=True)))
        for number, (label, xs, ys) in enumerate(curves, start=dashes)
        if len(xs)
    )


def _across(place: float, marks: Sequence[float]) -> float:
    return LEFT + (RIGHT - LEFT) * (place - marks[0]) / (marks[-1] - marks[0])


def _height(value: float, rows: Sequence[float]) -> float:
    return BOTTOM - (BOTTOM - TOP) * (value - rows[0]) / (rows[-1] - rows[0])


def _numbered(rows: Sequence[float]) -> tuple[Tick, ...]:
    return tuple(Tick(round(_height(row, rows), 1), f"{row:g}".replace("-", "−")) for row in rows)
