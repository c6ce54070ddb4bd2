"""When a tracking strategy has an axis move."""

from dataclasses import replace

from app.tracker.activities.setpoint_scheduler import due
from app.tracker.mounts.mount import AxisTarget
from app.tracker.settings.config import TrackerConfig
from app.tracker.settings.strategy import DEADBAND, EncoderDeadband
from app.tracker.state.activity import AxisPair
from app.tracker.values.motion import AxisFeedback, Feedback
from tests.tracker.plant import CONFIG


def due_from(
    azimuth_deg: float, elevation_deg: float, target: tuple[float, float], config: TrackerConfig = CONFIG
) -> AxisPair | None:
    azimuth, elevation = (
        AxisFeedback(deg, 0.0, moving=False, homed=True) for deg in (azimuth_deg, elevation_deg)
    )
    seen, wanted = Feedback(azimuth, elevation, boot_count=1), AxisTarget(*target, limited=False)
    return due(config.strategy, config, seen, wanted)


def test_an_azimuth_error_counts_less_the_higher_the_panel_looks() -> None:
    assert (CONFIG.strategy, CONFIG.deadband_deg) == (DEADBAND, 0.5)
    assert due_from(100.0, 10.0, (101.0, 10.0)) == AxisPair(101.0, 10.0)
    assert due_from(100.0, 70.0, (101.0, 70.0)) is None
    assert due_from(90.0, 89.9, (270.0, 89.9)) is None


def test_a_target_a_turn_of_the_cable_away_is_gone_to_however_near_it_is_in_the_sky() -> None:
    assert due_from(0.1, 40.0, (360.0, 40.0)) == AxisPair(360.0, 40.0)


def test_the_trackers_own_deadband_counts() -> None:
    assert due_from(100.0, 0.0, (100.35, 0.0)) is None
    assert due_from(100.0, 0.0, (100.35, 0.0), replace(CONFIG, deadband_deg=0.3)) is not None


def test_in_counts_each_axis_is_judged_by_itself() -> None:
    counting = replace(CONFIG, strategy=EncoderDeadband())
    assert due_from(100.0, 40.0, (100.9, 40.9), counting) is None
    assert due_from(100.0, 40.0, (101.0, 40.9), counting) == AxisPair(101.0, None)
    assert due_from(100.0, 40.0, (100.9, 41.0), counting) == AxisPair(None, 41.0)
