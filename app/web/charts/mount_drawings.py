"""The pictures of a mount: the year's sun in reach and beyond it, rows turned back, an actuator's stroke."""

from datetime import date
from functools import lru_cache
from math import acos, cos, degrees, radians, sin

import numpy as np
from numpy.typing import NDArray

from app.base.message import say, with_format
from app.sun.position import Location, SunPath
from app.sun.trigonometry import SCALAR
from app.tracker.mounts.backtracking import backtracked_deg
from app.tracker.mounts.reach import reached
from app.tracker.settings.config import Rows, TrackerConfig
from app.tracker.settings.transmission import LinearActuator
from app.web.charts.axis import Box, angle_step, number, within
from app.web.charts.drawings import ActuatorPlot, Curve, RowsDrawing, YearDiagram
from app.web.charts.path import line
from app.web.charts.sunpath import MONTHS, day_path, outline, point

LIT_SHARE = 0.6
LOWEST_SUN_DEG = 88.0
ROW_GAP = 150.0
RAY = 190.0
GROUND, DEPTH = 160.0, 58.0
BOX = Box(66.0, 594.0, 46.0, 246.0)
POINTS = 121
MOST_PARTS = 7


@lru_cache(maxsize=32)
def year_diagram(config: TrackerConfig, location: Location, year: int) -> YearDiagram:
    """Return the sun of seven days of the year, solid where the tracker can face it and dashed beyond."""
    within, beyond = [], []
    for month, day, strong in MONTHS:
        path = day_path(config.algorithm, location, date(year, month, day))
        missed, _ = reached(config, path)
        within.append(Curve(f"{month}-{day}", _drawn(path, ~missed), strong))
        beyond.append(Curve(f"{month}-{day}", _drawn(path, missed), strong))
    title = say("The sun of {year} and the sky that the panel can face, seen from above, north up", year=year)
    return YearDiagram(outline(config), tuple(within), tuple(beyond), title)


def rows_drawing(rows: Rows) -> RowsDrawing:
    """Return two rows turned back from a low sun on the right, and where they would face it."""
    slope, sun_deg = radians(rows.cross_axis_tilt_deg), _low_sun_deg(rows)
    back_deg = backtracked_deg(rows, sun_deg, SCALAR)
    width = ROW_GAP * rows.ground_coverage_ratio
    axes = [(x * cos(slope), x * sin(slope)) for x in (-ROW_GAP / 2, ROW_GAP / 2)]
    panels = "".join(_panel(axis, back_deg, width) for axis in axes)
    facing = "".join(_panel(axis, sun_deg, width) for axis in axes)
    turn = radians(back_deg)
    edge_x, edge_y = axes[1][0] - width / 2 * cos(turn), axes[1][1] - width / 2 * sin(turn)
    sun = radians(sun_deg)
    ray = (
        f"M{edge_x + RAY * sin(sun):.1f} {edge_y - RAY * cos(sun):.1f}"
        f"L{edge_x - RAY * sin(sun):.1f} {edge_y + RAY * cos(sun):.1f}"
    )
    along_x, along_y = GROUND * cos(slope), GROUND * sin(slope)
    ground = f"M{-along_x:.1f} {DEPTH - along_y:.1f}L{along_x:.1f} {DEPTH + along_y:.1f}"
    words = say(
        "Panel width {ground_coverage_ratio} of the row spacing: with the sun {value}° high "
        "on the right, the panels turn back from {sun_deg}° to {back_deg}°, so that no row "
        "shades the next.",
        ground_coverage_ratio=with_format(rows.ground_coverage_ratio, "g"),
        value=with_format(90 - sun_deg, ".1f"),
        sun_deg=with_format(sun_deg, ".1f"),
        back_deg=with_format(back_deg, ".1f"),
    )
    return RowsDrawing(panels, facing, ray, ground, words)


def _low_sun_deg(rows: Rows) -> float:
    """Return a rotation towards a sun so low that six tenths of each panel would be out of the shade."""
    slope_deg = rows.cross_axis_tilt_deg
    lit = LIT_SHARE * rows.ground_coverage_ratio * cos(radians(slope_deg))
    return min(LOWEST_SUN_DEG, slope_deg + degrees(acos(lit)))


def actuator_plot(title: str, actuator: LinearActuator) -> ActuatorPlot:
    """Return stroke (left scale) and transmission angle (right scale) over the whole stroke."""
    low_deg, high_deg = actuator.range_deg
    angles_deg = np.linspace(low_deg, high_deg, POINTS)
    strokes_mm = np.array([actuator.stroke_mm(angle) for angle in angles_deg.tolist()])
    sharp_deg = np.array([actuator.transmission_deg(angle) for angle in angles_deg.tolist()])
    x, stroke = BOX.across(low_deg, high_deg), BOX.upwards(0.0, actuator.travel_mm)
    sharpness, across = BOX.upwards(0.0, 180.0), x.at(angles_deg)
    return ActuatorPlot(
        box=BOX,
        title=say("{title}: stroke and transmission angle", title=title),
        stroke=line(across, stroke.at(strokes_mm)),
        transmission=line(across, sharpness.at(sharp_deg)),
        angles=x.ticks(within(low_deg, high_deg, MOST_PARTS, angle_step), number),
        strokes=stroke.ticks(within(0.0, actuator.travel_mm, MOST_PARTS), number),
        transmissions=sharpness.ticks(within(0.0, 180.0, MOST_PARTS, angle_step), number),
        words=(
            say(
                "The stroke of {travel_mm} mm turns the axis from {low_deg} to {high_deg}°; at "
                "{speed_mm_s} mm/s, the axis turns at no less than {low_deg2}°/s.",
                travel_mm=with_format(actuator.travel_mm, "g"),
                low_deg=with_format(low_deg, ".2f"),
                high_deg=with_format(high_deg, ".2f"),
                speed_mm_s=with_format(actuator.speed_mm_s, "g"),
                low_deg2=with_format(actuator.slowest_dps(low_deg, high_deg), ".3f"),
            )
        ),
    )


def _drawn(path: SunPath, shown: NDArray[np.bool_]) -> str:
    near = shown | np.roll(shown, 1) | np.roll(shown, -1)
    return line(*point(path.azimuth_deg, path.elevation_deg), near & (path.elevation_deg >= 0.0))


def _panel(axis: tuple[float, float], rotation_deg: float, width: float) -> str:
    """Return a panel from the end of its axis; it faces up and, turned, to the right."""
    turn = radians(rotation_deg)
    x, y = width / 2 * cos(turn), width / 2 * sin(turn)
    return f"M{axis[0] - x:.1f} {axis[1] - y:.1f}L{axis[0] + x:.1f} {axis[1] + y:.1f}"
