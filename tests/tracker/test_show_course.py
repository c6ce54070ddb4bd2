"""What was checked is what runs: the course of a show."""

from datetime import timedelta
from itertools import pairwise

import numpy as np
import pytest

from app.base.angles import separation_deg, wrap180
from app.tracker.memory.memory import Pointing
from app.tracker.programs.path import branches
from app.tracker.programs.show import ShowCourse, check_show
from app.tracker.settings.config import Orientation
from tests.tracker.shows import (
    ACROSS_MIDNIGHT,
    PLAIN,
    SOLSTICE,
    with_range,
)

PERIOD = timedelta(milliseconds=100)


def test_across_midnight_the_night_ends_where_the_sun_will_rise() -> None:
    course, check = ShowCourse(ACROSS_MIDNIGHT, PLAIN), check_show(ACROSS_MIDNIGHT, PLAIN)
    assert check.feasible
    assert [notice.code for notice in check.notices] == ["sun_down"]
    (_, dusk), (dawn, _) = check.sun_up
    before = course.at((dusk - ACROSS_MIDNIGHT.begin_at) / ACROSS_MIDNIGHT.acceleration + PERIOD)
    assert not before.sun_is_up
    assert before.target.azimuth_deg == pytest.approx(302.9, abs=0.5)
    after = course.at((dawn - ACROSS_MIDNIGHT.begin_at) / ACROSS_MIDNIGHT.acceleration - PERIOD)
    assert not after.sun_is_up
    assert after.repositioning
    assert after.target.azimuth_deg == pytest.approx(57.1, abs=0.5)


def test_the_course_is_the_path_that_was_checked() -> None:
    check, course = check_show(ACROSS_MIDNIGHT, PLAIN), ShowCourse(ACROSS_MIDNIGHT, PLAIN)
    last = len(check.path.panel_azimuth_deg) - 1
    for row in range(0, last + 1, 30):
        aim = course.at(ACROSS_MIDNIGHT.duration * row / last)
        assert aim.sun_time.timestamp() == pytest.approx(check.path.sun_time_unix_s[row], abs=1e-3)
        assert aim.axis_target.azimuth_deg == pytest.approx(check.path.panel_azimuth_deg[row], abs=1e-3)
        assert aim.axis_target.elevation_deg == pytest.approx(check.path.panel_elevation_deg[row], abs=1e-3)


def test_while_the_sun_is_up_the_target_is_the_sun() -> None:
    course = ShowCourse(SOLSTICE, PLAIN)
    for seconds in range(0, 180, 7):
        aim = course.at(timedelta(seconds=seconds))
        assert aim.sun_is_up
        assert aim.target == Orientation(aim.sun.azimuth_deg, aim.sun.apparent_elevation_deg)
        off_deg = separation_deg(
            aim.axis_target.azimuth_deg,
            aim.axis_target.elevation_deg,
            aim.sun.azimuth_deg,
            aim.sun.apparent_elevation_deg,
        )
        assert off_deg < 0.25


def test_the_setpoint_is_ahead_of_the_target() -> None:
    aim = ShowCourse(SOLSTICE, PLAIN).at(timedelta(seconds=90))
    assert 0.5 < aim.axis_setpoint.azimuth_deg - aim.axis_target.azimuth_deg < 3.0


def test_a_show_asked_beyond_its_end_stays_at_its_end() -> None:
    course = ShowCourse(SOLSTICE, PLAIN)
    assert course.at(timedelta(hours=1)) == course.at(SOLSTICE.duration)
    assert course.at(SOLSTICE.duration).sun_time == SOLSTICE.end_at
    assert course.at(timedelta(seconds=-1)) == course.at(timedelta(0))


def test_a_pointing_correction_moves_the_axes_and_not_the_target() -> None:
    corrected = ShowCourse(SOLSTICE, PLAIN, Pointing(azimuth_offset_deg=5.0)).at(timedelta(seconds=60))
    plain = ShowCourse(SOLSTICE, PLAIN).at(timedelta(seconds=60))
    assert corrected.target == plain.target
    assert corrected.axis_target.azimuth_deg == pytest.approx(plain.axis_target.azimuth_deg + 5.0)


def test_every_branch_shows_the_same_direction() -> None:
    azimuth_deg = np.linspace(30.0, 30.0 - 500.0, 400)
    axis = with_range(0.0, 540.0).azimuth
    turns = branches(axis, azimuth_deg, 270.0)
    reached = azimuth_deg + 360.0 * turns
    assert reached.min() >= -1e-6
    assert reached.max() <= 540.0 + 1e-6
    assert sum(left != right for left, right in pairwise(turns.tolist())) == 1
    assert all(
        abs(wrap180(a - b)) < 1e-9 for a, b in zip(reached.tolist(), azimuth_deg.tolist(), strict=True)
    )
