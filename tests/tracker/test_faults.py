"""Rows of the fault table that happen at the machine: noticed in time, answered as the table says, and told.

`witnessed` measures on the virtual clock from the fault to the first word of it, and hands time and sentence
to the table of faults (`python -m tools.fault_table`).
"""

from collections.abc import Callable
from dataclasses import replace
from datetime import timedelta
from typing import Any

import pytest

from app.simulation.faults import Fault, FaultKind
from app.tracker.access.interlocks import Action
from app.tracker.commands.commands import (
    BeginServiceMode,
    CommandRejected,
    ConfirmAreaClear,
    EndServiceMode,
    Home,
    Jog,
    Move,
    Park,
    ResetFault,
    RunDirectionTest,
    Step,
    Stop,
    Track,
)
from app.tracker.memory.drive_tests import StopProof, StopSpeed
from app.tracker.motion.machine_watch import Braking, allowed_overrun_deg
from app.tracker.protections.words import LinkQuality
from app.tracker.settings.axes import Axis, JogSpeed
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.settings.mechanics import MachineProtection, Recoveries, Recovery, RecoveryPolicy
from app.tracker.state.snapshot import ActivityName, EventKind, Snapshot
from app.tracker.values.motion import HALT
from app.tracker.values.reason import Reason
from tests.fault_result import HOME_AGAIN, RESET, VIRTUAL, FaultResult
from tests.tracker.plant import CONFIG, MORNING, READY, Plant

SOUTH = Move(Orientation(180.0, 45.0))
Witness = Callable[..., float]


@pytest.fixture
def witnessed(fault: FaultResult) -> Witness:
    """Let time pass until a code is shown; record how long that took, and the very sentence."""

    def wait(plant: Plant, code: str, *, within_s: float, policy: str = RESET) -> float:
        begun = plant.clock.now()
        while (reason := shown(plant.snapshot).get(code)) is None:
            assert plant.clock.now() - begun <= timedelta(seconds=within_s), f"{code} was not noticed"
            plant.forward(0.1)
        took_s = (plant.clock.now() - begun).total_seconds()
        fault.noticed(took_s, VIRTUAL)
        fault.shows(reason.message)
        fault.recovers(policy)
        return took_s

    return wait


def shown(snapshot: Snapshot) -> dict[str, Reason]:
    """Return everything that the operator is told, by code."""
    fault = () if snapshot.fault is None else (snapshot.fault,)
    return {reason.code: reason for reason in (*fault, *snapshot.notices, *snapshot.waiting)}


def moving(config: TrackerConfig = CONFIG, *, tracks: bool = False) -> Plant:
    plant = Plant(READY, config=config)
    plant.tick()
    if tracks:
        plant.ask(Track())
        plant.forward(60.0)
    else:
        plant.ask(SOUTH)
        plant.forward(3.0)
    return plant


def doing(plant: Plant) -> ActivityName:
    return plant.activity


def hurt(plant: Plant, kind: FaultKind, axis: Axis | None = Axis.AZIMUTH, amount: float = 0.0) -> None:
    plant.drive.inject(Fault(kind, axis, amount))


def guarded(**machine: Any) -> TrackerConfig:
    return replace(CONFIG, machine=replace(MachineProtection(), **machine))


def stands(plant: Plant, seconds: float = 3.0) -> bool:
    plant.forward(seconds)
    return plant.told.azimuth == HALT and plant.told.elevation == HALT


@pytest.mark.fault(1)
def test_a_cut_cable_in_mid_move_is_told_with_the_age_of_the_reading(witnessed: Witness) -> None:
    plant = moving(tracks=True)
    plant.cut = True
    assert witnessed(plant, "drive_lost", within_s=1.0) <= 1.0
    assert plant.activity is ActivityName.HOLDING
    assert plant.snapshot.measured is None
    assert plant.snapshot.position_age_s is not None


