"""When a tracking strategy moves which axis: the next motion towards axis angles, if any is due."""

from dataclasses import replace
from datetime import datetime
from typing import assert_never

from app.base.angles import separation_deg
from app.tracker.mounts.mount import AxisTarget
from app.tracker.settings.axes import AxisConfig
from app.tracker.settings.config import TrackerConfig
from app.tracker.settings.strategy import Continuous, Deadband, EncoderDeadband, Interval, Stepped, Strategy
from app.tracker.state.activity import AxisPair, Run
from app.tracker.state.positioning import new_run
from app.tracker.values.motion import AxisCommand, AxisFeedback, DriveCommand, Feedback, Position

MARGIN_SHARE = 0.2
MARGIN_DEG = 0.1
UNWIND_DEG = 180.0
FULL_TURN_DEG = 360.0


def trigger_deg(config: TrackerConfig) -> float:
    """Return the error at which a run of the deadband begins: the deadband less a margin."""
    return config.deadband_deg - min(MARGIN_DEG, MARGIN_SHARE * config.deadband_deg)


def due(strategy: Strategy, config: TrackerConfig, feedback: Feedback, target: AxisTarget) -> AxisPair | None:
    """Return the target of each axis that has to move now; None while the panel stands where it may."""
    match strategy:
        case Deadband():
            return _both_if(_off_target(config, feedback, target), target)
        case EncoderDeadband():
            return _due_in_counts(strategy, config, feedback, target)
        case Stepped(program) if not program.complete:
            return _both_if(_off_target(config, feedback, target), target)
        case Continuous() | Interval() | Stepped():
            return _both_if(_off_place(config, feedback, target), target)
    assert_never(strategy)


def widened(
    run: Run,
    strategy: Strategy,
    config: TrackerConfig,
    feedback: Feedback,
    target: AxisTarget,
    now: datetime,
) -> Run:
    """Return a run under way with the axis that has become due meanwhile: in counts axes are independent."""
    if not isinstance(strategy, EncoderDeadband) or None not in _both(run.target):
        return run
    more = due(strategy, config, feedback, target)
    if more is None:
        return run
    pair = AxisPair(
        more.azimuth_deg if run.target.azimuth_deg is None else run.target.azimuth_deg,
        more.elevation_deg if run.target.elevation_deg is None else run.target.elevation_deg,
    )
    if pair == run.target:
        return run
    wider = new_run(config, feedback, pair, now)
    return replace(wider, until=max(wider.until, run.until))


def pursue(config: TrackerConfig, target: AxisTarget) -> DriveCommand:
    """Return the command of one tick that has both axes follow the target without a stop."""
    return DriveCommand(
        _follow(config.azimuth, target.azimuth_deg), _follow(config.elevation, target.elevation_deg)
    )


def _follow(axis: AxisConfig, target_deg: float) -> AxisCommand:
    return Position(target_deg, axis.speed_dps)


def _both_if(off: bool, target: AxisTarget) -> AxisPair | None:
    return AxisPair(target.azimuth_deg, target.elevation_deg) if off else None


def _off_target(config: TrackerConfig, feedback: Feedback, target: AxisTarget) -> bool:
    """Return whether the panel is about to leave the deadband, or stands a turn of the cable away.

    The deadband is judged on the sphere. There an azimuth error counts times the cosine of the elevation:
    near the zenith, where the sun's azimuth races, the axis does not turn for nothing.
    """
    azimuth_deg, elevation_deg = feedback.azimuth.position_deg, feedback.elevation.position_deg
    turn_deg = abs(azimuth_deg - target.azimuth_deg)
    if turn_deg > UNWIND_DEG:
        return True
    allowed_deg = trigger_deg(config)
    if turn_deg + abs(elevation_deg - target.elevation_deg) <= allowed_deg:
        return False  # no great circle is longer than the way along azimuth and elevation
    off_deg = separation_deg(azimuth_deg, elevation_deg, target.azimuth_deg, target.elevation_deg)
    return off_deg > allowed_deg


def _off_place(config: TrackerConfig, feedback: Feedback, target: AxisTarget) -> bool:
    """Return whether an axis does not stand at its place."""
    away_deg = max(
        abs(feedback.azimuth.position_deg - target.azimuth_deg),
        abs(feedback.elevation.position_deg - target.elevation_deg),
    )
    return away_deg > config.in_position_deg


def _due_in_counts(
    strategy: EncoderDeadband, config: TrackerConfig, feedback: Feedback, target: AxisTarget
) -> AxisPair | None:
    """Return where each axis that is off by too many counts has to run; each axis is judged by itself."""
    azimuth_deg = _counted(strategy, config.azimuth, feedback.azimuth, target.azimuth_deg)
    elevation_deg = _counted(strategy, config.elevation, feedback.elevation, target.elevation_deg)
    return None if azimuth_deg is elevation_deg is None else AxisPair(azimuth_deg, elevation_deg)


def _counted(
    strategy: EncoderDeadband, axis: AxisConfig, seen: AxisFeedback, target_deg: float
) -> float | None:
    """Return the place, a whole count, to which an axis runs; None while it is off by too few counts."""
    counts_per_deg = strategy.counts_per_turn / FULL_TURN_DEG
    wanted, counted = round(target_deg * counts_per_deg), round(seen.position_deg * counts_per_deg)
    return axis.clamp(wanted / counts_per_deg) if abs(wanted - counted) >= strategy.counts else None


def _both(pair: AxisPair) -> tuple[float | None, float | None]:
    return pair.azimuth_deg, pair.elevation_deg
