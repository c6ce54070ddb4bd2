"""Motion as a function of time: never faster, never harsher than allowed, always at the target in the end."""

from itertools import pairwise
from math import inf

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from app.simulation.trapezoid import Path, Phase, brake, move

angles = st.floats(-400.0, 400.0)
speeds = st.floats(0.01, 20.0)
accelerations = st.floats(0.05, 50.0)
starts = st.builds(Phase, st.floats(0.0, 1e6), angles, st.floats(-20.0, 20.0))
SLACK = 1e-6


def moments(path: Path) -> list[float]:
    """Every phase's start, and ten instants in each."""
    begun = [phase.start_s for phase in path.phases] + [path.end_s + 1.0]
    return [a + (b - a) * part / 10 for a, b in pairwise(begun) for part in range(10)] + begun[-1:]


@given(starts, angles, speeds, accelerations)
@example(Phase(0.0, 0.0, -2.0), -2.0, 1.0, 1.0)
@example(Phase(0.0, 0.0, 0.0), 0.0, 1.0, 1.0)
def test_a_move_ends_at_its_target_without_a_jump_and_never_too_fast_or_too_harsh(
    start: Phase, target_deg: float, speed_dps: float, acceleration_dps2: float
) -> None:
    path = move(start, target_deg, speed_dps, acceleration_dps2)
    assert path.at(path.end_s) == path.at(path.end_s + 1e6) == (target_deg, 0.0)
    assert path.end_s >= start.start_s
    assert path.at(start.start_s - 1.0) == (path.phases[0].position_deg, path.phases[0].velocity_dps)
    assert path.at(start.start_s) == pytest.approx((start.position_deg, start.velocity_dps), abs=1e-4)
    for before, after in pairwise(path.phases):
        reached = before.at(after.start_s)
        assert reached == pytest.approx((after.position_deg, after.velocity_dps), abs=1e-4)
    fastest = max(speed_dps, abs(start.velocity_dps))
    assert all(abs(path.at(moment)[1]) <= fastest + SLACK for moment in moments(path))
    assert all(abs(phase.acceleration_dps2) <= acceleration_dps2 for phase in path.phases)


@given(angles, st.floats(0.01, 300.0), speeds, accelerations)
def test_a_move_from_rest_takes_as_long_as_the_trapezoid_says(
    position_deg: float, way_deg: float, speed_dps: float, acceleration_dps2: float
) -> None:
    path = move(Phase(0.0, position_deg, 0.0), position_deg + way_deg, speed_dps, acceleration_dps2)
    ramps_deg = speed_dps**2 / acceleration_dps2
    if way_deg >= ramps_deg:
        expected_s = way_deg / speed_dps + speed_dps / acceleration_dps2
    else:
        expected_s = 2.0 * (way_deg / acceleration_dps2) ** 0.5
    assert path.end_s == pytest.approx(expected_s, rel=1e-4, abs=1e-6)


@given(starts, accelerations)
def test_braking_ends_at_rest_in_the_direction_of_travel(start: Phase, acceleration_dps2: float) -> None:
    path = brake(start, acceleration_dps2)
    assert path.at(inf if path.end_s == inf else path.end_s + 1.0)[1] == 0.0
    way_deg = path.end_deg - start.position_deg
    assert way_deg * start.velocity_dps >= 0.0
    assert abs(way_deg) == pytest.approx(start.velocity_dps**2 / (2 * acceleration_dps2), abs=1e-6)