@pytest.mark.fault(3)
@pytest.mark.fault(22)
def test_a_drive_that_lost_its_power_has_lost_its_zero(witnessed: Witness) -> None:
    plant = moving(tracks=True)
    hurt(plant, FaultKind.POWER_LOSS, None)
    witnessed(plant, "drive_restarted", within_s=0.5, policy=HOME_AGAIN)
    assert plant.controller.memory.home is None
    assert "tracker_not_homed" in plant.reasons("track") & plant.reasons("stow") & plant.reasons("move")
    assert plant.reasons("jog") == set(), "slow hand motion is the way back"
    assert [reason.code for reason in plant.snapshot.waiting] == ["drive_restarted"], "one cause, told once"
    assert plant.controller.memory.tracking_on
    assert plant.activity is ActivityName.HOLDING


@pytest.mark.fault(4)
def test_slow_replies_end_and_refuse_motion_by_a_held_key(plant: Plant, witnessed: Witness) -> None:
    plant.link = LinkQuality(0.05, 0.08)
    plant.forward(0.1)
    assert plant.reasons("jog") == {"link_slow"}
    assert plant.reasons("step") == set()
    assert witnessed(plant, "link_slow", within_s=0.5, policy="automatic: it ends with its cause") <= 0.5
    plant.link = LinkQuality(0.03, 0.08)
    plant.forward(0.1)
    assert plant.reasons("jog") == set()


@pytest.mark.fault(9)
def test_the_wrong_axis_moves_and_the_proof_of_the_direction_fails(witnessed: Witness) -> None:
    plant = Plant(READY)
    plant.forward(1.0)
    hurt(plant, FaultKind.SWAPPED_AXES)
    plant.ask(RunDirectionTest(Axis.AZIMUTH))
    assert witnessed(plant, "axes_swapped", within_s=2.0) <= 2.0
    assert stands(plant)
    assert plant.controller.memory.proofs.directions == ()


@pytest.mark.fault(11)
def test_a_frozen_counter_is_told_from_an_axis_that_stands(witnessed: Witness) -> None:
    plant = moving()
    hurt(plant, FaultKind.FROZEN_POSITION)
    assert witnessed(plant, "position_frozen", within_s=1.5) <= 1.5
    assert stands(plant)
    assert plant.controller.memory.home is None


@pytest.mark.fault(12)
def test_an_axis_that_turns_the_wrong_way_asks_for_its_phases(plant: Plant, witnessed: Witness) -> None:
    hurt(plant, FaultKind.WRONG_DIRECTION)
    plant.ask(SOUTH)
    assert witnessed(plant, "wrong_direction", within_s=2.0) <= 2.0
    assert stands(plant)
    assert "phases" in (plant.snapshot.fault or Reason("", "", "")).hint


@pytest.mark.fault(13)
def test_a_counter_that_jumps_costs_the_zero(witnessed: Witness) -> None:
    plant = moving(tracks=True)
    hurt(plant, FaultKind.ENCODER_JUMP, amount=12.4)
    assert witnessed(plant, "encoder_jump", within_s=0.5, policy=HOME_AGAIN) <= 0.5
    assert plant.controller.memory.home is None
    assert plant.activity is ActivityName.HOLDING


@pytest.mark.fault(14)
def test_an_axis_that_is_stuck_is_not_tried_again_and_again(witnessed: Witness) -> None:
    plant = moving()
    hurt(plant, FaultKind.STALL)
    assert witnessed(plant, "following_error", within_s=3.0) <= 3.0
    plant.drive.end_injected_faults()
    assert stands(plant, 700.0)
    assert len(plant.happened(EventKind.FAULT_RAISED)) == 1
    assert doing(plant) is ActivityName.FAULTED, "without a policy a person leaves the fault"


