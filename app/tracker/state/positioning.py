"""A run: one motion of the axes to a fixed place that has to arrive in time."""

from datetime import datetime, timedelta

from app.tracker.settings.config import TrackerConfig
from app.tracker.state.activity import AxisPair, Run
from app.tracker.values.motion import HALT, AxisCommand, AxisFeedback, DriveCommand, Feedback, Position

GRACE_S = 5.0
PATIENCE = 2.0


def new_run(
    config: TrackerConfig, feedback: Feedback, target: AxisPair, now: datetime, *, by_hand: bool = False
) -> Run:
    """Return a run at rated speed, `by_hand` no faster than a jog; overdue after twice its time plus 5 s."""
    azimuth_dps = config.azimuth.jog_fast_dps if by_hand else config.azimuth.speed_dps
    elevation_dps = config.elevation.jog_fast_dps if by_hand else config.elevation.speed_dps
    azimuth_s = _travel_s(feedback.azimuth, target.azimuth_deg, azimuth_dps)
    elevation_s = _travel_s(feedback.elevation, target.elevation_deg, elevation_dps)
    command = DriveCommand(
        _go(target.azimuth_deg, azimuth_dps),
        _go(target.elevation_deg, elevation_dps),
    )
    allowed = timedelta(seconds=max(azimuth_s, elevation_s) * PATIENCE + GRACE_S)
    return Run(target, command, now + allowed)


def arrived(target: AxisPair, feedback: Feedback, tolerance_deg: float) -> bool:
    """Return whether every axis that is meant stands within the tolerance of its target."""
    return _stands(target.azimuth_deg, feedback.azimuth, tolerance_deg) and _stands(
        target.elevation_deg, feedback.elevation, tolerance_deg
    )


def close_to(target: AxisPair, feedback: Feedback, tolerance_deg: float) -> bool:
    """Return whether every axis that is meant is within the tolerance of its target, moving or not."""
    return _near(target.azimuth_deg, feedback.azimuth, tolerance_deg) and _near(
        target.elevation_deg, feedback.elevation, tolerance_deg
    )


def at_rest(feedback: Feedback) -> bool:
    """Return whether neither axis moves."""
    return not (feedback.azimuth.moving or feedback.elevation.moving or feedback.homing)


def _travel_s(axis: AxisFeedback, target_deg: float | None, speed_dps: float) -> float:
    return 0.0 if target_deg is None else abs(target_deg - axis.position_deg) / speed_dps


def _go(target_deg: float | None, speed_dps: float) -> AxisCommand:
    return HALT if target_deg is None else Position(target_deg, speed_dps)


def _stands(target_deg: float | None, axis: AxisFeedback, tolerance_deg: float) -> bool:
    return target_deg is None or (not axis.moving and _near(target_deg, axis, tolerance_deg))


def _near(target_deg: float | None, axis: AxisFeedback, tolerance_deg: float) -> bool:
    return target_deg is None or abs(axis.position_deg - target_deg) <= tolerance_deg
