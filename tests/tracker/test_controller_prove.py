"""Proofs at the drive: watched moves, the stop test, and the link-loss test in which nothing is sent."""

from dataclasses import replace
from datetime import timedelta

import pytest

from app.simulation.faults import Fault, FaultKind
from app.tracker.commands.commands import (
    Command,
    CommandRejected,
    Jog,
    Move,
    RunCommunicationLossTest,
    RunDirectionTest,
    RunScaleTest,
    RunStopTest,
    Stop,
    Track,
)
from app.tracker.memory.drive_tests import LinkLossOutcome, ProofMove, Proofs, StopSpeed
from app.tracker.memory.memory import TrackerMemory
from app.tracker.settings.axes import Axis, AxisConfig
from app.tracker.settings.config import Orientation
from app.tracker.state.snapshot import ActivityName, EventKind
from app.tracker.values.motion import AxisFeedback, DriveCommand, Feedback
from tests.tracker.plant import BLANK, CONFIG, READY, Plant
from tests.tracker.scripted import Scripted

STOPS = [(axis, speed) for axis in Axis for speed in StopSpeed]
EVERY_PROOF: list[Command] = [
    RunDirectionTest(Axis.AZIMUTH),
    RunScaleTest(Axis.ELEVATION),
    RunStopTest(Axis.AZIMUTH, StopSpeed.JOG),
    RunCommunicationLossTest(Axis.AZIMUTH),
]


def standing(memory: TrackerMemory = BLANK, **more: object) -> Plant:
    plant = Plant(memory, **more)  # type: ignore[arg-type]
    plant.tick()
    return plant


def until_holding(plant: Plant) -> Plant:
    for _ in range(600):
        plant.forward(0.1)
        if plant.activity is not ActivityName.MEASURING and plant.activity is not ActivityName.MOVING:
            return plant
    raise AssertionError(f"still {plant.snapshot.activity_text}")


def move_of(plant: Plant) -> ProofMove:
    move = plant.controller.memory.proofs.move
    assert move is not None
    return move


@pytest.mark.parametrize(
    ("command", "degrees"), [(RunDirectionTest(Axis.ELEVATION), 3.0), (RunScaleTest(Axis.AZIMUTH), 10.0)]
)
def test_a_watched_move_turns_one_axis_and_waits_to_be_judged(command: Command, degrees: float) -> None:
    plant = standing()
    before = plant.snapshot.measured
    assert plant.ask(command) == [EventKind.DRIVE_TEST_STARTED]
    assert " test: " in plant.snapshot.activity_text
    until_holding(plant)
    after, move = plant.snapshot.measured, move_of(plant)
    assert before is not None
    assert after is not None
    turned = {
        Axis.AZIMUTH: after.azimuth_deg - before.azimuth_deg,
        Axis.ELEVATION: after.elevation_deg - before.elevation_deg,
    }
    assert turned.pop(move.axis) == pytest.approx(degrees, abs=0.1)
    assert list(turned.values()) == [pytest.approx(0.0, abs=0.01)]
    assert move.moved_deg == pytest.approx(degrees, abs=0.1)
    assert move.by == "technician"
    assert plant.happened(EventKind.DRIVE_TEST_ENDED)[-1].data["outcome"] == "to_be_judged"


def test_a_watched_move_goes_the_other_way_where_there_is_no_room() -> None:
    plant = standing(READY)
    plant.ask(Move(Orientation(30.0, 88.0)))
    until_holding(plant)
    plant.drive.inject(Fault(FaultKind.UPPER_LIMIT_STUCK, Axis.AZIMUTH))
    plant.forward(0.2)
    for axis in Axis:
        plant.ask(RunDirectionTest(axis))
        until_holding(plant)
        assert move_of(plant).moved_deg == pytest.approx(-3.0, abs=0.1), "off the switch, or into the range"


def test_a_range_too_small_is_refused_with_a_sentence() -> None:
    narrow = replace(CONFIG, azimuth=AxisConfig(-1.0, 1.0, 6.0, 6.0, 0.5, 3.0))
    plant = standing(READY, config=narrow)
    with pytest.raises(CommandRejected, match=r"cannot turn by 10\.0 degrees"):
        plant.ask(RunScaleTest(Axis.AZIMUTH))


def test_no_proof_begins_while_tracking_or_without_a_drive() -> None:
    plant = standing(READY)
    plant.ask(Track())
    for command in EVERY_PROOF:
        with pytest.raises(CommandRejected, match="is tracking"):
            plant.ask(command)
    plant.ask(Stop())
    plant.forward(3.0)
    plant.cut = True
    plant.forward(2.0)
    for command in EVERY_PROOF:
        with pytest.raises(CommandRejected, match="does not answer"):
            plant.ask(command)