@pytest.mark.fault(15)
def test_an_axis_that_creeps_is_told_until_it_rests(witnessed: Witness) -> None:
    plant = Plant(READY)
    plant.forward(1.0)
    hurt(plant, FaultKind.SLIP, Axis.ELEVATION, 0.5)
    took_s = witnessed(
        plant, "creep", within_s=4.0, policy="automatic: it ends a minute after the last motion"
    )
    assert took_s <= 4.0, "a degree at half a degree a second"
    plant.forward(30.0)
    assert len(plant.happened(EventKind.UNCOMMANDED_MOTION)) == 1, "said once, not with every degree"
    plant.drive.end_injected_faults()
    plant.forward(70.0)
    assert "creep" not in shown(plant.snapshot)


@pytest.mark.fault(16)
def test_an_axis_that_stops_too_late_is_slow_until_its_stops_are_short(
    plant: Plant, witnessed: Witness
) -> None:
    plant.ask(Move(Orientation(300.0, 45.0)))
    plant.forward(10.0)
    hurt(plant, FaultKind.LONG_STOP)
    plant.ask(Stop())
    witnessed(plant, "overrun", within_s=5.0, policy="automatic: three short stops in a row")
    plant.drive.end_injected_faults()
    plant.forward(10.0)
    for _ in range(3):
        plant.ask(Move(Orientation(20.0, 20.0)))
        plant.forward(10.0)
        assert abs(plant.drive.observe().azimuth.velocity_dps) <= CONFIG.azimuth.jog_slow_dps + 1e-9
        plant.ask(Stop())
        plant.forward(3.0)
    assert "overrun" not in shown(plant.snapshot)
    plant.ask(Move(Orientation(20.0, 20.0)))
    plant.forward(3.0)
    assert abs(plant.drive.observe().azimuth.velocity_dps) > 5.0


def test_a_stop_is_judged_by_the_one_that_was_measured() -> None:
    config = CONFIG.azimuth
    proof = StopProof(
        Axis.AZIMUTH, StopSpeed.RATED, 6.0, 1.2, 4.0, 0.05, MORNING, "technician", CONFIG.drive, config
    )
    fast, slow = Braking(0.0, 6.0), Braking(0.0, -3.0)
    assert allowed_overrun_deg(fast, config, proof, 2.0) == pytest.approx(2 * (4.0 + 0.3) + 0.3)
    assert allowed_overrun_deg(slow, config, proof, 2.0) == pytest.approx(2 * (2.0 + 0.15) + 0.3)
    other = replace(proof, settings=replace(config, acceleration_dps2=3.0))
    assert allowed_overrun_deg(fast, config, other, 2.0) == allowed_overrun_deg(fast, config, None, 2.0)


@pytest.mark.fault(17)
def test_one_switch_in_the_range_leaves_the_other_way_free(fault: FaultResult) -> None:
    plant = moving()
    hurt(plant, FaultKind.UPPER_LIMIT_STUCK)
    plant.ask(Track())
    plant.ask(SOUTH)
    begun = plant.clock.now()
    while not plant.happened(EventKind.LIMIT_REACHED):
        assert plant.clock.now() - begun < timedelta(seconds=2)
        plant.forward(0.1)
    fault.noticed((plant.clock.now() - begun).total_seconds(), VIRTUAL)
    plant.forward(2.0)
    with pytest.raises(CommandRejected, match="limit switch"):
        plant.ask(Jog("up", Axis.AZIMUTH, 1))
    plant.ask(Step(Axis.AZIMUTH, -1.0))
    assert plant.activity is ActivityName.MOVING
    fault.recovers("the axis leaves the switch, the only way that is free")


