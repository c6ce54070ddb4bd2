"""What the drawings on pages consist of, ready for their templates."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Curve:
    """A curve of the sun-path diagram: SVG path data, and whether it is a solstice or an equinox."""

    label: str
    path: str
    strong: bool


@dataclass(frozen=True, slots=True)
class HourLabel:
    """The number of an hour at its place in the diagram."""

    x: float
    y: float
    text: str


@dataclass(frozen=True, slots=True)
class SunDiagram:
    """The polar sun path, north up, on a circle of radius 100 about the origin."""

    months: tuple[Curve, ...]
    hours: tuple[Curve, ...]
    labels: tuple[HourLabel, ...]
    today: Curve
    reachable: str
    title: str


@dataclass(frozen=True, slots=True)
class Tick:
    """A line of a chart's grid and its number."""

    at: float
    text: str


@dataclass(frozen=True, slots=True)
class Band:
    """One quantity of a day chart: panel and sun as SVG path data, and its grid."""

    label: str
    top: float
    height: float
    panel: str
    sun: str
    ticks: tuple[Tick, ...]


@dataclass(frozen=True, slots=True)
class DayChart:
    """Azimuth and elevation against time; `nights` are left edge and width of spans without sun."""

    bands: tuple[Band, ...]
    hours: tuple[Tick, ...]
    nights: tuple[tuple[float, float], ...]
