"""What the moving picture is told once: the mount, its limits, the day's path and hours, the horizon."""

from datetime import date

from app.base.zones import day_in
from app.sun.horizon import Horizon
from app.sun.position import Algorithm, Location
from app.tracker.memory.recording import RecordingInfo
from app.tracker.settings.config import TrackerConfig
from app.tracker.state.snapshot import SiteSnapshot
from app.web.charts.drawings import Scene
from app.web.charts.sunpath import arc, hours_of

FROM_SOUTH_DEG, FROM_NORTH_DEG = 152.0, 332.0


def scene_now(site: SiteSnapshot | None, config: TrackerConfig, horizon: Horizon) -> Scene:
    """Return the picture of a tracker today; without a sun's path while the location is not known."""
    if site is None or site.location is None:
        return Scene(config.mount, *config.turning_deg)
    today = day_in(site.time_zone, site.at)
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
        hours=hours_of(algorithm, location, on, zone),
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
        hours=hours_of(algorithm, info.location, on, info.time_zone),
        horizon=info.horizon.outline(),
    )


def looked_from_deg(location: Location) -> float:
    """Return the azimuth from which one looks at a tracker: against the midday sun's side of the sky."""
    return FROM_NORTH_DEG if location.latitude_deg < 0 else FROM_SOUTH_DEG
