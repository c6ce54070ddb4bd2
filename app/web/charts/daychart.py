"""The curves of a planned show as SVG: azimuth above, elevation below, nights shaded."""

import numpy as np
from numpy.typing import NDArray

from app.base.message import N_
from app.tracker.programs.show import ShowPath
from app.web.charts.axis import Box, angle_step, degrees, time_of_day, times, within
from app.web.charts.drawings import Band, DayChart
from app.web.charts.path import line

Array = NDArray[np.float64]
BOX = Box(46.0, 990.0, 8.0, 304.0)
AZIMUTH, ELEVATION = Box(BOX.left, BOX.right, 8.0, 146.0), Box(BOX.left, BOX.right, 166.0, 304.0)
MOST_HOURS, MOST_DEGREES = 13, 5


def chart(path: ShowPath, zone: str) -> DayChart | None:
    """Return the chart of a planned path, None where there is none to draw."""
    at_s = path.sun_time_unix_s
    if len(at_s) < 2:
        return None
    across = BOX.across(float(at_s[0]), float(at_s[-1]))
    x, up = across.at(at_s), path.sun_is_up
    hours = times(across.low, across.high, MOST_HOURS, zone)
    return DayChart(
        box=BOX,
        bands=(
            _band(N_("Azimuth"), AZIMUTH, x, path.panel_azimuth_deg, path.sun_azimuth_deg, up),
            _band(N_("Elevation"), ELEVATION, x, path.panel_elevation_deg, path.sun_elevation_deg, up),
        ),
        hours=across.ticks(hours, lambda instant_s: time_of_day(instant_s, zone)),
        nights=_nights(x, up),
    )


def _band(label: str, box: Box, x: Array, panel: Array, sun: Array, up: NDArray[np.bool_]) -> Band:
    seen = np.concatenate((panel, sun[up])) if up.any() else panel
    least, most = float(seen.min()), float(seen.max())
    room = max(2.0, (most - least) * 0.08)
    y = box.upwards(least - room, most + room)
    return Band(
        label=label,
        box=box,
        panel=line(x, y.at(panel)),
        sun=line(x, y.at(sun), up & _steady(sun)),
        ticks=y.ticks(within(y.low, y.high, MOST_DEGREES, angle_step), degrees),
    )


def _steady(azimuth: Array) -> NDArray[np.bool_]:
    """Return where a curve does not jump, as an azimuth does through north."""
    return np.abs(np.diff(azimuth, prepend=azimuth[:1])) < 180.0


def _nights(x: Array, up: NDArray[np.bool_]) -> tuple[tuple[float, float], ...]:
    edges = np.flatnonzero(np.diff(np.concatenate(([1], up.astype(np.int8), [1]))))
    begins, ends = edges[::2], np.minimum(edges[1::2], len(x) - 1)
    return tuple((float(x[begin]), float(x[end] - x[begin])) for begin, end in zip(begins, ends, strict=True))