@pytest.mark.fault(18)
def test_a_switch_that_stays_on_is_a_fault_after_the_axis_has_left_it(
    plant: Plant, witnessed: Witness
) -> None:
    plant.ask(Move(Orientation(100.0, 20.0)))
    plant.forward(30.0)
    hurt(plant, FaultKind.UPPER_LIMIT_STUCK)
    plant.ask(Move(Orientation(10.0, 20.0)))
    assert witnessed(plant, "limit_stuck", within_s=6.0) <= 6.0, "ten degrees at six degrees a second"
    assert stands(plant)
    plant.ask(ResetFault())
    plant.ask(Step(Axis.AZIMUTH, -5.0))
    plant.forward(5.0)
    assert plant.activity is ActivityName.HOLDING, "away from the switch it may move"


@pytest.mark.fault(19)
def test_an_axis_whose_switch_never_comes_is_stopped_beyond_its_soft_limit(witnessed: Witness) -> None:
    plant = Plant(READY)
    plant.forward(1.0)
    hurt(plant, FaultKind.LIMIT_DEAD, Axis.ELEVATION)
    hurt(plant, FaultKind.SLIP, Axis.ELEVATION, -1.0)
    assert witnessed(plant, "over_travel", within_s=4.0) <= 4.0
    assert plant.controller.memory.home is None, "over-travel ends the trust in the zero"


@pytest.mark.fault(19)
def test_a_search_whose_switch_never_comes_ends_with_the_travel_and_says_whose(
    blank: Plant,
    fault: FaultResult,
) -> None:
    hurt(blank, FaultKind.LIMIT_DEAD)
    blank.ask(Home())
    begun = blank.clock.now()
    while not blank.happened(EventKind.HOMING_ENDED):
        assert doing(blank) is ActivityName.HOMING
        assert blank.clock.now() - begun < timedelta(seconds=120)
        blank.forward(0.1)
    (told,) = blank.happened(EventKind.HOMING_ENDED)
    fault.noticed((blank.clock.now() - begun).total_seconds(), VIRTUAL)
    fault.shows(told.message)
    assert told.data == {"outcome": "failed"}
    assert "did not find the home switch of the azimuth axis" in told.message
    assert stands(blank)
    assert "home_lost" in shown(blank.snapshot)
    assert "tracker_not_homed" in blank.reasons("track") & blank.reasons("move")
    blank.drive.end_injected_faults()
    blank.ask(Home())
    blank.forward(120.0)
    assert blank.snapshot.homed
    fault.recovers(HOME_AGAIN)


@pytest.mark.fault(20)
def test_both_switches_at_once_are_a_fault_of_the_wiring(witnessed: Witness) -> None:
    plant = moving()
    hurt(plant, FaultKind.LOWER_LIMIT_STUCK)
    hurt(plant, FaultKind.UPPER_LIMIT_STUCK)
    assert witnessed(plant, "limit_switch_wiring", within_s=0.5) <= 0.5
    assert stands(plant)
    assert "fault" in plant.reasons("jog") & plant.reasons("step") & plant.reasons("home")


@pytest.mark.fault(21)
@pytest.mark.parametrize("code", [1, 7, 65535])
def test_a_drive_fault_stops_both_axes_and_costs_the_zero(witnessed: Witness, code: int) -> None:
    plant = moving(tracks=True)
    hurt(plant, FaultKind.DRIVE_FAULT, amount=float(code))
    assert witnessed(plant, "drive_fault", within_s=0.5) <= 0.5
    assert stands(plant)
    assert plant.controller.memory.home is None


def test_a_supply_that_is_out_of_range_for_two_seconds_is_a_fault(witnessed: Witness) -> None:
    plant = Plant(READY, config=guarded(supply_low_v=21.0, supply_high_v=28.0))
    plant.forward(3.0)
    assert plant.drive.observe().supply_v is None
    assert plant.snapshot.fault is None
    hurt(plant, FaultKind.SUPPLY, None, 24.0)
    plant.forward(5.0)
    assert plant.snapshot.fault is None
    hurt(plant, FaultKind.SUPPLY, None, 18.5)
    assert 2.0 <= witnessed(plant, "supply_voltage", within_s=3.0) <= 2.3


