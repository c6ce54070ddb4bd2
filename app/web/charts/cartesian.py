"""The Cartesian sun path: azimuth across, elevation up, the midday side of the sky in the middle."""

from datetime import date

import numpy as np
from numpy.typing import NDArray

from app.base.message import say
from app.sun.horizon import Horizon
from app.sun.position import Algorithm, Location, SunPath
from app.sun.trigonometry import ARRAY
from app.tracker.mounts.kinematics import direction
from app.tracker.settings.config import MountKind, TrackerConfig
from app.web.charts.axis import Box, Place, Scale, angle_step, azimuth, degrees, within
from app.web.charts.drawings import SET_DEG, Cartesian, Curve, HourLabel
from app.web.charts.path import closed, line
from app.web.charts.sunpath import MONTHS, day_path, hour_path, hours_of

BOX = Box(56.0, 776.0, 16.0, 286.0)
UP = BOX.upwards(0.0, 90.0)
MOST_COLUMNS, MOST_ROWS = 12, 6
OUTLINE_POINTS = 73
LABEL_RISE_DEG = 3.5
LEAP = BOX.width / 2.0


def cartesian(
    config: TrackerConfig, location: Location, zone: str, today: date, horizon: Horizon
) -> Cartesian:
    """Return the diagram of a place for a day, with what the tracker can face and the entered horizon."""
    centre_deg = 0.0 if location.latitude_deg < 0 else 180.0
    algorithm = config.algorithm
    x = _across(centre_deg)
    return Cartesian(
        box=BOX,
        x=x,
        y=UP,
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
        columns=x.ticks(within(x.low, x.high, MOST_COLUMNS, angle_step), lambda deg: azimuth(deg % 360.0)),
        rows=UP.ticks(within(UP.low, UP.high, MOST_ROWS, angle_step), degrees),
        title=say("Sun path of {isoformat}, azimuth across and elevation up", isoformat=today.isoformat()),
    )


def _across(centre_deg: float) -> Scale:
    return BOX.across(centre_deg - 180.0, centre_deg + 180.0)


def _x(azimuth_deg: Place, centre_deg: float) -> Place:
    low_deg = centre_deg - 180.0
    return _across(centre_deg).at((azimuth_deg - low_deg) % 360.0 + low_deg)


def _path(path: SunPath, centre_deg: float) -> str:
    """Return the part of a path above the horizon, broken where it leaves the picture at the side."""
    return _drawn(path.azimuth_deg, path.elevation_deg, path.elevation_deg >= SET_DEG, centre_deg)


def _drawn(
    azimuth_deg: NDArray[np.float64],
    elevation_deg: NDArray[np.float64],
    shown: NDArray[np.bool_],
    centre_deg: float,
) -> str:
    x = _x(azimuth_deg, centre_deg)
    y = np.clip(UP.at(elevation_deg), BOX.top, BOX.bottom)
    leaps = np.flatnonzero(np.abs(np.diff(x)) > LEAP) + 1
    pieces = zip(np.split(x, leaps), np.split(y, leaps), np.split(shown, leaps), strict=True)
    return "".join(line(*piece) for piece in pieces)


def _labels(
    algorithm: Algorithm, location: Location, today: date, zone: str, centre_deg: float
) -> tuple[HourLabel, ...]:
    return tuple(
        HourLabel(
            round(_x(azimuth_deg, centre_deg), 1),
            round(UP.at(elevation_deg + LABEL_RISE_DEG), 1),
            text,
        )
        for text, azimuth_deg, elevation_deg in hours_of(algorithm, location, today, zone)
    )


def skyline(horizon: Horizon, centre_deg: float) -> str:
    """Return what the entered horizon hides as a closed shape; empty where it is flat."""
    if not horizon.points:
        return ""
    x = _across(centre_deg)
    turned_deg = {(one - x.low) % 360.0 + x.low for one, _ in horizon.outline()}
    tops = [(x.at(one), UP.at(horizon.height_deg(one))) for one in sorted(turned_deg | {x.low, x.high})]
    return closed([(BOX.left, BOX.bottom), *tops, (BOX.right, BOX.bottom)])


def reach(config: TrackerConfig, centre_deg: float) -> str:
    """Return what the tracker can face: rectangles within the limits, or the outline of a tilted axis."""
    if config.mount.kind is MountKind.AZIMUTH_ELEVATION:
        return _rectangles(config, centre_deg)
    first_deg = np.linspace(config.azimuth.minimum_deg, config.azimuth.maximum_deg, OUTLINE_POINTS)
    ends = (config.elevation.minimum_deg, config.elevation.maximum_deg)
    outlines = []
    for second_deg in ends[:1] if config.mount.single_axis else ends:
        faced = direction(config.mount, first_deg, np.full(OUTLINE_POINTS, second_deg), ARRAY)
        outlines.append(_drawn(faced[0], faced[1], faced[1] >= SET_DEG, centre_deg))
    return "".join(outlines)


def _rectangles(config: TrackerConfig, centre_deg: float) -> str:
    """Return the soft limits as one rectangle, or as two where the range lies over the picture's side."""
    first, second = config.azimuth, config.elevation
    top, bottom = UP.at(min(90.0, second.maximum_deg)), UP.at(max(0.0, second.minimum_deg))
    span_deg = min(360.0, first.maximum_deg - first.minimum_deg)
    x = _across(centre_deg)
    begin = x.low if span_deg >= 360.0 else (first.minimum_deg - x.low) % 360.0 + x.low
    ends = [(begin, min(x.high, begin + span_deg)), (x.low, begin + span_deg - 360.0)]
    sides = [(x.at(a), x.at(b)) for a, b in ends if b > a]
    return "".join(f"M{a:.1f} {top:.1f}H{b:.1f}V{bottom:.1f}H{a:.1f}Z" for a, b in sides)
