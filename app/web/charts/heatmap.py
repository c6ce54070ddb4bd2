"""A heat map of hour and day: darker where more falls on the panel, in a few shades of one colour."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import date

from app.base.message import N_, Message, say
from app.web.charts.axis import MONTHS, Box, Scale, Tick, multiples, number

BOX = Box(84.0, 1060.0, 44.0, 340.0)
HOURS, ROW_HOURS = 24, 6
CLASSES = 7
CLASS_WM2 = 150
WEEK = 7


@dataclass(frozen=True, slots=True)
class HeatClass:
    """One shade: its number from light to dark, what it stands for, SVG path data of its cells."""

    number: int
    label: str
    path: str


@dataclass(frozen=True, slots=True)
class HeatMap:
    """A heat map ready for its template: days across, hours upwards."""

    box: Box
    title: str
    across: str
    columns: tuple[Tick, ...]
    rows: tuple[Tick, ...]
    classes: tuple[HeatClass, ...]


def heat_map(title: str, days: Sequence[date], heat_wm2: Sequence[Sequence[int]]) -> HeatMap:
    """Return the map of a year by weeks, or of twelve days by days."""
    span = WEEK if len(days) > HOURS else 1
    starts = range(0, len(days), span)
    means = [_mean(heat_wm2[start : start + span]) for start in starts]
    x, y = BOX.across(0.0, len(means)), BOX.upwards(0.0, HOURS)
    edges_x = [round(x.at(float(column)), 1) for column in range(len(means) + 1)]
    edges_y = [round(y.at(float(hour)), 1) for hour in range(HOURS + 1)]
    paths = [""] * (CLASSES + 1)
    for column, hours in enumerate(means):
        for hour, mean in enumerate(hours):
            (left, right), (bottom, top) = edges_x[column : column + 2], edges_y[hour : hour + 2]
            paths[_class(mean)] += f"M{left:g} {top:g}H{right:g}V{bottom:g}H{left:g}z"
    return HeatMap(
        box=BOX,
        title=title,
        across=N_("week of the year") if span == WEEK else "day",
        columns=tuple(_months(days, starts, x)),
        rows=y.ticks(multiples(y.low, y.high, ROW_HOURS), number),
        classes=tuple(
            HeatClass(number, _label(number), path) for number, path in enumerate(paths) if number and path
        ),
    )


def _class(mean_wm2: float) -> int:
    """Return 0 for the dark, else 1 to 7."""
    return 0 if mean_wm2 < 1.0 else min(CLASSES, 1 + int(mean_wm2 / CLASS_WM2))


def _label(number: int) -> Message:
    low = (number - 1) * CLASS_WM2
    return (
        say("{low} W/m² and more", low=low)
        if number == CLASSES
        else say("{low} to {low2} W/m²", low=low, low2=low + CLASS_WM2)
    )


def _mean(rows: Sequence[Sequence[int]]) -> list[float]:
    return [sum(column) / len(rows) for column in zip(*rows, strict=True)]


def _months(days: Sequence[date], starts: range, x: Scale) -> list[Tick]:
    """Return a tick in the column in which each month's first shown day lies."""
    ticks, seen = [], 0
    for column, start in enumerate(starts):
        if days[start].month != seen:
            seen = days[start].month
            ticks.append(Tick(round(x.at(column + 0.5), 1), MONTHS[days[start].month - 1]))
    return ticks
