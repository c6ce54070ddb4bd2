"""What one reading says against going on: every guard at its edge, by the code of its reason."""

from dataclasses import replace

import pytest

from app.tracker.motion import guards
from app.tracker.motion.following_error import AxisWatch
from app.tracker.mounts.capabilities import axis_words
from app.tracker.mounts.usual import mounted
from app.tracker.settings.axes import Axis, AxisConfig
from app.tracker.settings.config import MountKind
from app.tracker.values.motion import AxisCommand, AxisFeedback, Feedback, Halt, Position, Velocity
from app.tracker.values.reason import Reason
from tests.tracker.plant import CONFIG, MORNING, TRUST

STANDS = AxisFeedback(30.0, 0.0, moving=False, homed=True)
SOUND = Feedback(STANDS, STANDS, boot_count=1)


def code(reason: Reason | None) -> str | None:
    return reason and reason.code


def turned(axis: Axis, **changes: object) -> Feedback:
    one = replace(STANDS, **changes)  # type: ignore[arg-type]
    return replace(SOUND, azimuth=one) if axis is Axis.AZIMUTH else replace(SOUND, elevation=one)


def test_a_drive_tells_its_own_fault() -> None:
    assert guards.drive_fault("T1", SOUND) is None
    reason = guards.drive_fault("T1", replace(SOUND, fault_code=1))
    assert code(reason) == "drive_fault"
    assert reason is not None
    assert "T1" in reason.message
    assert "fault code 1." in reason.message


@pytest.mark.parametrize("axis", list(Axis))
def test_two_switches_at_once_are_a_fault_of_the_wiring(axis: Axis) -> None:
    both = turned(axis, at_lower_limit=True, at_upper_limit=True)
    reason = guards.wiring_fault(CONFIG, both)
    assert code(reason) == "limit_switch_wiring"
    assert reason is not None
    assert str(axis) in reason.message
    for one in ({"at_lower_limit": True}, {"at_upper_limit": True}):
        assert guards.wiring_fault(CONFIG, turned(axis, **one)) is None
    apart = replace(turned(axis, at_lower_limit=True), azimuth=replace(STANDS, at_upper_limit=True))
    assert guards.wiring_fault(CONFIG, apart) is None or axis is Axis.AZIMUTH


@pytest.mark.parametrize("axis", list(Axis))
def test_a_switch_that_is_on_alone_is_told_with_the_one_way_that_is_free(axis: Axis) -> None:
    words = axis_words(CONFIG.mount, axis)
    assert words is not None
    ends = {"at_lower_limit": ("lower", words.grows), "at_upper_limit": ("upper", words.falls)}
    for switch, (end, free) in ends.items():
        (reason,) = guards.pressed_switches(CONFIG, turned(axis, **{switch: True}))
        assert reason.code == "at_limit_switch"
        on = f"The {end} limit switch of the {axis} axis of Tracker 1 is on"
        assert (
            reason.message == f"{on} although the axis is within its soft limits: the axis moves {free} only."
        )
        (outside,) = guards.pressed_switches(CONFIG, turned(axis, **{switch: True}, position_deg=-5.0))
        assert outside.message == f"{on}: the axis moves {free} only."
    assert guards.pressed_switches(CONFIG, SOUND) == ()
    both = turned(axis, at_lower_limit=True, at_upper_limit=True)
    assert guards.pressed_switches(CONFIG, both) == (), "that is a fault of the wiring"


def test_every_switch_that_is_on_is_told_and_none_of_an_axis_that_is_not_there() -> None:
    on = replace(STANDS, at_upper_limit=True)
    both = replace(SOUND, azimuth=on, elevation=on)
    assert len(guards.pressed_switches(CONFIG, both)) == 2
    single = mounted(CONFIG, MountKind.HORIZONTAL_SINGLE_AXIS, 41.0)
    (reason,) = guards.pressed_switches(single, both)
    assert "rotation axis" in reason.message


def test_a_restart_between_two_readings_is_seen_by_the_count_alone() -> None:
    assert guards.restart("T1", SOUND, SOUND) is None
    for count in (0, 2):
        assert code(guards.restart("T1", SOUND, replace(SOUND, boot_count=count))) == "drive_restarted"


def test_what_a_drive_did_while_it_did_not_answer() -> None:
    again = replace(SOUND, boot_count=2)
    assert code(guards.came_back("T1", SOUND, again)) == "drive_restarted"
    assert "lost its zero" not in guards.came_back("T1", SOUND, again).message
    tripped = replace(SOUND, watchdog_tripped=True)
    assert code(guards.came_back("T1", SOUND, tripped)) == "watchdog_tripped"
    assert code(guards.came_back("T1", None, tripped)) == "watchdog_tripped"
    assert code(guards.came_back("T1", SOUND, replace(tripped, boot_count=2))) == "drive_restarted"
    assert code(guards.came_back("T1", SOUND, SOUND)) == "drive_back"
    assert code(guards.came_back("T1", None, SOUND)) == "drive_back"


