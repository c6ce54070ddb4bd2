"""How far another setting moves what a tracker aims at: asked from a degree on, where it can track."""

import re
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest

from app.base.angles import wrap180
from app.sun.position import Algorithm, Location
from app.tracker.memory.memory import Pointing, TrackerMemory, TrackerState
from app.tracker.motion.limit_change import LimitReview
from app.tracker.motion.target_change import target_review
from app.tracker.mounts.usual import mounted
from app.tracker.settings.config import DriveConfig, DriveKind, MountKind, Rows, TrackerConfig
from app.tracker.settings.mechanisms import alexandru_diurnal
from app.tracker.values.mode import Mode
from tests.tracker.plant import CONFIG, READY, SAMSUN, TRUST

NOON = datetime(2026, 6, 21, 9, 40, tzinfo=UTC)
NIGHT = datetime(2026, 6, 21, 22, 0, tzinfo=UTC)
TILTED = mounted(CONFIG, MountKind.TILTED_SINGLE_AXIS, SAMSUN.latitude_deg)


def asked(
    old: TrackerConfig, new: TrackerConfig, *, memory: TrackerMemory = READY, at: datetime = NOON
) -> LimitReview:
    return target_review(TrackerState(old, memory), TrackerState(new, memory), SAMSUN, at)


def corrected(before: Pointing, after: Pointing, at: datetime = NOON) -> LimitReview:
    states = [TrackerState(CONFIG, replace(READY, pointing=pointing)) for pointing in (before, after)]
    return target_review(states[0], states[1], SAMSUN, at)


def turned(azimuth_deg: float) -> TrackerConfig:
    return replace(TILTED, mount=replace(TILTED.mount, axis_azimuth_deg=azimuth_deg))


@pytest.mark.parametrize(("before_deg", "after_deg"), [(0.0, 10.0), (10.0, 0.0), (-3.0, 7.0)])
def test_a_correction_moves_its_axis_by_as_much(before_deg: float, after_deg: float) -> None:
    found = corrected(Pointing(azimuth_offset_deg=before_deg), Pointing(azimuth_offset_deg=after_deg))
    (doubt,) = found.doubts
    assert doubt.code == "target_moves"
    assert doubt.message.startswith(
        "The target of the azimuth axis of Tracker 1 moves by up to 10.0° within the next 24 hours. "
        "At present, it is "
    )
    (difference,) = found.differences
    assert (difference.what, difference.before, difference.after) == (
        "Azimuth offset",
        f"{before_deg:.2f}°",
        f"{after_deg:.2f}°",
    )


def test_both_axes_are_named() -> None:
    found = corrected(Pointing(), Pointing(azimuth_offset_deg=2.0, elevation_offset_deg=3.0))
    assert [doubt.message.split(" of Tracker 1 ")[0] for doubt in found.doubts] == [
        "The target of the azimuth axis",
        "The target of the elevation axis",
    ]


@pytest.mark.parametrize(
    ("offset_deg", "is_asked"), [(0.99, False), (1.01, True), (-0.99, False), (-1.01, True)]
)
def test_a_degree_goes_unasked(offset_deg: float, *, is_asked: bool) -> None:
    found = corrected(Pointing(), Pointing(azimuth_offset_deg=offset_deg))
    assert bool(found.doubts) is is_asked
    assert bool(found.differences) is is_asked


def test_at_night_the_coming_day_is_looked_at() -> None:
    (doubt,) = corrected(Pointing(), Pointing(azimuth_offset_deg=10.0), NIGHT).doubts
    assert "by up to 10.0°" in doubt.message
    assert "At present" not in doubt.message


def test_another_axis_is_told_with_what_it_is_now_and_would_be() -> None:
    found = asked(turned(180.0), turned(150.0))
    (doubt,) = found.doubts
    assert float(doubt.message.split("up to ")[1].split("°")[0]) > 10.0
    (difference,) = found.differences
    assert (difference.what, difference.before, difference.after) == ("Azimuth of the axis", "180 °", "150 °")
    assert found.digest == "Azimuth of the axis: 180 ° to 150 °"
    assert found.moves_target


def test_backtracking_moves_the_target_in_the_morning_and_the_evening() -> None:
    level = mounted(CONFIG, MountKind.HORIZONTAL_SINGLE_AXIS, SAMSUN.latitude_deg)
    rows = replace(level, mount=replace(level.mount, rows=Rows(0.5)))
    found = asked(level, rows)
    assert found.doubts
    assert [(one.what, one.before, one.after) for one in found.differences] == [
        ("Ground coverage ratio", "off", "0.5"),
        ("Slope across the rows", "off", "0 °"),
    ]