@pytest.mark.parametrize("command", EVERY_PROOF)
def test_every_proof_is_stopped_at_once_and_nothing_goes_on(command: Command) -> None:
    plant = standing()
    plant.ask(command)
    plant.forward(1.2)
    plant.ask(Stop())
    plant.forward(2.0)
    at_rest = plant.azimuth_deg, plant.elevation_deg
    plant.forward(10.0)
    assert (plant.azimuth_deg, plant.elevation_deg) == at_rest
    assert plant.activity is ActivityName.HOLDING
    assert plant.controller.memory.proofs == Proofs()


@pytest.mark.parametrize(("axis", "speed"), STOPS)
def test_the_stop_test_measures_what_the_ramp_says(axis: Axis, speed: StopSpeed) -> None:
    plant = standing(READY)
    plant.ask(RunStopTest(axis, speed))
    assert plant.snapshot.activity_text == "Stop test: accelerating"
    until_holding(plant)
    proof, settings = plant.controller.memory.proofs.stop(axis, speed), CONFIG.axis(axis)
    assert proof is not None
    speed_dps = settings.speed_dps if speed is StopSpeed.RATED else settings.jog_fast_dps
    assert proof.speed_dps == pytest.approx(speed_dps, rel=0.01)
    assert proof.stopped_after_s == pytest.approx(speed_dps / settings.acceleration_dps2, abs=0.11)
    assert proof.overrun_deg == pytest.approx(speed_dps**2 / 2 / settings.acceleration_dps2, abs=0.05)
    assert (proof.by, proof.drive, proof.settings) == ("technician", CONFIG.drive, settings)
    assert plant.controller.memory.home is not None
    assert not plant.happened(EventKind.FAULT_RAISED)


def test_while_an_axis_comes_to_rest_it_is_looked_at_every_20_ms() -> None:
    plant = standing(READY)
    plant.ask(RunStopTest(Axis.AZIMUTH, StopSpeed.RATED))
    assert plant.controller.deadline() is None
    plant.forward(2.1)
    assert plant.snapshot.activity_text == "Stop test: stopping"
    assert plant.controller.deadline() == plant.clock.now() + timedelta(milliseconds=20)
    plant.period = timedelta(milliseconds=20)
    until_holding(plant)
    proof = plant.controller.memory.proofs.stop(Axis.AZIMUTH, StopSpeed.RATED)
    assert proof is not None
    assert proof.resolution_s == pytest.approx(0.02)
    assert proof.stopped_after_s == pytest.approx(1.0, abs=0.021)


def test_the_rated_speed_needs_a_trusted_zero_and_the_hand_speed_does_not() -> None:
    plant = standing()
    with pytest.raises(CommandRejected, match="is not homed"):
        plant.ask(RunStopTest(Axis.AZIMUTH, StopSpeed.RATED))
    plant.ask(RunStopTest(Axis.AZIMUTH, StopSpeed.JOG))
    until_holding(plant)
    assert plant.controller.memory.proofs.stop(Axis.AZIMUTH, StopSpeed.JOG) is not None


def test_an_axis_that_does_not_move_proves_nothing() -> None:
    plant = standing(READY, config=replace(CONFIG, following_error_deg=20.0))
    plant.drive.inject(Fault(FaultKind.STALL, Axis.AZIMUTH))
    plant.ask(RunStopTest(Axis.AZIMUTH, StopSpeed.JOG))
    plant.forward(3.0)
    assert plant.controller.memory.proofs.stops == ()
    assert plant.happened(EventKind.DRIVE_TEST_ENDED)[-1].data["outcome"] == "failed"
    assert plant.activity is ActivityName.HOLDING


def test_the_link_loss_test_feeds_nothing_and_measures_the_watchdog() -> None:
    plant = standing(READY)
    plant.period = timedelta(milliseconds=20)
    plant.ask(RunCommunicationLossTest(Axis.ELEVATION))
    assert plant.snapshot.activity_text == "Communication-loss test: moving slowly"
    plant.forward(1.3)
    assert plant.controller.is_silent
    assert plant.snapshot.activity_text == "Communication-loss test: no commands are sent"
    until_holding(plant)
    proof = plant.controller.memory.proofs.link_loss
    assert proof is not None
    assert proof.outcome is LinkLossOutcome.STOPPED
    assert proof.expected_s == 0.5
    assert proof.reacted_after_s == pytest.approx(0.5, abs=0.05)
    assert proof.stopped_after_s == pytest.approx(0.5 + 0.5 / 6.0, abs=0.05)
    assert proof.overrun_deg == pytest.approx(0.25, abs=0.05)
    assert proof.reported
    assert proof.home_kept
    assert plant.controller.memory.home is not None
    assert not plant.controller.is_silent
    assert [event.data["outcome"] for event in plant.happened(EventKind.DRIVE_TEST_ENDED)] == ["stopped"]
    plant.ask(Move(Orientation(2.0, 4.0)))
    until_holding(plant)
    assert plant.elevation_deg == pytest.approx(4.0, abs=0.06), "it obeys again"


