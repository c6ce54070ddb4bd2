"""How fast the axes may turn now: slowly in service mode, and an axis that stops too late."""

from dataclasses import replace

from app.tracker.axes import Axis, AxisConfig
from app.tracker.config import TrackerConfig
from app.tracker.controller_state import ControllerState


def paced(mind: ControllerState) -> TrackerConfig:
    """Return the configuration with the speeds that are allowed now; unchanged where nothing limits them."""
    config = mind.config
    if mind.memory.service is None and not mind.guards:
        return config
    if is_slow(mind, Axis.AZIMUTH):
        config = replace(config, azimuth=_slowed(config.azimuth))
    if is_slow(mind, Axis.ELEVATION):
        config = replace(config, elevation=_slowed(config.elevation))
    return config


def is_slow(mind: ControllerState, axis: Axis) -> bool:
    """Return whether an axis may turn at the slow hand speed only."""
    guard = mind.guards.get(axis)
    return mind.memory.service is not None or (guard is not None and guard.slow_stops_left > 0)


def _slowed(axis: AxisConfig) -> AxisConfig:
    slow_dps = axis.jog_slow_dps
    return replace(axis, speed_dps=slow_dps, jog_fast_dps=slow_dps)
