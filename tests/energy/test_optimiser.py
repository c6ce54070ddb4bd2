"""Step programs for any day, place, radiation, range and price: never below the midpoint rule."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.energy.alexandru import paper_day
from app.energy.equatorial import NOON_H, daylight_h, declination_deg
from app.energy.optimiser import (
    Limits,
    best_number,
    best_programs,
    best_steps,
    equal_steps,
    judged,
)
from app.energy.program import step_program
from app.energy.stepping import SolarDay, Steps, clear_day, following_whm2, midpoint_h, stepped_whm2
from app.sun.trigonometry import Array
from app.tracker.settings.stepped import StepFrame, TimeBase

ANY_DAY = st.integers(1, 365)
ANY_LATITUDE = st.floats(-66, 66)
QUADRATURE = 1e-7
"""How well integrals of the same day, cut at different instants, agree: measured 1e-8."""


def cloudy(share: float, at_h: float) -> SolarDay:
    """A day with a dark gap: no model's symmetry helps."""
    clear = clear_day(35.0, 100, declination_deg(100))

    def beam(solar_h: Array) -> Array:
        gap = 1.0 - share * np.exp(-(((solar_h - at_h) / 1.3) ** 2))
        return np.asarray(clear.beam(solar_h) * gap)

    return SolarDay(clear.latitude_deg, clear.declination_deg, beam, clear.begin_h, clear.end_h)


@settings(max_examples=10, deadline=None)
@given(ANY_LATITUDE, ANY_DAY, st.integers(0, 14), st.floats(20, 110), st.floats(0, 0.1))
def test_never_below_the_midpoint_rule(
    latitude_deg: float, day_of_year: int, count: int, range_deg: float, step_h: float
) -> None:
    day = clear_day(latitude_deg, day_of_year, declination_deg(day_of_year))
    limits = Limits(range_deg, step_h)
    found = best_steps(day, count, limits)
    by_rule = judged(day, equal_steps(day, count, limits), limits)
    assert found.net_wh >= by_rule.net_wh - 1e-9
    assert found.count == count
    assert all(abs(angle) <= range_deg + 1e-9 for angle in found.steps.angles_deg)


@settings(max_examples=6, deadline=None)
@given(st.floats(0.2, 1.0), st.floats(7, 17), st.integers(1, 10), st.floats(0, 0.2), st.floats(0, 3))
def test_never_below_it_under_any_sky_and_price(
    share: float, at_h: float, count: int, degree_wh: float, move_wh: float
) -> None:
    day = cloudy(share, at_h)
    limits = Limits(60.0, per_whm2=0.189, degree_wh=degree_wh, move_wh=move_wh)
    found = best_steps(day, count, limits)
    assert found.net_wh >= judged(day, equal_steps(day, count, limits), limits).net_wh - 1e-9


@settings(max_examples=10, deadline=None)
@given(ANY_LATITUDE, ANY_DAY, st.lists(st.floats(-60, 60), min_size=2, max_size=8, unique=True), st.data())
def test_no_instants_are_better_than_the_midpoints(
    latitude_deg: float, day_of_year: int, angles: list[float], data: st.DataObject
) -> None:
    """The rule itself: shifting the steps never helps, whatever the angles, within the integral's error."""
    day = clear_day(latitude_deg, day_of_year, declination_deg(day_of_year))
    falling = tuple(sorted(angles, reverse=True))
    tilt_deg = latitude_deg - day.declination_deg
    best = Steps(midpoint_h(falling), falling, tilt_deg)
    starts = tuple(sorted(start + data.draw(st.floats(-1, 1)) for start in best.starts_h))
    shifted_whm2 = stepped_whm2(day, Steps(starts, falling, tilt_deg))
    assert stepped_whm2(day, best) >= shifted_whm2 * (1 - QUADRATURE)


def test_each_further_step_brings_less_and_less() -> None:
    programs = best_programs(paper_day(), 16, Limits(60.0))
    gained = np.diff([one.collected_whm2 for one in programs])
    assert (gained > 0).all()
    assert (np.diff(gained) < 0).all()
    assert programs[-1].collected_whm2 < following_whm2(paper_day(), 22.0, 60.0)


def test_what_motion_costs_decides_the_best_number() -> None:
    def number(move_wh: float) -> int:
        return best_number(best_programs(paper_day(), 16, Limits(60, per_whm2=0.189, move_wh=move_wh))).count

    assert number(0.0) == 16
    assert 4 <= number(1.0) < 12
    assert number(1000.0) == 0


def test_a_step_that_takes_time_begins_half_of_it_earlier() -> None:
    slow = best_steps(paper_day(), 12, Limits(60.0, 0.2))
    quick = best_steps(paper_day(), 12, Limits(60.0))
    early = [a - b for a, b in zip(quick.steps.starts_h, slow.steps.starts_h, strict=True)]
    assert early == pytest.approx([0.1] * 12, abs=0.01)


def test_too_many_slow_steps_are_refused_with_a_sentence() -> None:
    with pytest.raises(ValueError, match="do not fit into"):
        best_steps(paper_day(), 20, Limits(60.0, 0.5))
    assert len(best_programs(paper_day(), 40, Limits(60.0, 0.5))) == 17


def test_polar_night_collects_nothing_and_polar_day_goes_round() -> None:
    night = clear_day(80.0, 355, declination_deg(355))
    assert (night.begin_h, night.end_h) == (NOON_H, NOON_H)
    assert best_steps(night, 6, Limits(60.0)).collected_whm2 == 0.0
    assert daylight_h(80.0, 23.0) == (0.0, 24.0)
    assert best_steps(clear_day(80.0, 172, 23.4), 6, Limits(110.0)).collected_whm2 > 5000


def test_the_result_is_a_program_for_a_tracker() -> None:
    best = best_steps(paper_day(), 12, Limits(60.0))
    program = step_program("Solstice", best.steps, 45.65)
    assert (program.frame, program.time_base) == (StepFrame.EQUATOR, TimeBase.SOLAR)
    assert len(program.steps) == 13
    assert program.steps[0].first_deg == -60.0, "the hour angle of a program is negative in the morning"
    assert program.steps[1].from_h == pytest.approx(best.steps.starts_h[0])
    assert program.steps[0].second_deg == pytest.approx(45.65 - best.steps.tilt_deg)


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        ({"range_deg": 0.0}, "between 1 and 120"),
        ({"step_h": 2.0}, "between 0 and 60 minutes"),
        ({"per_whm2": 0.0}, "above zero"),
        ({"degree_wh": -1.0}, "cannot be below zero"),
    ],
)
def test_limits_are_checked(wrong: dict[str, float], sentence: str) -> None:
    with pytest.raises(ValueError, match=sentence):
        Limits(**wrong)
