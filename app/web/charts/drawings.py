"""What the drawings on pages consist of, ready for their templates."""

from dataclasses import asdict, dataclass

import orjson

from app.tracker.settings.config import MountConfig
from app.web.charts.axis import Box, Scale, Tick, compass_letters, degrees, multiples

HORIZON = 100.0
SET_DEG = -0.9
"""The elevation at which the upper edge of the sun sets."""
HEIGHT = Scale(0.0, 90.0, HORIZON, 0.0)
"""Elevation from the rim to the middle of the sky seen from above."""
RING_DEG = 30.0
LETTERS_AT = ((0.0, -105.0), (110.0, 3.5), (0.0, 113.0), (-111.0, 3.5))
Arc = tuple[tuple[float, float], ...]
"""Azimuth and elevation along a path of the sky."""


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
class SkyGrid:
    """Heights as circles and the letters of the compass, under what is drawn on the sky from above."""

    rings: tuple[Tick, ...]
    letters: tuple[HourLabel, ...]


def sky_grid() -> SkyGrid:
    """Return the grid with the letters of the language."""
    letters = zip(LETTERS_AT, compass_letters(), strict=True)
    return SkyGrid(
        HEIGHT.ticks(multiples(RING_DEG, 90.0 - RING_DEG, RING_DEG), degrees),
        tuple(HourLabel(x, y, letter) for (x, y), letter in letters),
    )


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

    @property
    def grid(self) -> SkyGrid:
        """Return what lies under the curves."""
        return sky_grid()


@dataclass(frozen=True, slots=True)
class Cartesian:
    """The sun path with azimuth across and elevation up; `centre_deg` is the azimuth in its middle.

    `x` goes from the azimuth at its left end on, `y` from the horizon up.

    `reach` is a filled shape where `fills`, else an outline; `skyline` is empty where the horizon is flat.
    """

    box: Box
    x: Scale
    y: Scale
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
    box: Box
    panel: str
    sun: str
    ticks: tuple[Tick, ...]


@dataclass(frozen=True, slots=True)
class DayChart:
    """Azimuth and elevation against time; `nights` are left edge and width of spans without sun."""

    box: Box
    bands: tuple[Band, ...]
    hours: tuple[Tick, ...]
    nights: tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True)
class YearDiagram:
    """The year's sun, in reach and beyond it, over the part of the sky that the panel can face."""

    reachable: str
    within: tuple[Curve, ...]
    beyond: tuple[Curve, ...]
    title: str

    @property
    def grid(self) -> SkyGrid:
        """Return what lies under the curves."""
        return sky_grid()


@dataclass(frozen=True, slots=True)
class RowsDrawing:
    """Two rows from the end of their axes, turned back for a low sun; SVG path data and words."""

    panels: str
    facing: str
    ray: str
    ground: str
    words: str


@dataclass(frozen=True, slots=True)
class ActuatorPlot:
    """Stroke and transmission angle over the angle of an axis; SVG path data, grid and words."""

    box: Box
    title: str
    stroke: str
    transmission: str
    angles: tuple[Tick, ...]
    strokes: tuple[Tick, ...]
    transmissions: tuple[Tick, ...]
    words: str


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
    arc: Arc = ()
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