def test_an_ordinary_stop_keeps_the_zero_and_a_search_gives_it_up() -> None:
    plant = moving(tracks=True)
    plant.ask(Stop())
    plant.forward(3.0)
    assert plant.snapshot.homed
    plant.ask(Home())
    assert not plant.snapshot.homed


ALLOWED_ON_LOCAL = {
    Action.STOP, Action.STOP_SHOW, Action.PAUSE_SHOW, Action.RESET_FAULT, Action.SET_MODE,
    Action.SET_INHIBIT, Action.RELEASE_INHIBIT,
    Action.BEGIN_SERVICE_MODE, Action.CONFIRM_AREA_CLEAR, Action.END_SERVICE_MODE,
}  # fmt: skip
"""What moves nothing and says nothing about where the panel is; everything else is refused on local."""


def test_the_switch_at_the_cabinet_beats_everything() -> None:
    plant = moving(tracks=True)
    hurt(plant, FaultKind.LOCAL_SWITCH, None)
    plant.forward(0.2)
    assert plant.snapshot.local
    assert plant.activity is ActivityName.HOLDING
    assert plant.snapshot.waiting[0].message == "The switch at the cabinet of Tracker 1 is on local."
    for action in Action:
        assert ("local" in plant.reasons(action)) is (action not in ALLOWED_ON_LOCAL), action
    assert plant.reasons("stop") == set()
    plant.drive.end_injected_faults()
    plant.forward(5.0)
    assert plant.activity is ActivityName.HOLDING, "nothing resumes by itself"


def test_service_moves_slowly_and_only_while_the_area_is_clear() -> None:
    plant = moving(tracks=True)
    plant.ask(BeginServiceMode("Ada"))
    plant.forward(3.0)
    assert plant.snapshot.service is not None
    assert plant.reasons("move") == plant.reasons("jog") == {"area_not_clear"}
    for action in ("step", "home", "test_direction", "test_scale", "test_stop", "test_communication_loss"):
        assert "area_not_clear" in plant.reasons(action), action
    for action in ("track", "park", "stow", "resume", "go_to_start", "run_show", "resume_show"):
        assert "in_service" in plant.reasons(action), action
    plant.ask(ConfirmAreaClear())
    plant.ask(Move(Orientation(20.0, 20.0)))
    plant.forward(5.0)
    seen = plant.drive.observe()
    assert abs(seen.azimuth.velocity_dps) == pytest.approx(CONFIG.azimuth.jog_slow_dps)
    assert abs(seen.elevation.velocity_dps) <= CONFIG.elevation.jog_slow_dps + 1e-9
    plant.ask(Stop())
    plant.forward(2.0)
    plant.ask(EndServiceMode())
    assert plant.snapshot.service is None
    plant.ask(Park())


def test_the_word_that_the_area_is_clear_expires_in_mid_move() -> None:
    plant = Plant(READY, config=guarded(clear_for_s=20.0))
    plant.tick()
    plant.ask(BeginServiceMode("Ada"))
    plant.forward(1.0)
    plant.ask(ConfirmAreaClear())
    plant.ask(SOUTH)
    plant.forward(19.5)
    assert doing(plant) is ActivityName.MOVING
    plant.forward(1.0)
    assert doing(plant) is ActivityName.HOLDING
    assert plant.happened(EventKind.AREA_CONFIRMATION_EXPIRED)
    with pytest.raises(CommandRejected, match="the area is not confirmed clear"):
        plant.ask(SOUTH)


def recovering(kind: Recovery, *, times: int = 2) -> Plant:
    policy = RecoveryPolicy(kind, times, 10.0)
    return moving(guarded(recovery=Recoveries(following=policy, link=policy)), tracks=True)


def block_and_free(plant: Plant) -> None:
    """Block the axis until the fault is latched, then remove what blocked it."""
    hurt(plant, FaultKind.STALL)
    for _ in range(60):
        plant.forward(5.0)
        if doing(plant) is ActivityName.FAULTED:
            break
    plant.drive.end_injected_faults()


