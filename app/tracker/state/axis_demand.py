"""How fast the axes may turn now: slowly in service mode, and an axis that stops too late."""

from dataclasses import replace

from app.tracker.settings.axes import Axis, AxisConfig
from app.tracker.settings.config import TrackerConfig
from app.tracker.state.controller_state import ControllerState


def paced(state: ControllerState) -> TrackerConfig:
    """Return the configuration with the speeds that are allowed now; unchanged where nothing limits them."""
    config = state.config
    if state.memory.service is None and not state.guards:
        return config
    if is_slow(state, Axis.AZIMUTH):
        config = replace(config, azimuth=_slowed(config.azimuth))
    if is_slow(state, Axis.ELEVATION):
        config = replace(config, elevation=_slowed(config.elevation))
    return config


def is_slow(state: ControllerState, axis: Axis) -> bool:
    """Return whether an axis may turn at the slow hand speed only."""
    guard = state.guards.get(axis)
    return state.memory.service is not None or (guard is not None and guard.slow_stops_left > 0)


def _slowed(axis: AxisConfig) -> AxisConfig:
    slow_dps = axis.jog_slow_dps
    return replace(axis, speed_dps=slow_dps, jog_fast_dps=slow_dps)
