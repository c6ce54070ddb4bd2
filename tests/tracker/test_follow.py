"""The reference axis, number by number: ramps, braking, lag, patience, and which way is the wrong one."""

from dataclasses import replace
from datetime import timedelta
from math import sqrt

import pytest

from app.tracker.motion.following_error import AxisWatch, watch
from app.tracker.settings.axes import AxisConfig
from app.tracker.values.motion import AxisCommand, AxisFeedback, Halt, Position, Velocity
from tests.tracker.plant import MORNING

AXIS = AxisConfig(-200.0, 200.0, 4.0, 2.0, 0.5, 2.0)
ALLOWED_DEG = 2.0
TENTH = timedelta(seconds=0.1)
AT_REST = AxisWatch(10.0, 0.0, 0.0, MORNING, None, 0.0, MORNING, 10.0)


def seen(position_deg: float = 10.0, velocity_dps: float = 0.0) -> AxisFeedback:
    return AxisFeedback(position_deg, velocity_dps, moving=velocity_dps != 0.0, homed=True)


def step(
    before: AxisWatch | None, command: AxisCommand, at: AxisFeedback | None = None, seconds: float = 0.1
) -> AxisWatch:
    now = MORNING if before is None else before.at + timedelta(seconds=seconds)
    watched = watch(before, AXIS, command, at or seen(), now, ALLOWED_DEG)
    assert watched is not None
    return watched


def test_a_watch_begins_where_the_axis_is_and_as_fast() -> None:
    assert step(None, Velocity(4.0), seen(12.5, 1.5)) == AxisWatch(
        12.5, 1.5, 0.0, MORNING, None, 0.0, MORNING, 12.5
    )
    assert watch(AT_REST, AXIS, Halt(), seen(), MORNING, ALLOWED_DEG) is None


@pytest.mark.parametrize(("velocity_dps", "sign"), [(4.0, 1.0), (-4.0, -1.0)])
def test_the_reference_gathers_speed_as_rated(velocity_dps: float, sign: float) -> None:
    one = step(AT_REST, Velocity(velocity_dps))
    two = step(one, Velocity(velocity_dps))
    assert one.speed_dps == pytest.approx(sign * 0.2)
    assert one.position_deg == pytest.approx(10.0 + sign * 0.02)
    assert two.speed_dps == pytest.approx(sign * 0.4)
    assert two.position_deg == pytest.approx(10.0 + sign * 0.06)
    assert two.way_deg == pytest.approx(0.06)
    assert two.error_deg == pytest.approx(sign * 0.06)
    assert two.at == MORNING + 2 * TENTH


def test_a_late_look_is_advanced_in_steps_and_for_two_seconds_at_most() -> None:
    late = step(AT_REST, Velocity(4.0), seconds=0.25)
    assert late.speed_dps == pytest.approx(0.5)
    assert late.position_deg == pytest.approx(10.0 + 0.125 * 0.25 + 0.125 * 0.5)
    long_ago = step(AT_REST, Velocity(4.0), seconds=60.0)
    assert long_ago.speed_dps == pytest.approx(4.0)
    assert long_ago.position_deg == pytest.approx(10.0 + sum(0.1 * 0.2 * n for n in range(1, 21)))


def test_two_looks_at_one_instant_change_nothing() -> None:
    moving = replace(AT_REST, speed_dps=1.0)
    assert step(moving, Velocity(4.0), seconds=0.0).position_deg == 10.0
    assert step(moving, Position(20.0, 4.0), seconds=0.0).speed_dps == 1.0


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_reference_brakes_so_that_it_stands_at_the_place(sign: float) -> None:
    fast = replace(AT_REST, speed_dps=sign * 4.0)
    near = step(fast, Position(10.0 + sign * 3.9, 4.0))
    assert near.speed_dps == pytest.approx(sign * sqrt(2.0 * 2.0 * 3.9))
    slow = step(fast, Position(10.0 + sign * 30.0, 1.0))
    assert slow.speed_dps == pytest.approx(sign * 3.8)
    last = step(replace(AT_REST, speed_dps=sign * 0.15), Position(10.0 + sign * 0.01, 4.0))
    assert last.speed_dps == pytest.approx(sign * 0.1)
    assert last.position_deg == pytest.approx(10.0 + sign * 0.01)


def behind(error_deg: float, speed_dps: float, way_deg: float) -> bool:
    """Return whether an axis counts as behind whose reference turns steadily and is off by so much."""
    steady = replace(AT_REST, speed_dps=speed_dps, way_deg=way_deg - abs(speed_dps) * 0.1)
    at = seen(10.0 + speed_dps * 0.1 - error_deg)
    return step(steady, Velocity(speed_dps), at).behind_since is not None


