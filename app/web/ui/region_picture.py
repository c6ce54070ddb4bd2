"""Forbidden regions drawn to scale on the two axes: one degree is as long across as it is upwards."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from app.tracker.config import TrackerConfig
from app.tracker.memory import Pointing
from app.tracker.mount import aim
from app.tracker.orientation import Orientation
from app.tracker.protections.machine_config import Region
from app.web.contexts import Arc
from app.web.ui.drawings import Tick

WIDE, HIGH = 900.0, 460.0
LEFT, TOP, BELOW, RIGHT = 84.0, 44.0, 64.0, 24.0
PAD_DEG = 6.0
STEPS_DEG = (5.0, 10.0, 15.0, 30.0, 45.0, 60.0, 90.0)
MOST_TICKS = 14
BREAK_DEG = 60.0
Point = tuple[float, float]
Place = Callable[[float, float], Point]


@dataclass(frozen=True, slots=True)
class Shape:
    """A region: its name with its place, and its outline as SVG path data."""

    name: str
    x: float
    y: float
    path: str


@dataclass(frozen=True, slots=True)
class RegionPicture:
    """The picture ready for its template, in units of its view box.

    An angle lies at `left + (azimuth - azimuth_deg) * scale` and `bottom - (elevation - elevation_deg) *
    scale`. `limits` is the rectangle of the soft limits, `sun` the way that today's sun leads the axes.
    """

    width: float
    height: float
    left: float
    bottom: float
    right: float
    top: float
    azimuth_deg: float
    elevation_deg: float
    scale: float
    columns: tuple[Tick, ...]
    rows: tuple[Tick, ...]
    limits: str
    regions: tuple[Shape, ...]
    sun: str


def region_picture(
    config: TrackerConfig, regions: Sequence[Region], pointing: Pointing, arc: Arc
) -> RegionPicture:
    """Return the soft limits, the forbidden regions, and where today's sun leads the axes."""
    way = _way(config, pointing, arc)
    (west, east), (low, high) = _window(config, regions)
    scale = min(WIDE / (east - west), HIGH / (high - low))
    bottom = TOP + (high - low) * scale

    def place(azimuth_deg: float, elevation_deg: float) -> Point:
        return LEFT + (azimuth_deg - west) * scale, bottom - (elevation_deg - low) * scale

    right = LEFT + (east - west) * scale
    return RegionPicture(
        width=right + RIGHT,
        height=bottom + BELOW,
        left=LEFT,
        bottom=bottom,
        right=right,
        top=TOP,
        azimuth_deg=west,
        elevation_deg=low,
        scale=scale,
        columns=tuple(Tick(round(place(deg, low)[0], 1), _degrees(deg)) for deg in _ticks(west, east)),
        rows=tuple(Tick(round(place(west, deg)[1], 1), _degrees(deg)) for deg in _ticks(low, high)),
        limits=_closed(place(*corner) for corner in _rectangle(config)),
        regions=tuple(_shape(region, place) for region in regions),
        sun=_open(way, place),
    )


def _window(
    config: TrackerConfig, regions: Sequence[Region]
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return what of each axis is drawn: the soft limits and every region, with a margin."""
    corners = [corner for region in regions for corner in region.corners]
    azimuths = [config.azimuth.minimum_deg, config.azimuth.maximum_deg, *(one.azimuth_deg for one in corners)]
    elevations = [
        config.elevation.minimum_deg,
        config.elevation.maximum_deg,
        *(one.elevation_deg for one in corners),
    ]
    return (
        (min(azimuths) - PAD_DEG, max(azimuths) + PAD_DEG),
        (min(elevations) - PAD_DEG, max(elevations) + PAD_DEG),
    )


def _rectangle(config: TrackerConfig) -> tuple[Point, ...]:
    azimuth, elevation = config.azimuth, config.elevation
    return (
        (azimuth.minimum_deg, elevation.minimum_deg),
        (azimuth.maximum_deg, elevation.minimum_deg),
        (azimuth.maximum_deg, elevation.maximum_deg),
        (azimuth.minimum_deg, elevation.maximum_deg),
    )


def _way(config: TrackerConfig, pointing: Pointing, arc: Arc) -> list[Point]:
    """Return the axis angles that face the sun through today, within the soft limits."""
    way: list[Point] = []
    near_deg = config.azimuth.clamp(0.0)
    for azimuth_deg, elevation_deg in arc:
        if elevation_deg < 0.0:
            continue
        aimed = aim(config, pointing, Orientation(azimuth_deg, elevation_deg), near_deg)
        near_deg = aimed.azimuth_deg
        way.append((aimed.azimuth_deg, aimed.elevation_deg))
    return way


def _shape(region: Region, place: Place) -> Shape:
    corners = [place(one.azimuth_deg, one.elevation_deg) for one in region.corners]
    x, y = (sum(values) / len(corners) for values in zip(*corners, strict=True))
    return Shape(region.name, round(x, 1), round(y, 1), _closed(corners))


def _ticks(low: float, high: float) -> list[float]:
    step = next((one for one in STEPS_DEG if (high - low) / one <= MOST_TICKS), STEPS_DEG[-1])
    first = -(-low // step)
    return [number * step for number in range(int(first), int(high // step) + 1)]


def _degrees(value: float) -> str:
    return f"{value:g}°".replace("-", "−")


def _closed(corners: Iterable[Point]) -> str:
    return "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in corners) + "Z"


def _open(way: Sequence[Point], place: Place) -> str:
    """Return a line as SVG path data, broken where the axis turns all the way back."""
    if not way:
        return ""
    drawn = ["M{:.1f} {:.1f}".format(*place(*way[0]))]
    for before, after in pairwise(way):
        pen = "M" if abs(after[0] - before[0]) > BREAK_DEG else "L"
        drawn.append(pen + "{:.1f} {:.1f}".format(*place(*after)))
    return "".join(drawn)