def test_a_fault_is_left_by_itself_as_often_as_its_policy_says() -> None:
    plant = recovering(Recovery.LIMITED)
    hurt(plant, FaultKind.STALL)
    plant.forward(1500.0)
    assert len(plant.happened(EventKind.FAULT_RESET_AUTOMATICALLY)) == 2, (
        "twice an hour, then a person has to come"
    )
    assert plant.activity is ActivityName.FAULTED
    plant.blow(irradiance_wm2=0.0).forward(5.0)
    shown = plant.snapshot.protection
    assert shown is not None
    assert "Tracking needs the operator" in shown.reason.hint, "nothing is promised after the last reset"
    announced = plant.happened(EventKind.MOTION_ANNOUNCED)
    assert [event.message for event in announced if "fault" in event.message], "its motion is announced"


def test_a_lost_drive_is_tracked_again_if_its_policy_says_so() -> None:
    plant = recovering(Recovery.UNLIMITED)
    plant.cut = True
    plant.forward(5.0)
    plant.cut = False
    plant.forward(5.0)
    assert doing(plant) is ActivityName.HOLDING
    plant.forward(10.0)
    assert doing(plant) is ActivityName.TRACKING
    assert plant.happened(EventKind.TRACKING_RESUMED)


@pytest.mark.parametrize("kind", [Recovery.NONE, Recovery.SERVICE, Recovery.LIMITED, Recovery.UNLIMITED])
def test_a_tracker_that_goes_on_by_itself_says_so(kind: Recovery) -> None:
    plant = recovering(kind)
    assert plant.snapshot.continues, "it tracks"
    plant.cut = True
    plant.forward(5.0)
    recovers = kind in (Recovery.LIMITED, Recovery.UNLIMITED)
    assert plant.activity is ActivityName.HOLDING
    assert plant.snapshot.continues is recovers
    plant.blow(irradiance_wm2=0.0).forward(5.0)
    shown = plant.snapshot.protection
    assert shown is not None
    assert ("Tracking continues automatically once" in shown.reason.hint) is recovers
    assert ("Tracking needs the operator" in shown.reason.hint) is not recovers
    plant.cut = False
    plant.forward(1.0)
    for action in ("set_home", "home", "set_mode"):
        assert ("tracking_continues" in plant.reasons(action)) is recovers, action
    plant.ask(Stop())
    plant.forward(2.0)
    assert not plant.snapshot.continues
    assert "tracking_continues" not in plant.reasons("set_home") | plant.reasons("set_mode")


def test_a_fault_that_needs_service_is_cleared_in_service_only() -> None:
    plant = recovering(Recovery.SERVICE)
    block_and_free(plant)
    assert plant.reasons("reset_fault") == {"service_needed"}
    plant.ask(BeginServiceMode("Ada"))
    plant.ask(ResetFault())
    assert plant.activity is not ActivityName.FAULTED


def test_no_fault_is_left_by_itself_under_a_maintenance_lock_or_in_service() -> None:
    plant = recovering(Recovery.UNLIMITED)
    block_and_free(plant)
    assert doing(plant) is ActivityName.FAULTED
    plant.ask(BeginServiceMode("Ada"))
    plant.forward(60.0)
    assert not plant.happened(EventKind.FAULT_RESET_AUTOMATICALLY)


def test_a_slow_key_stays_slow(plant: Plant) -> None:
    plant.ask(BeginServiceMode("Ada"))
    plant.forward(1.0)
    plant.ask(ConfirmAreaClear())
    for beat in range(1, 20):
        plant.ask(Jog("press", Axis.AZIMUTH, 1, JogSpeed.FAST, beat))
        plant.forward(0.1)
    assert abs(plant.drive.observe().azimuth.velocity_dps) <= CONFIG.azimuth.jog_slow_dps + 1e-9