def test_a_drive_whose_watchdog_does_not_act_is_stopped_and_found_out() -> None:
    plant = standing(READY, watchdog=None)
    capabilities = replace(plant.drive.capabilities, watchdog_s=0.5)
    plant.controller.configure(CONFIG, capabilities)
    plant.ask(RunCommunicationLossTest(Axis.AZIMUTH))
    until_holding(plant)
    proof = plant.controller.memory.proofs.link_loss
    assert proof is not None
    assert proof.outcome is LinkLossOutcome.WENT_ON
    assert (proof.reacted_after_s, proof.stopped_after_s, proof.reported) == (None, None, False)
    plant.forward(1.0)
    at_rest = plant.azimuth_deg
    plant.forward(3.0)
    assert plant.azimuth_deg == at_rest


def test_a_drive_without_a_watchdog_is_told_so() -> None:
    plant = standing(READY, watchdog=None)
    assert plant.reasons("test_communication_loss") == {"no_watchdog"}
    with pytest.raises(CommandRejected, match="has no watchdog"):
        plant.ask(RunCommunicationLossTest(Axis.AZIMUTH))


def test_a_drive_that_loses_power_in_the_link_loss_test_ends_it_and_its_zero() -> None:
    plant = standing(READY)
    plant.ask(RunCommunicationLossTest(Axis.AZIMUTH))
    plant.forward(1.3)
    plant.drive.inject(Fault(FaultKind.POWER_LOSS))
    plant.forward(0.2)
    assert plant.controller.memory.home is None
    assert "has restarted" in plant.controller.memory.home_lost
    assert plant.controller.memory.proofs.link_loss is None
    assert plant.happened(EventKind.DRIVE_TEST_ENDED)[-1].data["outcome"] == "interrupted"


def test_a_drive_whose_answer_to_silence_is_a_fault_is_recorded_with_its_code() -> None:
    plant = standing(READY)
    plant.ask(RunCommunicationLossTest(Axis.AZIMUTH))
    plant.forward(1.3)
    plant.drive.inject(Fault(FaultKind.DRIVE_FAULT, amount=17))
    until_holding(plant)
    proof = plant.controller.memory.proofs.link_loss
    assert proof is not None
    assert proof.fault_code == 17
    plant.forward(0.2)
    assert plant.activity is ActivityName.FAULTED


def test_a_cut_link_ends_a_test_and_the_drive_stops_by_itself() -> None:
    plant = standing(READY)
    plant.ask(RunStopTest(Axis.AZIMUTH, StopSpeed.JOG))
    plant.forward(1.0)
    plant.cut = True
    plant.forward(3.0)
    plant.cut = False
    plant.forward(1.0)
    assert plant.activity is ActivityName.HOLDING
    assert plant.controller.memory.proofs == Proofs()
    assert plant.controller.memory.home is not None


def test_nothing_else_moves_the_axes_during_a_test() -> None:
    plant = standing(READY)
    plant.ask(RunStopTest(Axis.AZIMUTH, StopSpeed.JOG))
    for command in (Jog("p1", Axis.AZIMUTH, 1), Move(Orientation(10.0, 10.0)), Track()):
        with pytest.raises(CommandRejected, match="is running a drive test"):
            plant.ask(command)


def test_a_drive_that_will_not_stop_is_a_fault() -> None:
    story = Scripted(BLANK)
    story.tick()
    story.ask(RunStopTest(Axis.AZIMUTH, StopSpeed.JOG))
    for tenth in range(1, 100):
        turning = AxisFeedback(0.3 * tenth, 3.0, moving=True, homed=False)
        story.reading = Feedback(turning, AxisFeedback(0.0, 0.0, moving=False, homed=False), boot_count=1)
        story.forward(0.1)
    assert story.snapshot.fault is not None
    assert story.snapshot.fault.code == "stop_overdue"
    assert story.told == DriveCommand()
