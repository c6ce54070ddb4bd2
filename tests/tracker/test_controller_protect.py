"""What ends motion by itself: a lost drive, faults, switches, an axis that does not do what it is told."""

from dataclasses import replace
from datetime import timedelta

import pytest

from app.simulation.faults import Fault, FaultKind
from app.tracker.commands.commands import (
    Command,
    CommandRejected,
    GoToStart,
    Home,
    Jog,
    Move,
    ResetFault,
    RunCommunicationLossTest,
    RunShow,
    SetHome,
    Stop,
    Stow,
    Track,
)
from app.tracker.motion.following_error import AxisWatch, watch
from app.tracker.settings.axes import Axis, AxisConfig
from app.tracker.settings.config import Orientation
from app.tracker.settings.protections import StowName
from app.tracker.state.snapshot import ActivityName, EventKind
from app.tracker.values.motion import HALT, AxisCommand, AxisFeedback, DriveCommand, Position, Velocity
from tests.tracker.plant import MORNING, READY, Plant
from tests.tracker.scripted import Scripted
from tests.tracker.shows import SOLSTICE

SOUTH = Move(Orientation(180.0, 45.0))


def test_a_lost_drive_ends_tracking_which_then_waits_for_the_operator(plant: Plant) -> None:
    plant.ask(Track())
    plant.forward(60.0)
    plant.cut = True
    plant.forward(0.5)
    assert plant.activity is ActivityName.TRACKING
    plant.forward(0.3)
    shown = plant.snapshot
    assert plant.told == DriveCommand()
    assert shown.activity is ActivityName.HOLDING
    assert shown.activity_text == "No connection to the drive"
    assert shown.measured is None
    assert shown.last_measured is not None
    assert shown.position_age_s == pytest.approx(0.8)
    assert plant.reasons("track") >= {"drive_unreachable"}
    plant.forward(2.0)
    plant.cut = False
    plant.forward(5.0)
    assert len(plant.happened(EventKind.DRIVE_LOST)) == len(plant.happened(EventKind.DRIVE_FOUND)) == 1
    assert plant.activity is ActivityName.HOLDING
    assert plant.snapshot.waiting[0].code == "drive_lost"
    plant.ask(Track())
    plant.forward(1.0)
    assert plant.snapshot.waiting == ()


def test_a_silent_drive_is_named_first_and_nothing_asks_to_wait_for_standstill(plant: Plant) -> None:
    plant.ask(SOUTH)
    plant.forward(1.0)
    plant.cut = True
    plant.forward(2.0)
    plant.ask(Stop())
    plant.forward(75.0)
    seen = plant.snapshot
    assert seen.activity is ActivityName.STOPPING
    assert seen.activity_text == "No connection to the drive"
    for action in ("jog", "step", "set_home", "home", "move", "park", "track"):
        assert seen.actions[action][0].code == "drive_unreachable"
    hints = [reason.hint for given in seen.actions.values() for reason in given]
    assert not [hint for hint in hints if "standstill" in hint]
    plant.cut = False
    plant.forward(3.0)
    assert plant.snapshot.activity is ActivityName.HOLDING


def test_a_single_failed_reading_changes_nothing(plant: Plant) -> None:
    plant.ask(SOUTH)
    plant.forward(1.0)
    told = plant.told
    plant.cut = True
    plant.forward(0.1)
    assert plant.told == told
    plant.cut = False
    plant.forward(40.0)
    assert plant.happened(EventKind.MOVE_ENDED)[0].data["outcome"] == "in_position"


def test_a_drive_that_never_answered_is_said_to_be_lost_once(plant: Plant) -> None:
    silent = Plant()
    silent.cut = True
    silent.forward(3.0)
    assert len(silent.happened(EventKind.DRIVE_LOST)) == 1
    assert silent.snapshot.position_age_s is None
    assert silent.snapshot.azimuth is None


def test_a_drive_fault_is_latched_over_a_restart_and_costs_the_zero(plant: Plant) -> None:
    plant.ask(SOUTH)
    plant.forward(1.0)
    plant.drive.inject(Fault(FaultKind.DRIVE_FAULT, amount=21.0))
    plant.forward(0.2)
    assert plant.activity is ActivityName.FAULTED
    memory = plant.controller.memory
    assert (memory.fault_code, memory.home) == ("drive_fault", None)
    assert "fault code 21" in memory.fault_text
    assert "Stopped by a fault" in plant.snapshot.activity_text
    assert plant.reasons("jog") == {"fault"}
    plant.ask(Stop())
    assert plant.activity is ActivityName.FAULTED
    again = Plant(memory)
    assert again.activity is ActivityName.FAULTED
    assert again.snapshot.fault is not None
    again.tick()
    assert again.ask(ResetFault()) == [EventKind.FAULT_RESET]
    assert again.controller.memory.fault_code is None


