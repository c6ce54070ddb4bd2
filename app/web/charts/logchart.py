"""A chart of many curves over one axis, separations in degrees on a logarithmic one."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import isnan, log10

from app.sun.trigonometry import Array
from app.web.charts.axis import Box, Tick, degrees

BOX = Box(84.0, 716.0, 44.0, 380.0)
LOWEST, HIGHEST = -3, 1
"""Powers of ten of the ends of the axis upwards."""
UP = BOX.upwards(LOWEST, HIGHEST)
LABEL_GAP = 26.0


@dataclass(frozen=True, slots=True)
class LogLine:
    """A curve: its name, the number of its dashes, SVG path data, its last point, the height of its name."""

    label: str
    dashes: int
    path: str
    end_x: float
    end_y: float
    label_at: float


@dataclass(frozen=True, slots=True)
class LogChart:
    """A chart ready for its template: title, name of the axis across, grid, curves from top to bottom."""

    box: Box
    title: str
    across: str
    columns: tuple[Tick, ...]
    rows: tuple[Tick, ...]
    lines: tuple[LogLine, ...]


def log_chart(
    title: str, across: str, marks: Sequence[tuple[float, str]], x: Array, curves: Sequence[tuple[str, Array]]
) -> LogChart:
    """Return a chart; `marks` number the axis from its first to its last, NaN breaks a curve."""
    scale = BOX.across(marks[0][0], marks[-1][0])
    across_px = scale.at(x).tolist()
    drawn = [_line(label, number, across_px, y.tolist()) for number, (label, y) in enumerate(curves, start=1)]
    drawn.sort(key=lambda line: line.end_y)
    heights = _spread([line.end_y for line in drawn])
    return LogChart(
        box=BOX,
        title=title,
        across=across,
        columns=tuple(Tick(round(scale.at(value), 1), text) for value, text in marks),
        rows=UP.ticks(range(LOWEST, HIGHEST + 1), lambda power: degrees(10.0**power)),
        lines=tuple(replace(line, label_at=at) for line, at in zip(drawn, heights, strict=True)),
    )


def _height(value: float) -> float:
    return UP.at(log10(min(10.0**HIGHEST, max(10.0**LOWEST, value))))


def _line(label: str, dashes: int, x: list[float], y: list[float]) -> LogLine:
    """Return a curve whose name stands at its end."""
    path, pen_down, end = [], False, (BOX.left, BOX.bottom)
    for at_x, value in zip(x, y, strict=True):
        if not isnan(value):
            end = (round(at_x, 1), round(_height(value), 1))
            path.append(f"{'L' if pen_down else 'M'}{end[0]} {end[1]}")
        pen_down = not isnan(value)
    return LogLine(label, dashes, "".join(path), *end, end[1])


def _spread(ends: list[float]) -> list[float]:
    """Return heights for the names, in the order of the ends, none nearer to the next than a line of text."""
    places = list(ends)
    for upper, lower in pairwise(range(len(places))):
        places[lower] = max(places[lower], places[upper] + LABEL_GAP)
    over = max(0.0, places[-1] - BOX.bottom) if places else 0.0
    for lower in reversed(range(len(places))):
        places[lower] = (
            min(places[lower], BOX.bottom - LABEL_GAP * (len(places) - 1 - lower)) if over else places[lower]
        )
    return [round(place, 1) for place in places]
