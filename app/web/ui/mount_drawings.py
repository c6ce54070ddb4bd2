"""The pictures of a mount: the year's sun in reach and beyond it, rows turned back, an actuator's stroke."""

from datetime import date
from functools import lru_cache
from math import acos, cos, degrees, radians, sin

import numpy as np
from numpy.typing import NDArray

from app.sun.position import Location, SunPath
from app.sun.trigonometry import SCALAR, Array
from app.tracker.config import Rows, TrackerConfig
from app.tracker.mounts.backtracking import backtracked_deg
from app.tracker.mounts.reach import reached
from app.tracker.transmission import LinearActuator
from app.web.mount_contexts import ActuatorPlot, RowsDrawing, YearDiagram
from app.web.ui.drawings import Curve, Tick
from app.web.ui.sunpath import HORIZON, MONTHS, broken, day_path, outline

LIT_SHARE = 0.6
LOWEST_SUN_DEG = 88.0
ROW_GAP = 150.0
RAY = 190.0
GROUND, DEPTH = 160.0, 58.0
LEFT, RIGHT, TOP, BOTTOM = 66.0, 594.0, 46.0, 246.0
POINTS = 121
MOST_MARKS = 7
STEPS = (1, 2, 5, 10, 20, 25, 50, 100, 200, 500)


@lru_cache(maxsize=32)
def year_diagram(config: TrackerConfig, location: Location, year: int) -> YearDiagram:
    """Return the sun of seven days of the year, solid where the tracker can face it and dashed beyond."""
    within, beyond = [], []
    for month, day, strong in MONTHS:
        path = day_path(config.algorithm, location, date(year, month, day))
        missed, _ = reached(config, path)
        within.append(Curve(f"{month}-{day}", _drawn(path, ~missed), strong))
        beyond.append(Curve(f"{month}-{day}", _drawn(path, missed), strong))
    title = f"The sun of {year} and the sky that the panel can face, seen from above, north up"
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
    words = (
        f"Panel width {rows.ground_coverage_ratio:g} of the row spacing: with the sun "
        f"{90 - sun_deg:.1f}° high on the right, the panels turn back from {sun_deg:.1f}° to "
        f"{back_deg:.1f}°, so that no row shades the next."
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
    x = LEFT + (RIGHT - LEFT) * (angles_deg - low_deg) / (high_deg - low_deg)
    shown = np.ones(POINTS, dtype=np.bool_)
    return ActuatorPlot(
        title=f"{title}: stroke and transmission angle",
        stroke=broken(x, _high(strokes_mm, actuator.travel_mm), shown),
        transmission=broken(x, _high(sharp_deg, 180.0), shown),
        angles=_marks(low_deg, high_deg, LEFT, RIGHT),
        strokes=_marks(0.0, actuator.travel_mm, BOTTOM, TOP),
        transmissions=_marks(0.0, 180.0, BOTTOM, TOP),
        words=(
            f"The stroke of {actuator.travel_mm:g} mm turns the axis from {low_deg:.2f} to "
            f"{high_deg:.2f}°; at {actuator.speed_mm_s:g} mm/s, the axis turns at no less than "
            f"{actuator.slowest_dps(low_deg, high_deg):.3f}°/s."
        ),
    )


def _drawn(path: SunPath, shown: NDArray[np.bool_]) -> str:
    radius = HORIZON * (90.0 - path.elevation_deg) / 90.0
    turn = np.radians(path.azimuth_deg)
    near = shown | np.roll(shown, 1) | np.roll(shown, -1)
    return broken(radius * np.sin(turn), -radius * np.cos(turn), near & (path.elevation_deg >= 0.0))


def _panel(axis: tuple[float, float], rotation_deg: float, width: float) -> str:
    """Return a panel from the end of its axis; it faces up and, turned, to the right."""
    turn = radians(rotation_deg)
    x, y = width / 2 * cos(turn), width / 2 * sin(turn)
    return f"M{axis[0] - x:.1f} {axis[1] - y:.1f}L{axis[0] + x:.1f} {axis[1] + y:.1f}"


def _high(values: Array, most: float) -> Array:
    return np.asarray(BOTTOM - (BOTTOM - TOP) * values / most, dtype=np.float64)


def _marks(low: float, high: float, at_low: float, at_high: float) -> tuple[Tick, ...]:
    step = next((step for step in STEPS if (high - low) / step <= MOST_MARKS), STEPS[-1])
    marks = np.arange(np.ceil(low / step) * step, high + 1e-6, step).tolist()
    return tuple(
        Tick(round(at_low + (at_high - at_low) * (mark - low) / (high - low), 1), f"{mark:g}")
        for mark in marks
    )
