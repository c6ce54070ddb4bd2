"""The curves of a planned show as SVG: azimuth above, elevation below, nights shaded."""

from datetime import UTC, datetime, timedelta

import numpy as np
from numpy.typing import NDArray

from app.tracker.programs.show import ShowPath
from app.web.ui.drawings import Band, DayChart, Tick
from app.zones import zone_of

Array = NDArray[np.float64]
LEFT, RIGHT = 46.0, 990.0
AZIMUTH_TOP, ELEVATION_TOP, BAND = 8.0, 166.0, 138.0
HOUR_STEPS = (0.25, 0.5, 1, 2, 3, 4, 6)
MOST_HOURS = 13
DEGREE_STEPS = (1, 2, 5, 10, 15, 30, 45, 60, 90, 180)
MOST_DEGREES = 5


def chart(path: ShowPath, zone: str) -> DayChart | None:
    """Return the chart of a planned path, None where there is none to draw."""
    times = path.sun_time_unix_s
    if len(times) < 2:
        return None
    x = LEFT + (RIGHT - LEFT) * (times - times[0]) / (times[-1] - times[0])
    up = path.sun_is_up
    return DayChart(
        bands=(
            _band("Azimuth", AZIMUTH_TOP, x, path.panel_azimuth_deg, path.sun_azimuth_deg, up),
            _band("Elevation", ELEVATION_TOP, x, path.panel_elevation_deg, path.sun_elevation_deg, up),
        ),
        hours=_hours(float(times[0]), float(times[-1]), zone),
        nights=_nights(x, up),
    )


def _band(label: str, top: float, x: Array, panel: Array, sun: Array, up: NDArray[np.bool_]) -> Band:
    seen = np.concatenate((panel, sun[up])) if up.any() else panel
    least, most = float(seen.min()), float(seen.max())
    room = max(2.0, (most - least) * 0.08)
    low, high = least - room, most + room

    def y(angle: Array) -> Array:
        return np.asarray(top + BAND * (high - angle) / (high - low))

    step = next(
        step for step in DEGREE_STEPS if (high - low) / step <= MOST_DEGREES or step == DEGREE_STEPS[-1]
    )
    marks = np.arange(np.ceil(low / step) * step, high, step)
    return Band(
        label=label,
        top=top,
        height=BAND,
        panel=_line(x, y(panel), np.ones(len(x), dtype=np.bool_)),
        sun=_line(x, y(sun), up & _steady(sun)),
        ticks=tuple(
            Tick(at, f"{mark + 0.0:g}°") for at, mark in zip(y(marks).tolist(), marks.tolist(), strict=True)
        ),
    )


def _steady(azimuth: Array) -> NDArray[np.bool_]:
    """Return where a curve does not jump, as an azimuth does through north."""
    return np.abs(np.diff(azimuth, prepend=azimuth[:1])) < 180.0


def _line(x: Array, y: Array, shown: NDArray[np.bool_]) -> str:
    drawn, pen_down = [], False
    for at_x, at_y, here in zip(x.tolist(), y.tolist(), shown.tolist(), strict=True):
        if here:
            drawn.append(f"{'L' if pen_down else 'M'}{at_x:.1f} {at_y:.1f}")
        pen_down = here
    return "".join(drawn)


def _nights(x: Array, up: NDArray[np.bool_]) -> tuple[tuple[float, float], ...]:
    edges = np.flatnonzero(np.diff(np.concatenate(([1], up.astype(np.int8), [1]))))
    begins, ends = edges[::2], np.minimum(edges[1::2], len(x) - 1)
    return tuple((float(x[begin]), float(x[end] - x[begin])) for begin, end in zip(begins, ends, strict=True))


def _hours(begin: float, end: float, zone: str) -> tuple[Tick, ...]:
    span_h = (end - begin) / 3600
    step = timedelta(hours=next((step for step in HOUR_STEPS if span_h / step <= MOST_HOURS), HOUR_STEPS[-1]))
    midnight = datetime.fromtimestamp(begin, zone_of(zone)).replace(hour=0, minute=0, second=0, microsecond=0)
    ticks = []
    at = midnight.astimezone(UTC)
    while at.timestamp() <= end:
        if at.timestamp() >= begin:
            x = LEFT + (RIGHT - LEFT) * (at.timestamp() - begin) / (end - begin)
            ticks.append(Tick(round(x, 1), at.astimezone(zone_of(zone)).strftime("%H:%M")))
        at += step
    return tuple(ticks)
