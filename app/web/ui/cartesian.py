"""The Cartesian sun path: azimuth across, elevation up, the midday side of the sky in the middle."""

from datetime import date

import numpy as np
from numpy.typing import NDArray

from app.sun.horizon import Horizon
from app.sun.position import Algorithm, Location, SunPath
from app.sun.trigonometry import ARRAY
from app.tracker.config import MountKind, TrackerConfig
from app.tracker.mounts.kinematics import direction
from app.web.ui.drawings import Cartesian, Curve, HourLabel, Tick
from app.web.ui.formats import compass
from app.web.ui.sunpath import MONTHS, broken, day_path, hour_path, hours_of

LEFT, TOP, WIDTH, HEIGHT = 56.0, 16.0, 720.0, 270.0
BOTTOM = TOP + HEIGHT
PER_DEGREE = WIDTH / 360.0
RISE = HEIGHT / 90.0
TICK_DEG = 30
OUTLINE_POINTS = 73
LABEL_RISE_DEG = 3.5
SET_DEG = -0.9
LEAP = WIDTH / 2.0


def cartesian(
    config: TrackerConfig, location: Location, zone: str, today: date, horizon: Horizon
) -> Cartesian:
    """Return the diagram of a place for a day, with what the tracker can face and the entered horizon."""
    centre_deg = 0.0 if location.latitude_deg < 0 else 180.0
    algorithm = config.algorithm
    return Cartesian(
        centre_deg=centre_deg,
        months=tuple(
            Curve(
                f"{day} {date(today.year, month, day):%b}",
                _path(day_path(algorithm, location, date(today.year, month, day)), centre_deg),
                strong,
            )
            for month, day, strong in MONTHS
        ),
        hours=tuple(
            Curve(str(hour), _path(hour_path(algorithm, location, today, hour), centre_deg), strong=False)
            for hour in range(24)
        ),
        labels=_labels(algorithm, location, today, zone, centre_deg),
        today=Curve(today.isoformat(), _path(day_path(algorithm, location, today), centre_deg), strong=True),
        reach=reach(config, centre_deg),
        fills=config.mount.kind is MountKind.AZIMUTH_ELEVATION,
        skyline=skyline(horizon, centre_deg),
        columns=_columns(centre_deg),
        rows=tuple(Tick(round(_y(at), 1), f"{at}°") for at in range(0, 91, 15)),
        title=f"Sun path of {today.isoformat()}, azimuth across and elevation up",
    )


def _x(azimuth_deg: NDArray[np.float64], centre_deg: float) -> NDArray[np.float64]:
    aside = (azimuth_deg - centre_deg + 180.0) % 360.0
    return np.asarray(LEFT + aside * PER_DEGREE, dtype=np.float64)


def _y(elevation_deg: float) -> float:
    return BOTTOM - elevation_deg * RISE


def _path(path: SunPath, centre_deg: float) -> str:
    """Return the part of a path above the horizon, broken where it leaves the picture at the side."""
    return _line(path.azimuth_deg, path.elevation_deg, path.elevation_deg >= SET_DEG, centre_deg)


def _line(
    azimuth_deg: NDArray[np.float64],
    elevation_deg: NDArray[np.float64],
    shown: NDArray[np.bool_],
    centre_deg: float,
) -> str:
    x = _x(azimuth_deg, centre_deg)
    y = np.clip(BOTTOM - elevation_deg * RISE, TOP, BOTTOM)
    leaps = np.flatnonzero(np.abs(np.diff(x)) > LEAP) + 1
    pieces = zip(np.split(x, leaps), np.split(y, leaps), np.split(shown, leaps), strict=True)
    return "".join(broken(*piece) for piece in pieces)


def _labels(
    algorithm: Algorithm, location: Location, today: date, zone: str, centre_deg: float
) -> tuple[HourLabel, ...]:
    return tuple(
        HourLabel(
            round(float(_x(np.array([azimuth_deg]), centre_deg)[0]), 1),
            round(_y(elevation_deg + LABEL_RISE_DEG), 1),
            text,
        )
        for text, azimuth_deg, elevation_deg in hours_of(algorithm, location, today, zone)
    )


def _columns(centre_deg: float) -> tuple[Tick, ...]:
    """Return the azimuths across, with the letters of the compass."""
    ticks = []
    for aside in range(-180, 181, TICK_DEG):
        azimuth = int(centre_deg + aside) % 360
        letter = f" {compass(azimuth)}" if azimuth % 90 == 0 else ""
        ticks.append(Tick(LEFT + (aside + 180.0) * PER_DEGREE, f"{azimuth}°{letter}"))
    return tuple(ticks)


def skyline(horizon: Horizon, centre_deg: float) -> str:
    """Return what the entered horizon hides as a closed shape; empty where it is flat."""
    if not horizon.points:
        return ""
    asides = sorted({(one - centre_deg + 180.0) % 360.0 for one, _ in horizon.outline()} | {0.0, 360.0})
    tops = "".join(
        f"L{LEFT + aside * PER_DEGREE:.1f} {_y(horizon.height_deg(centre_deg + aside - 180.0)):.1f}"
        for aside in asides
    )
    return f"M{LEFT:.1f} {BOTTOM:.1f}{tops}L{LEFT + WIDTH:.1f} {BOTTOM:.1f}Z"


def reach(config: TrackerConfig, centre_deg: float) -> str:
    """Return what the tracker can face: rectangles within the limits, or the outline of a tilted axis."""
    if config.mount.kind is MountKind.AZIMUTH_ELEVATION:
        return _rectangles(config, centre_deg)
    first_deg = np.linspace(config.azimuth.minimum_deg, config.azimuth.maximum_deg, OUTLINE_POINTS)
    ends = (config.elevation.minimum_deg, config.elevation.maximum_deg)
    outlines = []
    for second_deg in ends[:1] if config.mount.single_axis else ends:
        faced = direction(config.mount, first_deg, np.full(OUTLINE_POINTS, second_deg), ARRAY)
        outlines.append(_line(faced[0], faced[1], faced[1] >= SET_DEG, centre_deg))
    return "".join(outlines)


def _rectangles(config: TrackerConfig, centre_deg: float) -> str:
    """Return the soft limits as one rectangle, or as two where the range lies over the picture's side."""
    first, second = config.azimuth, config.elevation
    top, bottom = _y(min(90.0, second.maximum_deg)), _y(max(0.0, second.minimum_deg))
    span_deg = min(360.0, first.maximum_deg - first.minimum_deg)
    begin = 0.0 if span_deg >= 360.0 else (first.minimum_deg - centre_deg + 180.0) % 360.0
    ends = [(begin, min(360.0, begin + span_deg)), (0.0, begin + span_deg - 360.0)]
    sides = [(LEFT + a * PER_DEGREE, LEFT + b * PER_DEGREE) for a, b in ends if b > a]
    return "".join(f"M{a:.1f} {top:.1f}H{b:.1f}V{bottom:.1f}H{a:.1f}Z" for a, b in sides)