def test_a_reset_clears_the_drive_too_and_nothing_moves_by_itself(plant: Plant) -> None:
    plant.ask(Track())
    plant.forward(5.0)
    plant.drive.inject(Fault(FaultKind.DRIVE_FAULT, amount=21.0))
    plant.forward(1.0)
    assert plant.ask(ResetFault()) == []
    plant.forward(0.5)
    assert plant.happened(EventKind.FAULT_RESET)
    assert plant.drive.observe().fault_code == 0
    plant.forward(5.0)
    assert plant.activity is ActivityName.HOLDING
    assert "tracker_not_homed" in {reason.code for reason in plant.snapshot.waiting}


@pytest.mark.parametrize("answers", [True, False])
def test_a_reset_that_the_drive_does_not_do_leaves_the_fault(*, answers: bool) -> None:
    script = Scripted(READY)
    script.sees(fault_code=3)
    script.tick()
    script.ask(ResetFault())
    if answers:
        script.answers()
    script.forward(5.5)
    assert "still there" in script.happened(EventKind.FAULT_RAISED)[-1].message
    assert script.told.request is None
    assert script.controller.activity is ActivityName.FAULTED


def test_two_pressed_switches_of_one_axis_forbid_all_motion_until_the_wiring_is_right() -> None:
    script = Scripted(READY)
    assert script.reading is not None
    sound = script.reading
    both = replace(sound.elevation, at_lower_limit=True, at_upper_limit=True)
    script.reading = replace(sound, elevation=both)
    script.tick()
    assert script.controller.memory.fault_code == "limit_switch_wiring"
    with pytest.raises(CommandRejected, match="Both limit switches"):
        script.ask(Jog("p", Axis.AZIMUTH, 1))
    assert script.ask(ResetFault()) == [EventKind.FAULT_RAISED]
    script.reading = sound
    script.tick()
    assert script.ask(ResetFault()) == [EventKind.FAULT_RESET]


def test_one_pressed_upper_switch_is_no_fault(plant: Plant) -> None:
    plant.drive.inject(Fault(FaultKind.UPPER_LIMIT_STUCK, Axis.ELEVATION))
    plant.forward(1.0)
    assert plant.activity is ActivityName.HOLDING


@pytest.mark.parametrize("axis", list(Axis))
def test_an_axis_that_turns_the_wrong_way_is_stopped_and_its_zero_forgotten(plant: Plant, axis: Axis) -> None:
    plant.ask(Move(Orientation(30.0, 30.0)))
    plant.forward(20.0)
    plant.drive.inject(Fault(FaultKind.WRONG_DIRECTION, axis))
    plant.ask(Move(Orientation(60.0, 60.0)))
    plant.forward(1.0)
    assert plant.controller.memory.fault_code == "wrong_direction"
    assert f"The {axis} axis" in plant.controller.memory.fault_text
    assert plant.controller.memory.home is None


def test_a_blocked_axis_is_found_while_a_key_is_held(plant: Plant) -> None:
    plant.drive.inject(Fault(FaultKind.STALL, Axis.AZIMUTH))
    sequence = 0
    while plant.activity is not ActivityName.FAULTED and sequence < 100:
        plant.ask(Jog("p", Axis.AZIMUTH, 1, sequence=sequence))
        plant.forward(0.1)
        sequence += 1
    assert sequence < 60
    with pytest.raises(CommandRejected, match="This button press has ended"):
        plant.ask(Jog("p", Axis.AZIMUTH, 1, sequence=sequence))
    assert plant.controller.memory.fault_code == "following_error"


def test_a_reversal_at_full_speed_is_neither_wrong_nor_behind(plant: Plant) -> None:
    plant.ask(Move(Orientation(300.0, 80.0)))
    plant.forward(5.0)
    for azimuth_deg in (2.0, 200.0, 2.0):
        plant.ask(Move(Orientation(azimuth_deg, 10.0)))
        plant.forward(3.0)
    plant.forward(30.0)
    assert plant.azimuth_deg == pytest.approx(2.0, abs=0.05)
    assert not plant.happened(EventKind.FAULT_RAISED)


def test_a_long_way_at_one_tick_a_second_is_no_fault() -> None:
    plant = Plant(READY, watchdog=None)
    plant.period = timedelta(seconds=1)
    plant.tick()
    plant.ask(Move(Orientation(350.0, 80.0)))
    plant.forward(90.0)
    assert plant.azimuth_deg == pytest.approx(350.0, abs=0.05)
    assert not plant.happened(EventKind.FAULT_RAISED)


GOING = {"move", "park", "stow", "track", "go_to_start"}
BY_HAND = {"jog", "step", "home", "set_home", "undo_home", "set_limit"}
PROOFS = {"test_direction", "test_scale", "test_stop", "test_communication_loss"}
TO_SHOW = (GoToStart(SOLSTICE), 30.0, RunShow(SOLSTICE), 1.0)
DOING: dict[ActivityName, tuple[tuple[Command | float, ...], set[str]]] = {
    ActivityName.HOLDING: ((), GOING | BY_HAND | PROOFS),
    ActivityName.HOMING: ((Home(),), set()),
    ActivityName.SETTING_HOME: ((SetHome(),), set()),
    ActivityName.JOGGING: ((Jog("p", Axis.AZIMUTH, 1),), {"jog"}),
    ActivityName.MOVING: ((SOUTH,), GOING),
    ActivityName.STOPPING: ((SOUTH, 2.0, Stop()), set()),
    ActivityName.TRACKING: ((Track(), 1.0), GOING),
    ActivityName.STOWING: ((Stow(StowName.WIND),), GOING),
    ActivityName.STOWED: ((Stow(StowName.WIND), 40.0), GOING),
    ActivityName.SHOWING: (TO_SHOW, {"go_to_start"}),
    ActivityName.MEASURING: ((RunCommunicationLossTest(Axis.AZIMUTH), 0.3), set()),
}


