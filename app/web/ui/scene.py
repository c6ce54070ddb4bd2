"""What the moving picture is told once: the mount, its limits, the day's path and hours, the horizon."""

from datetime import UTC, date, datetime, timedelta

import numpy as np

from app.sun.horizon import Horizon
from app.sun.position import Algorithm, Location, sun_path
from app.tracker.config import TrackerConfig
from app.tracker.recording import RecordingInfo
from app.tracker.snapshot import SiteSnapshot
from app.web.ui.drawings import Scene
from app.web.ui.sunpath import arc
from app.zones import zone_of

FROM_SOUTH_DEG, FROM_NORTH_DEG = 152.0, 332.0
LOWEST_HOUR_DEG = 1.0


def scene_now(site: SiteSnapshot | None, config: TrackerConfig, horizon: Horizon) -> Scene:
    """Return the picture of a tracker today; without a sun's path while the location is not known."""
    if site is None or site.location is None:
        return Scene(config.mount, *config.turning_deg)
    today = site.at.astimezone(zone_of(site.time_zone)).date()
    return scene_on(config, site.location, site.time_zone, today, config.algorithm, horizon)


def scene_on(
    config: TrackerConfig, location: Location, zone: str, on: date, algorithm: Algorithm, horizon: Horizon
) -> Scene:
    """Return the picture of a tracker with the sun's path of a day at a place and the horizon there."""
    return Scene(
        config.mount,
        *config.turning_deg,
        yaw=looked_from_deg(location),
        arc=arc(algorithm, location, on),
        hours=hours(algorithm, location, on, zone),
        horizon=horizon.outline(),
    )


def scene_recorded(info: RecordingInfo, on: date) -> Scene:
    """Return the picture of a recording, on the mount and within the limits that the tracker had then."""
    algorithm = Algorithm(info.algorithm)
    return Scene(
        info.mount,
        info.first_deg,
        info.second_deg,
        yaw=looked_from_deg(info.location),
        arc=arc(algorithm, info.location, on),
        hours=hours(algorithm, info.location, on, info.time_zone),
    )


def looked_from_deg(location: Location) -> float:
    """Return the azimuth from which one looks at a tracker: against the midday sun's side of the sky."""
    return FROM_NORTH_DEG if location.latitude_deg < 0 else FROM_SOUTH_DEG


def hours(
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
