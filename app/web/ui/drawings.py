"""What the drawings on pages consist of, ready for their templates."""

from dataclasses import asdict, dataclass

import orjson

from app.tracker.config import MountConfig


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
    """The polar sun path, north up, on a circle of radius 100 about the origin.

    `skyline` is what the entered horizon hides; it is empty where the horizon is flat.
    """

    months: tuple[Curve, ...]
    hours: tuple[Curve, ...]
    labels: tuple[HourLabel, ...]
    today: Curve
    reachable: str
    title: str
    skyline: str = ""


@dataclass(frozen=True, slots=True)
class Tick:
    """A line of a chart's grid and its number."""

    at: float
    text: str


@dataclass(frozen=True, slots=True)
class Cartesian:
    """The sun path with azimuth across and elevation up; `centre_deg` is the azimuth in its middle.

    `reach` is a filled shape where `fills`, else an outline; `skyline` is empty where the horizon is flat.
    """

    centre_deg: float
    months: tuple[Curve, ...]
    hours: tuple[Curve, ...]
    labels: tuple[HourLabel, ...]
    today: Curve
    reach: str
    fills: bool
    skyline: str
    columns: tuple[Tick, ...]
    rows: tuple[Tick, ...]
    title: str


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


@dataclass(frozen=True, slots=True)
class Scene:
    """The still part of the moving picture; what moves in it comes with every snapshot.

    `first` and `second` are the ends of the axes, degrees, None where there is no such axis or its ends are
    not known; `yaw` is the azimuth from which one looks at first. `arc` and `horizon` are azimuth and
    elevation of the day's sun and of the skyline, `hours` also the hour.
    """

    mount: MountConfig
    first: tuple[float, float] | None
    second: tuple[float, float] | None
    yaw: float = 152.0
    arc: tuple[tuple[float, float], ...] = ()
    hours: tuple[tuple[str, float, float], ...] = ()
    horizon: tuple[tuple[float, float], ...] = ()

    @property
    def json(self) -> str:
        """Return it as the page's script reads it."""
        mount = {
            "kind": self.mount.kind.value,
            "axis_azimuth_deg": self.mount.axis_azimuth_deg,
            "axis_tilt_deg": self.mount.axis_tilt_deg,
        }
        return orjson.dumps(asdict(self) | {"mount": mount}).decode()
