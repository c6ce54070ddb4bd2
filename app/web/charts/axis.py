"""One axis under every drawing: where values lie on it, which numbers stand at it, how they are written.

`static/js/chart_axis.js` works out the same for curves that go on in the browser; a test proves it.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from math import ceil, floor, inf, log10
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from app.base.message import N_
from app.base.zones import zone_of
from app.web.languages import CATALOGUE

NUMBER_STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)
"""Round steps of a number, times a power of ten."""
ANGLE_STEPS_DEG = (1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0, 90.0)
"""Round steps of an angle; finer ones are those of a number."""
MINUTE_S, HOUR_S, DAY_S = 60, 3600, 86_400
TIME_STEPS_S = (
    1, 2, 5, 10, 15, 30,
    *(MINUTE_S * minutes for minutes in (1, 2, 5, 10, 15, 30)),
    *(HOUR_S * hours for hours in (1, 2, 3, 4, 6, 12)),
    *(DAY_S * days for days in (1, 2, 7)),
)  # fmt: skip
"""Round steps of the time of day and of days, seconds."""
DAY_HOURS = tuple(float(hour) for hour in range(0, 25, 3))
MONTHS = (
    N_("Jan"),
    N_("Feb"),
    N_("Mar"),
    N_("Apr"),
    N_("May"),
    N_("Jun"),
    N_("Jul"),
    N_("Aug"),
    N_("Sep"),
    N_("Oct"),
    N_("Nov"),
    N_("Dec"),
)
NEARLY = 1e-9
"""The share of a step by which a computer misses a round number."""

Place = TypeVar("Place", float, NDArray[np.float64])
StepOf = Callable[[float, int], float]
"""Returns the round step that divides a span into at most so many parts."""


@dataclass(frozen=True, slots=True)
class Tick:
    """A line of a chart's grid and its number."""

    at: float
    text: str


@dataclass(frozen=True, slots=True)
class Scale:
    """Where values lie: `low` at `start` and `high` at `end`, in units of the drawing."""

    low: float
    high: float
    start: float
    end: float

    def at(self, value: Place) -> Place:
        """Return where a value lies, or many."""
        return self.start + (self.end - self.start) * (value - self.low) / (self.high - self.low)

    def ticks(self, values: Iterable[float], text: Callable[[float], str]) -> tuple[Tick, ...]:
        """Return the lines of the grid at some values."""
        return tuple(Tick(round(self.at(value), 1), text(value)) for value in values)

    @property
    def data(self) -> str:
        """Return it as a script of the page reads it."""
        return f"{self.low:g} {self.high:g} {self.start:.6g} {self.end:.6g}"


@dataclass(frozen=True, slots=True)
class Box:
    """The frame of a chart, in units of the drawing."""

    left: float
    right: float
    top: float
    bottom: float

    @property
    def width(self) -> float:
        """Return how wide it is."""
        return self.right - self.left

    @property
    def height(self) -> float:
        """Return how high it is."""
        return self.bottom - self.top

    @property
    def middle(self) -> tuple[float, float]:
        """Return its middle across and upwards."""
        return (self.left + self.right) / 2, (self.top + self.bottom) / 2

    def across(self, low: float, high: float) -> Scale:
        """Return an axis from left to right."""
        return Scale(low, high, self.left, self.right)

    def upwards(self, low: float, high: float) -> Scale:
        """Return an axis from the bottom up."""
        return Scale(low, high, self.bottom, self.top)


def number_step(span: float, most: int) -> float:
    """Return the least round step that divides a span into at most so many parts."""
    rough = max(span, NEARLY) / most
    power = 10.0 ** floor(log10(rough))
    return next(step * power for step in NUMBER_STEPS if step * power >= rough * (1 - NEARLY))


def angle_step(span_deg: float, most: int) -> float:
    """Return the same for an angle, whose round steps divide a quarter of a turn."""
    if span_deg / most <= ANGLE_STEPS_DEG[0] / 2:
        return number_step(span_deg, most)
    return _least(ANGLE_STEPS_DEG, span_deg, most)


def time_step_s(span_s: float, most: int) -> float:
    """Return the same for a span of time."""
    return _least(TIME_STEPS_S, span_s, most)


def _least(steps: Sequence[float], span: float, most: int) -> float:
    return next((step for step in steps if span / step <= most * (1 + NEARLY)), steps[-1])


def multiples(low: float, high: float, step: float) -> tuple[float, ...]:
    """Return the multiples of a step from one value to another."""
    first, last = ceil(low / step - NEARLY), floor(high / step + NEARLY)
    return tuple(round(number * step, 9) for number in range(first, last + 1))


def within(low: float, high: float, most: int, step_of: StepOf = number_step) -> tuple[float, ...]:
    """Return round values between two."""
    return multiples(low, high, step_of(high - low, most))


def around(least: float, greatest: float, most: int, step_of: StepOf = number_step) -> tuple[float, ...]:
    """Return round values from at or below the least to at or above the greatest."""
    step = step_of(greatest - least, most)
    first, last = floor(least / step + NEARLY), ceil(greatest / step - NEARLY)
    return tuple(round(number * step, 9) for number in range(first, max(first + 1, last) + 1))


def times(begin_s: float, end_s: float, most: int, zone: str) -> tuple[float, ...]:
    """Return instants between two, in Unix seconds, at which the clocks of a zone show round times."""
    step_s = time_step_s(end_s - begin_s, most)
    found: list[float] = []
    local_s = ceil((begin_s + _offset_s(begin_s, zone)) / step_s) * step_s
    while (at := local_s - _offset_s(local_s - _offset_s(local_s, zone), zone)) <= end_s:
        if at >= begin_s and at > max(found, default=-inf):
            found.append(at)
        local_s += step_s
    return tuple(found)


def _offset_s(at_s: float, zone: str) -> float:
    offset = datetime.fromtimestamp(at_s, UTC).astimezone(zone_of(zone)).utcoffset()
    return offset.total_seconds() if offset else 0.0


def number(value: float) -> str:
    """Return a number at an axis as the language writes it."""
    return CATALOGUE.get().number(f"{value + 0.0:g}").replace("-", "−")


def degrees(value: float) -> str:
    """Return an angle at an axis."""
    return number(value) + "°"


def azimuth(value: float) -> str:
    """Return an azimuth at an axis, with the letter of each quarter of the compass."""
    if value % 90:
        return degrees(value)
    return f"{degrees(value)} {compass_letters()[round(value / 90) % 4]}"


def compass_letters() -> tuple[str, ...]:
    """Return the letters of north, east, south and west."""
    return CATALOGUE.get().language.compass[::4]


def time_of_day(at_s: float, zone: str) -> str:
    """Return hours and minutes of an instant."""
    return datetime.fromtimestamp(at_s, zone_of(zone)).strftime("%H:%M")
