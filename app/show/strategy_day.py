"""What a strategy does with a day: moves, greatest error and travel, told by the real controller."""

from datetime import datetime, timedelta

import numpy as np
from numpy.typing import NDArray

from app.base.angles import separation_deg
from app.show.axis_angles import axis_angles, faced
from app.show.simulate import simulate
from app.show.strategy_told import CURVE_S, StrategyDay
from app.sun.position import Location, SunPosition, sun_path
from app.tracker.memory.memory import Pointing
from app.tracker.memory.recording import Frames
from app.tracker.programs.schedule import Followed
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.values.mode import Mode

FRAME_S = 5
STILL_DEG = 1e-6


def strategy_day(
    config: TrackerConfig,
    pointing: Pointing,
    location: Location,
    mode: Mode,
    held: Orientation,
    begin: datetime,
    end: datetime,
) -> StrategyDay:
    """Return what a tracker with this configuration does from `begin` to `end`, in place at the beginning."""
    step, sparing = timedelta(seconds=FRAME_S), not config.hybrid.enabled
    _, frames = simulate(
        config, pointing, location, "UTC", mode, held, begin, end, step=step, sparing=sparing
    )
    setpoints = np.array(axis_angles(config, pointing, frames, "setpoint"))
    measured = np.array(axis_angles(config, pointing, frames))
    followed = Followed(config, pointing, mode, held)
    suns = _suns(config, location, begin, frames)
    panels = faced(config, pointing, frames)
    errors_deg = [
        _off_deg(followed.direction(sun), panel)
        for sun, panel in zip(suns, panels, strict=True)
        if _height_deg(config, sun) > 0.0
    ]
    turns_deg = np.abs((np.diff(measured, axis=1) + 180.0) % 360.0 - 180.0).sum(axis=1)
    picked = range(0, len(frames), CURVE_S // FRAME_S)
    return StrategyDay(
        moves=_moves(setpoints),
        largest_error_deg=max(errors_deg, default=None),
        mean_error_deg=sum(errors_deg) / len(errors_deg) if errors_deg else None,
        travel_azimuth_deg=float(turns_deg[0]),
        travel_elevation_deg=float(turns_deg[1]),
        elapsed_s=tuple(frames.column("elapsed_s")[picked].tolist()),
        sun_azimuth_deg=tuple(suns[i].azimuth_deg for i in picked),
        sun_elevation_deg=tuple(_height_deg(config, suns[i]) for i in picked),
        panel_azimuth_deg=tuple(panels[i].azimuth_deg for i in picked),
        panel_elevation_deg=tuple(panels[i].elevation_deg for i in picked),
    )


def _moves(setpoints: NDArray[np.float64]) -> int:
    """Return how often set-points began to change after they had stood still."""
    changing = np.abs(np.diff(setpoints, axis=1)).max(axis=0) > STILL_DEG
    begun = np.diff(changing.astype(np.int64), prepend=0) > 0
    return int(begun.sum())


def _suns(config: TrackerConfig, location: Location, begin: datetime, frames: Frames) -> list[SunPosition]:
    path = sun_path(config.algorithm, location, begin.timestamp() + frames.column("elapsed_s"))
    columns = (path.azimuth_deg, path.elevation_deg, path.apparent_elevation_deg)
    return [SunPosition(*sun) for sun in zip(*(column.tolist() for column in columns), strict=True)]


def _height_deg(config: TrackerConfig, sun: SunPosition) -> float:
    return sun.apparent_elevation_deg if config.refraction else sun.elevation_deg


def _off_deg(one: Orientation, other: Orientation) -> float:
    return separation_deg(one.azimuth_deg, one.elevation_deg, other.azimuth_deg, other.elevation_deg)
