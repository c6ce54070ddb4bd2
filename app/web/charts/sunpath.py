"""The polar sun-path diagram: equidistant, north up, east to the right, radius 100 at the horizon."""

from datetime import UTC, date, datetime, timedelta
from functools import lru_cache
from math import cos, radians, sin

import numpy as np

from app.base.message import say
from app.base.zones import day_in, zone_of
from app.sun.horizon import FLAT, Horizon
from app.sun.position import Algorithm, Location, SunPath, sun_path
from app.sun.trigonometry import ARRAY
from app.tracker.mounts.kinematics import direction
from app.tracker.settings.axes import AxisConfig
from app.tracker.settings.config import MountKind, TrackerConfig
from app.tracker.state.snapshot import SiteSnapshot
from app.web.charts.axis import Place
from app.web.charts.drawings import HEIGHT, HORIZON, SET_DEG, Arc, Curve, HourLabel, SunDiagram
from app.web.charts.path import closed, line

DAY_S = 86_400
FINE_S = 600
MONTHS = (
    (12, 21, True),
    (1, 21, False),
    (2, 19, False),
    (3, 20, True),
    (4, 21, False),
    (5, 21, False),
    (6, 21, True),
)
LABEL_GAP = 8.5
LOWEST_HOUR_DEG = 1.5
OUTLINE_POINTS = 73


def diagram(site: SiteSnapshot | None, config: TrackerConfig, horizon: Horizon) -> SunDiagram | None:
    """Return the diagram of the site for today, None while the location is not known."""
    if site is None or site.location is None:
        return None
    today = day_in(site.time_zone, site.at)
    return diagram_of(site.location, site.time_zone, today, config.algorithm, outline(config), horizon)


def arc(algorithm: Algorithm, location: Location, on: date) -> Arc:
    """Return azimuth and elevation of a day's sun above the horizon, every ten minutes."""
    path = day_path(algorithm, location, on)
    pairs = zip(path.azimuth_deg.tolist(), path.elevation_deg.tolist(), strict=True)
    return tuple((round(azimuth, 1), round(elevation, 1)) for azimuth, elevation in pairs if elevation > -4.0)


@lru_cache(maxsize=64)
def diagram_of(
    location: Location,
    zone: str,
    today: date,
    algorithm: Algorithm,
    reachable: str,
    horizon: Horizon = FLAT,
) -> SunDiagram:
    """Return the diagram of a place for a day; `reachable` is what `outline` returns for a tracker."""
    now_path = day_path(algorithm, location, today)
    labels = hour_labels(algorithm, location, today, zone)
    return SunDiagram(
        months=tuple(
            Curve(
                f"{month}-{day}", _drawn(day_path(algorithm, location, date(today.year, month, day))), strong
            )
            for month, day, strong in MONTHS
        ),
        hours=tuple(
            Curve(str(hour), _drawn(hour_path(algorithm, location, today, hour)), strong=False)
            for hour in range(24)
        ),
        labels=labels,
        today=Curve(today.isoformat(), _drawn(now_path), strong=True),
        reachable=reachable,
        title=say("Sun path of {isoformat}, seen from above, north up", isoformat=today.isoformat()),
        skyline=skyline(horizon),
    )


def skyline(horizon: Horizon) -> str:
    """Return what the entered horizon hides as SVG path data, a ring at the rim; empty where it is flat."""
    if not horizon.points:
        return ""
    inner = closed(point(azimuth_deg, elevation_deg) for azimuth_deg, elevation_deg in horizon.outline())
    return f"M0 {-HORIZON:g}A{HORIZON:g} {HORIZON:g} 0 1 1 -.01 {-HORIZON:g}Z{inner}"


def point(azimuth_deg: Place, elevation_deg: Place) -> tuple[Place, Place]:
    """Return where a direction of the sky lies in the diagram, or many."""
    radius, turn = HEIGHT.at(elevation_deg), np.radians(azimuth_deg)
    return radius * np.sin(turn), -radius * np.cos(turn)


def day_path(algorithm: Algorithm, location: Location, on: date) -> SunPath:
    """Return the sun every ten minutes of a day, by the mean solar time of the place."""
    midnight = datetime(on.year, on.month, on.day, tzinfo=UTC).timestamp() - location.longitude_deg * 240
    return sun_path(algorithm, location, np.arange(midnight, midnight + DAY_S + 1, FINE_S, dtype=np.float64))


