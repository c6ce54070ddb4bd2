"""Forbidden regions drawn to scale on the two axes: one degree is as long across as it is upwards."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.tracker.memory.memory import Pointing
from app.tracker.mounts.mount import aim
from app.tracker.settings.config import TrackerConfig
from app.tracker.settings.mechanics import Region
from app.tracker.values.orientation import Orientation
from app.web.charts.axis import Box, Scale, Tick, angle_step, degrees, within
from app.web.charts.drawings import Arc
from app.web.charts.path import closed, line

WIDE, HIGH = 900.0, 460.0
LEFT, TOP, BELOW, RIGHT = 84.0, 44.0, 64.0, 24.0
PAD_DEG = 6.0
MOST_PARTS = 14
BREAK_DEG = 60.0
Point = tuple[float, float]


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

    `limits` is the rectangle of the soft limits, `sun` the way that today's sun leads the axes.
    """

    width: float
    height: float
    box: Box
    x: Scale
    y: Scale
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
    box = Box(LEFT, LEFT + (east - west) * scale, TOP, TOP + (high - low) * scale)
    x, y = box.across(west, east), box.upwards(low, high)
    return RegionPicture(
        width=box.right + RIGHT,
        height=box.bottom + BELOW,
        box=box,
        x=x,
        y=y,
        columns=x.ticks(within(west, east, MOST_PARTS, angle_step), degrees),
        rows=y.ticks(within(low, high, MOST_PARTS, angle_step), degrees),
        limits=closed((x.at(azimuth), y.at(elevation)) for azimuth, elevation in _rectangle(config)),
        regions=tuple(_shape(region, x, y) for region in regions),
        sun=_open(way, x, y),
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


def _shape(region: Region, x: Scale, y: Scale) -> Shape:
    corners = [(x.at(one.azimuth_deg), y.at(one.elevation_deg)) for one in region.corners]
    middle_x, middle_y = (sum(values) / len(corners) for values in zip(*corners, strict=True))
    return Shape(region.name, round(middle_x, 1), round(middle_y, 1), closed(corners))


def _open(way: Sequence[Point], x: Scale, y: Scale) -> str:
    """Return a line as SVG path data, broken where the axis turns all the way back."""
    if not way:
        return ""
    azimuth_deg, elevation_deg = np.array(way).T
    breaks = np.flatnonzero(np.abs(np.diff(azimuth_deg)) > BREAK_DEG) + 1
    pieces = zip(np.split(x.at(azimuth_deg), breaks), np.split(y.at(elevation_deg), breaks), strict=True)
    return "".join(line(*piece) for piece in pieces)