@pytest.mark.parametrize("axis", list(Axis))
def test_what_each_axis_did_while_the_drive_did_not_answer(axis: Axis) -> None:
    unhomed = turned(axis, homed=False)
    lost = guards.came_back("T1", SOUND, unhomed)
    assert code(lost) == "drive_restarted"
    assert "has lost its home reference" in lost.message
    assert code(guards.came_back("T1", unhomed, SOUND)) == "drive_back"
    assert code(guards.came_back("T1", unhomed, unhomed)) == "drive_back"
    moving = turned(axis, moving=True)
    assert code(guards.came_back("T1", moving, SOUND)) == "stopped_meanwhile"
    assert code(guards.came_back("T1", moving, moving)) == "drive_back"
    elsewhere = turned(axis, position_deg=moving.azimuth.position_deg + 0.51)
    assert code(guards.came_back("T1", SOUND, elsewhere)) == "drive_elsewhere"
    assert code(guards.came_back("T1", elsewhere, SOUND)) == "drive_elsewhere"
    assert code(guards.came_back("T1", SOUND, turned(axis, position_deg=30.5))) == "drive_back"
    far = turned(axis, moving=True, position_deg=90.0)
    assert code(guards.came_back("T1", far, moving)) == "drive_back"
    assert code(guards.came_back("T1", far, SOUND)) == "stopped_meanwhile"


def test_a_zero_belongs_to_a_life_of_the_drive() -> None:
    assert guards.home_doubt(CONFIG, TRUST, SOUND) is None
    assert code(guards.home_doubt(CONFIG, TRUST, replace(SOUND, boot_count=2))) == "drive_restarted"
    for axis in Axis:
        reason = guards.home_doubt(CONFIG, TRUST, turned(axis, homed=False))
        assert code(reason) == "not_homed"
        assert reason is not None
        assert str(axis) in reason.message


@pytest.mark.parametrize("axis", list(Axis))
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_position_may_change_by_what_the_axis_can_move(axis: Axis, sign: float) -> None:
    most_deg = CONFIG.axis(axis).speed_dps * 0.2 * 1.5 + 0.5
    within = turned(axis, position_deg=30.0 + sign * (most_deg - 0.001))
    beyond = turned(axis, position_deg=30.0 + sign * (most_deg + 0.001))
    assert guards.jump(CONFIG, SOUND, within, 0.2) is None
    reason = guards.jump(CONFIG, SOUND, beyond, 0.2)
    assert code(reason) == "encoder_jump"
    assert reason is not None
    assert str(axis) in reason.message
    assert f"{most_deg:.1f} degrees" in reason.message
    assert guards.jump(CONFIG, SOUND, turned(axis, position_deg=30.5), 0.0) is None


@pytest.mark.parametrize("axis", list(Axis))
def test_what_an_axis_does_wrong_is_told_with_its_name(axis: Axis) -> None:
    watch = AxisWatch(0.0, 0.0, 0.0, MORNING, None, 0.0, MORNING, 0.0, error_deg=-2.34)
    behind = guards.not_following(CONFIG, axis, watch)
    assert behind.code == "following_error"
    assert "following error is 2.3 degrees" in behind.message
    assert str(axis) in behind.message
    wrong = guards.wrong_way(CONFIG, axis)
    assert wrong.code == "wrong_direction"
    assert str(axis) in wrong.message


@pytest.mark.parametrize(
    ("command", "lower", "upper"),
    [
        (Halt(), False, False),
        (Velocity(0.0), False, False),
        (Velocity(0.5), False, True),
        (Velocity(-0.5), True, False),
        (Position(31.0, 2.0), False, True),
        (Position(29.0, 2.0), True, False),
        (Position(30.1, 2.0), False, False),
        (Position(29.9, 2.0), False, False),
        (Position(30.102, 2.0), False, True),
        (Position(29.898, 2.0), True, False),
    ],
)
def test_a_command_leads_into_the_switch_that_it_heads_for(
    command: AxisCommand, *, lower: bool, upper: bool
) -> None:
    tolerance_deg = 0.101
    at_lower, at_upper = replace(STANDS, at_lower_limit=True), replace(STANDS, at_upper_limit=True)
    assert guards.heads_into_switch(command, at_lower, tolerance_deg) is lower
    assert guards.heads_into_switch(command, at_upper, tolerance_deg) is upper
    assert not guards.heads_into_switch(command, STANDS, tolerance_deg)


def test_the_room_to_a_soft_limit_is_negative_beyond_it() -> None:
    axis = AxisConfig(-20.0, 90.0, 4.0, 2.0, 0.5, 2.0)
    assert guards.room_deg(axis, 80.0, 1) == 10.0
    assert guards.room_deg(axis, 95.0, 1) == -5.0
    assert guards.room_deg(axis, -15.0, -1) == 5.0
    assert guards.room_deg(axis, -25.0, -1) == -5.0


def test_each_axis_reads_its_own() -> None:
    apart = replace(SOUND, elevation=replace(STANDS, position_deg=1.0))
    assert guards.axis_feedback(apart, Axis.AZIMUTH).position_deg == 30.0
    assert guards.axis_feedback(apart, Axis.ELEVATION).position_deg == 1.0