@pytest.mark.parametrize(
    ("speed_dps", "way_deg", "limit_deg"),
    [(0.0, 0.0, 2.0), (3.0, 0.3, 2.0 + 3.0 * 0.4 + 0.03), (-3.0, 15.0, 2.0 + 1.2 + 1.5)],
)
def test_what_is_allowed_grows_with_speed_and_way(speed_dps: float, way_deg: float, limit_deg: float) -> None:
    for sign in (1.0, -1.0):
        assert not behind(sign * (limit_deg - 0.001), speed_dps, way_deg)
        assert behind(sign * (limit_deg + 0.001), speed_dps, way_deg)
    assert not behind(2.0, 0.0, 0.0), "the limit itself is allowed"


def test_an_axis_is_given_half_a_second() -> None:
    one = step(AT_REST, Velocity(0.0), seen(20.0))
    assert one.behind_since == one.at
    two = step(one, Velocity(0.0), seen(20.0))
    assert two.behind_since == one.at
    assert two.follows(one.at + timedelta(seconds=0.499))
    assert not two.follows(one.at + timedelta(seconds=0.5))
    assert step(two, Velocity(0.0), seen(10.5)).behind_since is None
    assert AT_REST.follows(MORNING + timedelta(hours=1))


def test_after_a_long_way_the_reference_is_set_to_the_axis_unless_it_is_behind() -> None:
    steady = replace(AT_REST, speed_dps=4.0, way_deg=20.0)
    anew = step(steady, Velocity(4.0), seen(9.0))
    assert (anew.position_deg, anew.way_deg) == (9.0, 0.0)
    assert anew.error_deg == pytest.approx(1.4)
    not_yet = step(replace(steady, way_deg=19.6), Velocity(4.0), seen(9.0))
    assert not_yet.way_deg == pytest.approx(20.0)
    assert not_yet.position_deg == pytest.approx(10.4)
    lost = step(steady, Velocity(4.0), seen(0.0))
    assert lost.position_deg == pytest.approx(10.4)
    assert lost.way_deg == pytest.approx(20.4)


@pytest.mark.parametrize(
    ("command", "at_deg", "direction"),
    [
        (Position(20.0, 4.0), 10.0, 1.0),
        (Position(0.0, 4.0), 10.0, -1.0),
        (Position(10.051, 4.0), 10.0, 1.0),
        (Position(0.05, 4.0), 0.0, 0.0),
        (Position(9.949, 4.0), 10.0, -1.0),
        (Velocity(2.0), 10.0, 1.0),
        (Velocity(-2.0), 10.0, -1.0),
    ],
)
def test_the_way_of_a_command_is_judged_from_the_axis(
    command: AxisCommand, at_deg: float, direction: float
) -> None:
    assert step(AT_REST, command, seen(at_deg)).direction == direction


def test_a_turn_is_noted_when_the_command_changes_its_way_and_when_the_reference_still_brakes() -> None:
    east = replace(AT_REST, direction=1.0, speed_dps=2.0, turned_deg=5.0)
    same = step(east, Velocity(4.0), seen(10.2))
    assert (same.turned_at, same.turned_deg) == (MORNING, 5.0)
    back = step(east, Velocity(-4.0), seen(10.2))
    assert (back.turned_at, back.turned_deg) == (MORNING + TENTH, 10.2)
    braking = step(back, Velocity(-4.0), seen(10.4))
    assert braking.speed_dps > 0.0
    assert (braking.turned_at, braking.turned_deg) == (MORNING + 2 * TENTH, 10.4)
    standing = step(replace(AT_REST, direction=-1.0, speed_dps=0.2, turned_deg=5.0), Velocity(-4.0))
    assert standing.speed_dps == pytest.approx(0.0)
    assert standing.turned_deg == 5.0


@pytest.mark.parametrize(("direction", "sign"), [(1.0, -1.0), (-1.0, 1.0)])
def test_the_wrong_way_is_more_than_play_and_lasts(direction: float, sign: float) -> None:
    watched = replace(AT_REST, direction=direction)
    late, early = MORNING + timedelta(seconds=0.5), MORNING + timedelta(seconds=0.499)
    assert watched.turns_wrongly(10.0 + sign * 0.31, late)
    assert not watched.turns_wrongly(10.0 + sign * 0.31, early)
    assert not watched.turns_wrongly(10.0 + sign * 0.29, late)
    assert not watched.turns_wrongly(10.0 - sign * 5.0, late)
    exact = replace(watched, turned_deg=0.0)
    assert not exact.turns_wrongly(sign * 0.3, late)
    assert not replace(AT_REST, direction=0.0).turns_wrongly(0.0, late)