def hour_path(algorithm: Algorithm, location: Location, today: date, hour: int) -> SunPath:
    """Return the sun at one hour of UTC, weekly from December to June."""
    begin = datetime(today.year - 1, 12, 21, hour, tzinfo=UTC).timestamp()
    return sun_path(algorithm, location, begin + np.arange(0, 183, 7, dtype=np.float64) * DAY_S)


def _drawn(path: SunPath) -> str:
    """Return the part of a path above the horizon as SVG path data, broken where the sun is down."""
    return line(*point(path.azimuth_deg, path.elevation_deg), path.elevation_deg >= SET_DEG)


def hour_labels(algorithm: Algorithm, location: Location, today: date, zone: str) -> tuple[HourLabel, ...]:
    """Return the full hours of today's civil time at their places outside today's curve."""
    labels = []
    for text, azimuth_deg, elevation_deg in hours_of(algorithm, location, today, zone):
        x, y = point(azimuth_deg, elevation_deg - LABEL_GAP * 0.9)
        labels.append(HourLabel(x, y, text))
    return tuple(labels)


def hours_of(
    algorithm: Algorithm, location: Location, on: date, zone: str
) -> tuple[tuple[str, float, float], ...]:
    """Return the full hours of a day's civil time with azimuth and elevation of the sun, while it is up."""
    midnight = datetime(on.year, on.month, on.day, tzinfo=zone_of(zone)).astimezone(UTC)
    instants = [midnight + timedelta(hours=hour) for hour in range(25)]
    path = sun_path(algorithm, location, np.array([at.timestamp() for at in instants]))
    spots = zip(instants, path.azimuth_deg.tolist(), path.elevation_deg.tolist(), strict=True)
    return tuple(
        (str(at.astimezone(zone_of(zone)).hour), round(azimuth_deg, 1), round(elevation_deg, 1))
        for at, azimuth_deg, elevation_deg in spots
        if elevation_deg > LOWEST_HOUR_DEG
    )


def outline(config: TrackerConfig) -> str:
    """Return the part of the sky that a tracker can face as SVG path data; a single axis faces a line."""
    if config.mount.kind is MountKind.AZIMUTH_ELEVATION:
        return sector(config.azimuth, config.elevation)
    first_deg = np.linspace(config.azimuth.minimum_deg, config.azimuth.maximum_deg, OUTLINE_POINTS)
    second = config.elevation
    lower, upper = (np.full(OUTLINE_POINTS, end) for end in (second.minimum_deg, second.maximum_deg))
    there = direction(config.mount, first_deg, lower, ARRAY)
    back = direction(config.mount, first_deg[::-1], upper, ARRAY)
    azimuth_deg, elevation_deg = (np.concatenate(pair) for pair in zip(there, back, strict=True))
    return line(*point(azimuth_deg, np.maximum(elevation_deg, 0.0))) + "Z"


def sector(azimuth: AxisConfig, elevation: AxisConfig) -> str:
    """Return the part of the sky within the soft limits as SVG path data."""
    outer = HEIGHT.at(max(0.0, elevation.minimum_deg))
    inner = HEIGHT.at(min(90.0, elevation.maximum_deg))
    if azimuth.maximum_deg - azimuth.minimum_deg >= 360.0:
        return _ring(outer) + (_ring(inner) if inner > 0 else "")
    large = int(azimuth.maximum_deg - azimuth.minimum_deg > 180.0)
    begin, end = azimuth.minimum_deg, azimuth.maximum_deg
    return (
        f"M{_at(begin, inner)}L{_at(begin, outer)}A{outer:.1f} {outer:.1f} 0 {large} 1 {_at(end, outer)}"
        f"L{_at(end, inner)}A{inner:.1f} {inner:.1f} 0 {large} 0 {_at(begin, inner)}Z"
    )


def _ring(radius: float) -> str:
    half = f"A{radius:.1f} {radius:.1f} 0 1 1"
    return f"M0 {-radius:.1f}{half} 0 {radius:.1f}{half} 0 {-radius:.1f}Z"


def _at(azimuth_deg: float, radius: float) -> str:
    return f"{radius * sin(radians(azimuth_deg)):.1f} {-radius * cos(radians(azimuth_deg)):.1f}"
