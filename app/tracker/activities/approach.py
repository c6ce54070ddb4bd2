"""Whether a panel that tracks has reached the sun: until then it is on its way, however long that takes."""

from app.base.angles import separation_deg
from app.tracker.activities.setpoint_scheduler import UNWIND_DEG
from app.tracker.state.activity import AxisPair, Tracking, TrackPhase
from app.tracker.state.controller_state import HALTED, ControllerState, Turn
from app.tracker.state.positioning import close_to
from app.tracker.values.mode import Mode
from app.tracker.values.motion import AxisCommand, DriveCommand, Feedback, Position

FAR_DEG = 20.0
"""Farther off than this a panel is on its way again; no strategy lets it wait so long by itself."""
_BREAKS = (TrackPhase.RESTING, TrackPhase.PAUSED)
_TO_THE_SUN = (TrackPhase.FOLLOWING, TrackPhase.LIMITED, TrackPhase.KEYHOLE)


def is_approaching(state: ControllerState) -> bool:
    """Return whether the panel has not reached the sun since tracking began or had a break."""
    activity = state.activity
    if not isinstance(activity, Tracking) or state.memory.mode is Mode.FIXED:
        return False
    return activity.phase in _TO_THE_SUN and not state.reached


def has_reached(state: ControllerState, turn: Turn, feedback: Feedback) -> bool:
    """Return whether the panel is where tracking wants it, or was and has gone on from there."""
    if not isinstance(turn.activity, Tracking) or turn.activity.phase in _BREAKS:
        return False
    if turn.command is HALTED:
        return state.reached or state.countdowns.motion is None
    target = _target(turn.command)
    if _is_far(target, feedback):
        return False
    return state.reached or close_to(target, feedback, state.config.in_position_deg)


def _is_far(target: AxisPair, feedback: Feedback) -> bool:
    """Judge on the sphere, where an azimuth counts little near the zenith, and by the turn of the cable."""
    azimuth_deg, elevation_deg = feedback.azimuth.position_deg, feedback.elevation.position_deg
    wanted_deg = azimuth_deg if target.azimuth_deg is None else target.azimuth_deg
    height_deg = elevation_deg if target.elevation_deg is None else target.elevation_deg
    if abs(wanted_deg - azimuth_deg) > UNWIND_DEG:
        return True
    return separation_deg(azimuth_deg, elevation_deg, wanted_deg, height_deg) > FAR_DEG


def _target(command: DriveCommand) -> AxisPair:
    return AxisPair(_position_deg(command.azimuth), _position_deg(command.elevation))


def _position_deg(command: AxisCommand) -> float | None:
    return command.position_deg if isinstance(command, Position) else None
