"""Which shows a tracker can run, and what is said about those it cannot."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta
from itertools import pairwise
from typing import Any
from zoneinfo import ZoneInfo

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.base.angles import separation_deg, wrap180
from app.sun.position import Location
from app.tracker.memory.memory import Pointing
from app.tracker.programs.path import branches
from app.tracker.programs.show import ShowCourse, ShowPlan, check_show
from app.tracker.settings.axes import AxisConfig
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.values.mode import Mode
from app.tracker.values.reason import Reason
from tests.amount import amount
from tests.tracker.shows import (
    ACROSS_MIDNIGHT,
    PLAIN,
    SAMSUN,
    SOLSTICE,
    SOUTH,
    SVALBARD,
    ZENITH_DAY,
    show,
    utc,
    with_range,
)


def codes(reasons: tuple[Reason, ...]) -> list[str]:
    return [reason.code for reason in reasons]


def test_the_solstice_at_samsun_in_three_minutes_works() -> None:
    check = check_show(SOLSTICE, PLAIN)
    assert check.feasible
    assert check.notices == ()
    assert 3.0 < check.peak_azimuth_dps < 4.5
    assert 0.5 < check.peak_elevation_dps < 1.5
    assert check.start.azimuth_deg == pytest.approx(57.2, abs=0.1)
    assert check.start.elevation_deg == 0.0
    assert check.sun_up == ((SOLSTICE.begin_at, SOLSTICE.end_at),)


def test_the_same_in_twenty_seconds_is_refused_with_what_would_work() -> None:
    check = check_show(replace(SOLSTICE, duration=timedelta(seconds=20)), PLAIN)
    assert codes(check.reasons) == ["azimuth_too_fast", "elevation_too_fast"]
    assert "34.03 degrees a second" in check.reasons[0].message
    assert "rated 6.00" in check.reasons[0].message
    assert check.shortest == timedelta(minutes=2)
    assert check.reasons[0].hint == "The shortest simulation time that works is 2 min 0 s."


@pytest.mark.parametrize(
    ("plan", "tracker"),
    [
        (SOLSTICE, PLAIN),
        (ACROSS_MIDNIGHT, PLAIN),
        (SOUTH, PLAIN),
    ],
    ids=["solstice", "across midnight", "south"],
)
def test_the_shortest_duration_works_and_a_second_less_does_not(
    plan: ShowPlan, tracker: TrackerConfig
) -> None:
    shortest = check_show(plan, tracker).shortest
    assert shortest is not None
    assert shortest.total_seconds() == int(shortest.total_seconds())
    assert check_show(replace(plan, duration=shortest), tracker).feasible
    assert not check_show(replace(plan, duration=shortest - timedelta(seconds=1)), tracker).feasible


def test_a_night_too_short_for_the_axes_is_a_reason() -> None:
    slow = replace(PLAIN, azimuth=AxisConfig(0.0, 360.0, 2.5, 1.0, 0.5, 2.0))
    plan = show(SAMSUN, utc(2026, 6, 21, 16, 50), utc(2026, 6, 22, 2, 30), 60.0)
    check = check_show(plan, slow)
    assert codes(check.reasons) == ["night_too_short"]
    assert check.shortest is not None
    assert check_show(replace(plan, duration=check.shortest), slow).feasible


def test_a_show_that_begins_by_night_waits_where_the_sun_will_rise() -> None:
    plan = show(SAMSUN, utc(2026, 6, 21), utc(2026, 6, 21, 9), 180.0)
    check = check_show(plan, PLAIN)
    assert check.feasible
    assert check.start.azimuth_deg == pytest.approx(57.2, abs=0.1)
    assert "2 h 1 min" in check.notices[0].message
    assert not check.path.sun_is_up[0]
    assert check.path.sun_is_up[-1]
    first = ShowCourse(plan, PLAIN).at(timedelta(0))
    assert not first.sun_is_up
    assert first.sun.elevation_deg < -1.0
    assert not first.repositioning


@pytest.mark.parametrize(
    ("begin_hour", "seconds", "range_deg", "told"),
    [
        (0, 180.0, (0.0, 540.0), []),
        (0, 180.0, (0.0, 360.0), ["limited"]),
        (-13, 400.0, (0.0, 360.0), ["unwinding"]),
    ],
    ids=["turns further", "waits at its end stop", "unwinds at midnight"],
)
def test_a_polar_day_of_24_hours_is_shown_in_one_piece(
    begin_hour: int, seconds: float, range_deg: tuple[float, float], told: list[str]
) -> None:
    begin = utc(2026, 6, 21) + timedelta(hours=begin_hour)
    check = check_show(show(SVALBARD, begin, begin + timedelta(days=1), seconds), with_range(*range_deg))
    assert check.feasible
    assert codes(check.notices) == told
    assert check.path.sun_is_up.all()
    assert (check.path.panel_azimuth_deg.max() > 360.0) == (range_deg[1] > 360.0)


def test_through_the_north_an_axis_of_0_to_360_unwinds_at_noon_as_slowly_as_it_turns() -> None:
    check = check_show(SOUTH, PLAIN)
    assert check.feasible
    assert codes(check.notices) == ["unwinding"]
    assert "turns from 0 to 330 degrees" in check.notices[0].message
    path = check.path
    step_s = SOUTH.duration.total_seconds() / (len(path.panel_azimuth_deg) - 1)
    speeds_dps = np.abs(np.diff(path.panel_azimuth_deg)) / step_s
    turning_s = step_s * np.count_nonzero(speeds_dps > 0.9 * PLAIN.azimuth.speed_dps)
    assert speeds_dps.max() < 1.02 * PLAIN.azimuth.speed_dps
    assert turning_s == pytest.approx(330.0 / PLAIN.azimuth.speed_dps, abs=2.0)


def test_a_notice_tells_the_time_of_the_zone_in_which_the_show_was_planned() -> None:
    begin, end = (at.astimezone(ZoneInfo("Australia/Sydney")) for at in (SOUTH.begin_at, SOUTH.end_at))
    local, utc_ = check_show(replace(SOUTH, begin_at=begin, end_at=end), PLAIN), check_show(SOUTH, PLAIN)
    assert local.notices[0].message.startswith("At 12:0")
    assert "(Australia/Sydney) the azimuth axis reaches its end stop" in local.notices[0].message
    assert utc_.notices[0].message.startswith("At 02:0")
    assert "(UTC) the azimuth axis reaches its end stop" in utc_.notices[0].message


@pytest.mark.parametrize(
    ("tracker", "start_deg"), [(with_range(-180.0, 180.0), 63.6), (with_range(0.0, 540.0), 423.6)]
)
def test_through_the_north_other_axes_need_no_unwinding(tracker: TrackerConfig, start_deg: float) -> None:
    check = check_show(replace(SOUTH, duration=timedelta(seconds=180)), tracker)
    assert check.feasible
    assert check.notices == ()
    assert check.start.azimuth_deg == pytest.approx(start_deg, abs=0.2)


def test_unwinding_that_takes_more_than_a_fifth_of_the_show_is_refused() -> None:
    check = check_show(replace(SOUTH, duration=timedelta(seconds=100)), PLAIN)
    assert codes(check.reasons) == ["repositioning_too_long"]
    assert "at most 20%" in check.reasons[0].message
    assert check.shortest is not None
    assert timedelta(minutes=4) < check.shortest < timedelta(minutes=6)


def test_a_sun_through_the_zenith_is_announced_with_what_it_costs() -> None:
    check = check_show(ZENITH_DAY, PLAIN)
    assert check.feasible
    assert codes(check.notices) == ["keyhole"]
    assert "passes too near the zenith" in check.notices[0].message
    assert "s of the show, 2 h" in check.notices[0].message
    assert check.peak_azimuth_dps <= 6.0


@pytest.mark.parametrize(
    ("mode", "azimuths_deg", "elevations_deg", "fastest_dps"),
    [
        (Mode.FIXED, (120.0, 120.0), (35.0, 35.0), (0.0, 0.0)),
        (Mode.ELEVATION, (120.0, 120.0), (0.0, 72.15), (0.0, 2.0)),
        (Mode.AZIMUTH, (57.2, 302.8), (35.0, 35.0), (3.0, 4.5)),
    ],
    ids=str,
)
def test_a_mode_holds_the_axes_that_it_does_not_turn(
    mode: Mode,
    azimuths_deg: tuple[float, float],
    elevations_deg: tuple[float, float],
    fastest_dps: tuple[float, float],
) -> None:
    check = check_show(replace(SOLSTICE, mode=mode, orientation=Orientation(120.0, 35.0)), PLAIN)
    path = check.path
    assert check.feasible
    for angles_deg, ends_deg in (
        (path.panel_azimuth_deg, azimuths_deg),
        (path.panel_elevation_deg, elevations_deg),
    ):
        assert (angles_deg.min(), angles_deg.max()) == pytest.approx(ends_deg, abs=0.1)
    assert fastest_dps[0] <= max(check.peak_azimuth_dps, check.peak_elevation_dps) <= fastest_dps[1]


def test_directions_beyond_the_limits_are_a_notice() -> None:
    check = check_show(SOLSTICE, with_range(90.0, 270.0))
    assert check.feasible
    assert codes(check.notices) == ["limited"]
    assert "up to 32.8 degrees away" in check.notices[0].message
    assert ShowCourse(SOLSTICE, with_range(90.0, 270.0)).at(timedelta(0)).axis_target.limited


@pytest.mark.parametrize(
    ("change", "code", "words"),
    [
        ({"end_at": utc(2026, 6, 21, 1)}, "end_before_start", "ends before it starts"),
        ({"end_at": utc(2026, 6, 23, 3)}, "interval_too_long", "more than 48 hours"),
        ({"duration": timedelta(seconds=9)}, "duration_out_of_range", "between 10 seconds and 24 hours"),
        ({"duration": timedelta(hours=25)}, "duration_out_of_range", "not 25 h 0 min"),
        ({"begin_at": utc(1850, 6, 21, 4), "end_at": utc(1850, 6, 21, 9)}, "year_out_of_range", "1901"),
        ({"begin_at": utc(2026, 6, 21, 20), "end_at": utc(2026, 6, 21, 23)}, "sun_never_up", "sun"),
    ],
)
def test_a_plan_that_makes_no_sense_is_refused_in_a_sentence(
    change: dict[str, Any], code: str, words: str
) -> None:
    check = check_show(replace(SOLSTICE, **change), PLAIN)
    assert not check.feasible
    assert code in codes(check.reasons)
    assert any(words in reason.message for reason in check.reasons)
    assert all(reason.hint for reason in check.reasons)


@settings(max_examples=amount(8, 60), deadline=None)
@given(
    latitude_deg=st.floats(-90.0, 90.0),
    longitude_deg=st.floats(-180.0, 180.0),
    begin_s=st.integers(-631_152_000, 2_524_608_000),
    hours=st.floats(0.01, 48.0),
    seconds=st.floats(10.0, 3600.0),
    lower_deg=st.sampled_from([0.0, -180.0, -90.0]),
    width_deg=st.sampled_from([180.0, 340.0, 360.0, 540.0]),
    mode=st.sampled_from(Mode),
)
def test_any_show_anywhere_is_either_inside_the_limits_or_refused_with_a_reason(
    latitude_deg: float,
    longitude_deg: float,
    begin_s: int,
    hours: float,
    seconds: float,
    lower_deg: float,
    width_deg: float,
    mode: Mode,
) -> None:
    begin, tracker = datetime.fromtimestamp(begin_s, UTC), with_range(lower_deg, lower_deg + width_deg)
    location = Location(latitude_deg, longitude_deg)
    plan = show(location, begin, begin + timedelta(hours=hours), seconds, mode=mode)
    check = check_show(plan, tracker)
    assert check.feasible == (not check.reasons)
    assert all(tracker.azimuth.contains(angle) for angle in check.path.panel_azimuth_deg.tolist())
    assert all(tracker.elevation.contains(angle) for angle in check.path.panel_elevation_deg.tolist())
    if check.shortest is not None:
        assert check_show(replace(plan, duration=check.shortest), tracker).feasible
    if check.feasible:
        assert check.shortest is not None
        assert check.peak_azimuth_dps <= tracker.azimuth.speed_dps


def test_where_no_duration_works_the_hint_says_so() -> None:
    crawling = replace(PLAIN, azimuth=AxisConfig(0.0, 360.0, 0.001, 6.0, 0.001, 0.001))
    check = check_show(SOLSTICE, crawling)
    assert check.shortest is None
    assert check.reasons[0].hint == "No simulation time up to 24 hours works: choose another interval."


def test_the_sun_goes_on_evenly_where_clocks_are_set_forward() -> None:
    berlin = ZoneInfo("Europe/Berlin")
    begin, end = datetime(2027, 3, 28, 0, tzinfo=berlin), datetime(2027, 3, 28, 12, tzinfo=berlin)
    plan = replace(SOLSTICE, begin_at=begin, end_at=end, duration=timedelta(seconds=110))
    assert plan.acceleration == pytest.approx(360.0)
    seen = [plan.sun_time(timedelta(seconds=second)).astimezone(UTC) for second in range(111)]
    assert {after - before for before, after in pairwise(seen)} == {timedelta(minutes=6)}
    assert seen[-1] == end.astimezone(UTC)


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
