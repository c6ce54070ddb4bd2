"""Modes, orientations, moves and the park position."""

from dataclasses import replace

import pytest

from app.tracker.commands.commands import CommandRejected, Move, Park, SelectMode, Step, Stop, Track
from app.tracker.memory.memory import Pointing, StepName
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import Orientation
from app.tracker.state.snapshot import ActivityName, EventKind, Pair
from app.tracker.values.mode import Mode
from app.tracker.values.motion import Position
from tests.tracker.plant import CONFIG, READY, Plant
from tests.tracker.scripted import Scripted

SOUTH = Orientation(180.0, 45.0)


def test_a_move_ends_in_position_and_says_so(plant: Plant) -> None:
    assert plant.ask(Move(Orientation(30.0, 20.0))) == [EventKind.MOVE_STARTED]
    plant.forward(1.0)
    shown = plant.snapshot
    assert shown.activity_text == "Moving to the requested orientation"
    assert shown.target == Pair(30.0, 20.0)
    assert shown.setpoint == Pair(30.0, 20.0)
    assert not shown.in_position
    assert shown.following_error_deg is not None
    plant.forward(15.0)
    shown = plant.snapshot
    assert shown.in_position
    assert shown.activity is ActivityName.HOLDING
    assert shown.measured is not None
    assert shown.measured.azimuth_deg == pytest.approx(30.0, abs=0.05)
    assert shown.measured.elevation_deg == pytest.approx(20.0, abs=0.05)
    assert plant.happened(EventKind.MOVE_ENDED)[0].data["outcome"] == "in_position"


def test_parking_goes_to_the_park_position_and_switches_tracking_off(plant: Plant) -> None:
    plant.ask(Track())
    plant.forward(1.0)
    assert EventKind.TRACKING_ENDED in plant.ask(Park())
    assert plant.snapshot.activity_text == "Moving to the park position"
    plant.forward(60.0)
    assert plant.elevation_deg == pytest.approx(90.0, abs=0.05)
    assert not plant.controller.memory.tracking_on


def test_a_move_needs_a_trusted_zero_and_a_reachable_orientation_and_says_both(blank: Plant) -> None:
    with pytest.raises(CommandRejected) as refused:
        blank.ask(Move(Orientation(10.0, -20.0)))
    assert [reason.code for reason in refused.value.reasons] == ["tracker_not_homed", "beyond_limits"]
    with pytest.raises(CommandRejected, match="cannot face"):
        blank.ask(Move(Orientation(float("nan"), 10.0)))


def test_a_correction_that_leads_a_hair_beyond_a_limit_does_not_forbid_an_orientation() -> None:
    plant = Plant(replace(READY, pointing=Pointing(elevation_offset_deg=0.3)))
    plant.tick()
    plant.ask(Move(Orientation(10.0, 90.0)))
    assert plant.told.elevation == Position(90.0, CONFIG.elevation.speed_dps)


def test_a_move_that_does_not_arrive_in_time_is_a_fault(script: Scripted) -> None:
    script.ask(Move(Orientation(0.2, 0.0)))
    script.forward(6.0)
    assert script.controller.activity is ActivityName.FAULTED
    assert script.controller.memory.fault_code == "move_overdue"


def test_stop_ends_a_move_at_once_and_is_never_refused() -> None:
    plant = Plant(READY)
    assert plant.ask(Stop()) == [EventKind.STOPPED]
    plant.tick()
    plant.ask(Move(SOUTH))
    plant.forward(2.0)
    assert plant.ask(Stop(), actor="Deniz") == [EventKind.MOVE_ENDED, EventKind.STOPPED]
    assert plant.happened(EventKind.STOPPED)[-1].actor == "Deniz"
    assert plant.activity is ActivityName.STOPPING
    assert plant.snapshot.activity_text == "Stopping"
    assert plant.ask(Stop()) == [EventKind.STOPPED]
    plant.forward(2.0)
    assert plant.activity is ActivityName.HOLDING
    assert not plant.snapshot.in_position


@pytest.mark.parametrize(
    ("mode", "held", "there"),
    [
        (Mode.FIXED, Orientation(20.0, 10.0), Orientation(20.0, 10.0)),
        (Mode.AZIMUTH, Orientation(300.0, 10.0), Orientation(20.0, 10.0)),
        (Mode.ELEVATION, Orientation(20.0, 70.0), Orientation(20.0, 10.0)),
    ],
)
def test_a_mode_is_confirmed_once_the_panel_holds_what_it_holds(
    plant: Plant, mode: Mode, held: Orientation, there: Orientation
) -> None:
    assert plant.ask(SelectMode(mode, held)) == [EventKind.MODE_SELECTED]
    memory = plant.controller.memory
    assert (memory.mode, memory.orientation) == (mode, held)
    assert StepName.MODE not in memory.confirmations
    plant.ask(Move(there))
    plant.forward(20.0)
    assert plant.controller.memory.confirmations[StepName.MODE].by == "technician"
    plant.ask(SelectMode(mode, held))
    assert StepName.MODE in plant.controller.memory.confirmations


def test_dual_axis_holds_nothing_and_needs_no_move(plant: Plant) -> None:
    plant.ask(SelectMode(Mode.DUAL))
    assert StepName.MODE in plant.controller.memory.confirmations


@pytest.mark.parametrize(
    ("mode", "held"),
    [
        (Mode.FIXED, Orientation(10.0, 95.0)),
        (Mode.AZIMUTH, Orientation(10.0, -5.0)),
        (Mode.ELEVATION, Orientation(200.0, 10.0)),
    ],
)
def test_an_orientation_beyond_the_limits_is_refused(mode: Mode, held: Orientation) -> None:
    narrow = replace(CONFIG, azimuth=replace(CONFIG.azimuth, maximum_deg=90.0))
    plant = Plant(READY, config=narrow)
    plant.tick()
    with pytest.raises(CommandRejected, match="cannot face"):
        plant.ask(SelectMode(mode, held))
    plant.ask(SelectMode(Mode.DUAL, held))


def test_a_mode_that_is_selected_without_a_zero_is_kept_but_not_confirmed(blank: Plant) -> None:
    held = Orientation(blank.azimuth_deg, blank.elevation_deg)
    blank.ask(SelectMode(Mode.FIXED, held))
    assert (blank.controller.memory.mode, blank.controller.memory.orientation) == (Mode.FIXED, held)
    assert StepName.MODE not in blank.controller.memory.confirmations


def test_the_mode_cannot_change_under_a_tracker_that_tracks(plant: Plant) -> None:
    plant.ask(Track())
    with pytest.raises(CommandRejected, match="is tracking"):
        plant.ask(SelectMode(Mode.FIXED, SOUTH))


def test_the_arrival_of_a_move_without_a_mode_confirms_nothing() -> None:
    plant = Plant(replace(READY, mode=None))
    plant.tick()
    plant.ask(Move(Orientation(5.0, 5.0)))
    plant.forward(10.0)
    assert plant.controller.memory.confirmations == {}


def test_a_small_step_is_no_faster_than_a_jog(plant: Plant) -> None:
    plant.ask(Step(Axis.AZIMUTH, 5.0))
    plant.forward(0.2)
    assert plant.told.azimuth == Position(pytest.approx(5.0), CONFIG.azimuth.jog_fast_dps)