def test_what_aims_as_before_is_not_asked_about() -> None:
    for other in (
        replace(CONFIG, algorithm=Algorithm.SPA),
        replace(CONFIG, refraction=not CONFIG.refraction),
        replace(CONFIG, name="Other", deadband_deg=2.0),
    ):
        assert asked(CONFIG, other) == LimitReview()
        assert asked(other, CONFIG) == LimitReview()


def test_who_cannot_track_is_asked_nothing() -> None:
    for memory in (
        TrackerMemory(),
        TrackerMemory(mode=Mode.DUAL),
        TrackerMemory(home=TRUST),
    ):
        assert asked(turned(180.0), turned(90.0), memory=memory) == LimitReview()
    states = [TrackerState(turned(deg), READY) for deg in (180.0, 90.0)]
    assert target_review(states[0], states[1], None, NOON) == LimitReview()


def test_who_loses_the_home_position_is_asked_nothing() -> None:
    for other in (
        mounted(CONFIG, MountKind.EQUATORIAL, SAMSUN.latitude_deg),
        replace(CONFIG, drive=DriveConfig(DriveKind.MODBUS_TCP)),
    ):
        assert asked(CONFIG, other) == LimitReview()
    other = turned(90.0)
    assert asked(turned(180.0), other).doubts, "it keeps its home position"
    actuator = alexandru_diurnal()
    low_deg, high_deg = actuator.range_deg
    axis = replace(other.azimuth, minimum_deg=low_deg, maximum_deg=high_deg, speed_dps=3.0, jog_fast_dps=2.0)
    assert asked(turned(180.0), replace(other, azimuth=replace(axis, actuator=actuator))) == LimitReview()


def test_a_held_direction_moves_with_the_mount() -> None:
    memory = replace(READY, mode=Mode.FIXED)
    assert asked(CONFIG, CONFIG, memory=memory) == LimitReview()
    off = replace(memory, pointing=Pointing(azimuth_offset_deg=5.0))
    states = TrackerState(CONFIG, memory), TrackerState(CONFIG, off)
    (doubt,) = target_review(*states, SAMSUN, NOON).doubts
    assert "by up to 5.0°" in doubt.message


def test_what_limits_cut_off_moves_the_target() -> None:
    low = replace(CONFIG, elevation=replace(CONFIG.elevation, maximum_deg=40.0))
    (doubt,) = asked(low, CONFIG).doubts
    assert "elevation axis" in doubt.message


@pytest.mark.parametrize("half_range_deg", [200.0, 270.0])
def test_of_equivalent_angles_the_nearest_counts(half_range_deg: float) -> None:
    """The target of a turn and a half passes 180 degrees without a jump."""
    azimuth = replace(CONFIG.azimuth, minimum_deg=-half_range_deg, maximum_deg=half_range_deg)
    wide = replace(CONFIG, azimuth=azimuth)
    off = replace(READY, pointing=Pointing(azimuth_offset_deg=1.5))
    states = TrackerState(wide, READY), TrackerState(wide, off)
    for minutes in range(0, 60, 5):
        at = NOON + timedelta(minutes=minutes)
        (doubt,) = target_review(*states, SAMSUN, at, 170.0).doubts
        assert "by up to 1.5°" in doubt.message
        now, new = (float(text) for text in re.findall(r"(-?[0-9.]+)°[;.]?", doubt.message)[-2:])
        assert wrap180(new - now) == pytest.approx(1.5, abs=0.11)
        assert now > 0.0 or half_range_deg < now + 360.0, "where it stands, not a turn away"


def test_a_held_direction_is_faced_at_night_too() -> None:
    memory = replace(READY, mode=Mode.FIXED)
    off = replace(memory, pointing=Pointing(azimuth_offset_deg=30.0))
    for place in (SAMSUN, Location(78.2, 15.6)):
        for at in (NIGHT, datetime(2026, 12, 20, 12, tzinfo=UTC)):
            states = TrackerState(CONFIG, memory), TrackerState(CONFIG, off)
            (doubt,) = target_review(*states, place, at).doubts
            assert "by up to 30.0° within the next 24 hours. At present" in doubt.message


def test_in_polar_night_a_later_day_is_looked_at() -> None:
    off = replace(READY, pointing=Pointing(azimuth_offset_deg=5.0))
    at = datetime(2026, 12, 20, 12, tzinfo=UTC)
    states = TrackerState(CONFIG, READY), TrackerState(CONFIG, off)
    (doubt,) = target_review(*states, Location(78.2, 15.6), at).doubts
    assert "moves by up to 5.0° once the sun is up again." in doubt.message