@pytest.mark.parametrize("activity", DOING)
def test_what_may_begin_while_something_else_goes_on(plant: Plant, activity: ActivityName) -> None:
    asked, free = DOING[activity]
    for one in asked:
        _ = plant.forward(one) if isinstance(one, float) else plant.ask(one)
    assert plant.activity is activity
    busy = {action for action in plant.snapshot.actions if f"busy_{activity}" in plant.reasons(action)}
    assert busy & (GOING | BY_HAND | PROOFS) == (GOING | BY_HAND | PROOFS) - free


def test_a_switch_in_the_way_ends_a_move_and_the_other_way_is_free(plant: Plant) -> None:
    plant.ask(Move(Orientation(30.0, 30.0)))
    plant.forward(20.0)
    plant.drive.inject(Fault(FaultKind.LOWER_LIMIT_STUCK, Axis.ELEVATION))
    happened = plant.ask(Move(Orientation(30.0, 10.0)))
    assert happened == [EventKind.MOVE_STARTED, EventKind.LIMIT_REACHED, EventKind.MOVE_ENDED]
    plant.ask(Move(Orientation(30.0, 40.0)))
    plant.forward(10.0)
    assert plant.elevation_deg == pytest.approx(40.0, abs=0.05)


def test_the_drives_own_watchdog_ends_a_move_but_tracking_goes_on(plant: Plant) -> None:
    plant.ask(SOUTH)
    plant.forward(1.0)
    plant.clock.advance(timedelta(seconds=0.55))
    plant.tick()
    stopped = plant.happened(EventKind.STOPPED)
    assert [event.actor for event in stopped] == ["controller"]
    assert "stopped automatically" in stopped[0].message
    assert plant.activity is ActivityName.HOLDING
    plant.forward(3.0)
    plant.clock.advance(timedelta(seconds=0.55))
    plant.tick()
    assert len(plant.happened(EventKind.STOPPED)) == 1
    plant.forward(1.0)
    plant.ask(Track())
    plant.forward(1.0)
    plant.clock.advance(timedelta(seconds=0.55))
    plant.tick()
    assert len(plant.happened(EventKind.STOPPED)) == 2
    assert plant.activity is ActivityName.TRACKING
    plant.forward(60.0)
    assert plant.snapshot.in_position


def test_zeroing_is_allowed_again_after_a_jump_and_tells_nothing_twice(plant: Plant) -> None:
    plant.drive.inject(Fault(FaultKind.ENCODER_JUMP, Axis.ELEVATION, -8.0))
    plant.forward(1.0)
    assert len(plant.happened(EventKind.HOME_LOST)) == 1
    plant.ask(SetHome())
    plant.forward(1.0)
    assert plant.snapshot.homed


AXIS = AxisConfig(-200.0, 200.0, 4.0, 2.0, 0.5, 2.0)


def follow(
    commands: list[AxisCommand], speeds_dps: list[float], *, period_s: float = 0.1
) -> tuple[AxisWatch | None, float, float]:
    """Return the watch, the reference's and the real position after an axis really turned at these speeds."""
    now, position_deg = MORNING, 0.0
    watched: AxisWatch | None = None
    for command, speed_dps in zip(commands, speeds_dps, strict=True):
        seen = AxisFeedback(position_deg, speed_dps, moving=speed_dps != 0.0, homed=True)
        watched = watch(watched, AXIS, command, seen, now, 2.0)
        now += timedelta(seconds=period_s)
        position_deg += speed_dps * period_s
    return watched, watched.position_deg if watched else 0.0, position_deg


def test_the_reference_arrives_without_overshoot() -> None:
    watched, reference_deg, _ = follow([Position(10.0, 4.0)] * 80, [1.0] * 80)
    assert watched is not None
    assert reference_deg == pytest.approx(10.0, abs=0.05)


def test_the_reference_is_set_anew_while_an_axis_is_only_a_little_slow() -> None:
    watched, reference_deg, position_deg = follow([Velocity(4.0)] * 400, [3.8] * 400)
    assert watched is not None
    assert watched.behind_since is None
    assert reference_deg - position_deg < 2.0


def test_a_halted_axis_is_not_watched() -> None:
    assert follow([Velocity(1.0), HALT], [0.0, 0.0])[0] is None


def test_the_reference_brakes_for_a_command_to_stand_still() -> None:
    watched, _, _ = follow([Velocity(4.0)] * 30 + [Velocity(0.0)] * 30, [4.0] * 30 + [0.0] * 30)
    assert watched is not None
    assert watched.speed_dps == 0.0
