"""Hold-to-run: the axis turns while the lease is renewed, and not a moment longer."""

from dataclasses import replace
from datetime import timedelta

import pytest

from app.simulation.faults import Fault, FaultKind
from app.tracker.commands.commands import CommandRejected, EndJog, Jog, Move, SelectMode, Step, Stop, Track
from app.tracker.settings.axes import Axis, JogSpeed
from app.tracker.settings.config import Orientation
from app.tracker.state.snapshot import ActivityName, EventKind
from app.tracker.values.mode import Mode
from app.tracker.values.motion import HALT, Position, Velocity
from tests.tracker.plant import CONFIG, READY, Plant


def press(name: str, sequence: int = 0, *, axis: Axis = Axis.AZIMUTH, direction: int = 1) -> Jog:
    return Jog(name, axis, 1 if direction > 0 else -1, JogSpeed.FAST, sequence)


def hold(plant: Plant, name: str, seconds: float, *, axis: Axis = Axis.AZIMUTH, direction: int = 1) -> None:
    """Hold a key: a renewal every tick, until the time is over or the press is dead."""
    for sequence in range(round(seconds / 0.1)):
        plant.ask(press(name, sequence, axis=axis, direction=direction))
        plant.forward(0.1)


def refusal(plant: Plant, command: Jog) -> list[str]:
    with pytest.raises(CommandRejected) as refused:
        plant.ask(command)
    assert all(reason.message.endswith(".") and reason.hint for reason in refused.value.reasons)
    return [reason.code for reason in refused.value.reasons]


def test_a_held_key_turns_the_axis_before_any_homing_and_a_released_one_stops_it() -> None:
    plant = Plant()
    plant.tick()
    begun_deg = plant.azimuth_deg
    hold(plant, "p1", 2.0)
    assert plant.activity is ActivityName.JOGGING
    assert plant.azimuth_deg - begun_deg > 4.0
    assert plant.snapshot.activity_text == "Jogging azimuth east (clockwise), fast"
    assert "no_soft_limits" in {notice.code for notice in plant.snapshot.notices}
    assert plant.ask(EndJog("p1")) == [EventKind.JOG_ENDED]
    assert plant.told.azimuth == HALT
    plant.forward(1.5)
    at_rest_deg = plant.azimuth_deg
    plant.forward(1.0)
    assert plant.azimuth_deg == at_rest_deg


def test_the_lease_ends_by_itself_and_the_deadline_tells_when() -> None:
    plant = Plant()
    plant.tick()
    plant.ask(press("p1"))
    assert plant.controller.deadline() == plant.clock.now() + timedelta(milliseconds=240)
    plant.clock.advance(timedelta(milliseconds=239))
    plant.tick()
    assert plant.told.azimuth != HALT
    plant.clock.advance(timedelta(milliseconds=1))
    plant.tick()
    assert plant.told.azimuth == HALT
    assert plant.controller.deadline() is None
    assert plant.happened(EventKind.JOG_ENDED)[0].data == {"outcome": "expired"}


def test_a_lease_is_never_longer_than_240_ms_and_may_be_shorter() -> None:
    plant = Plant()
    plant.tick()
    plant.ask(replace(press("p1"), lease=timedelta(hours=1)))
    assert plant.controller.deadline() == plant.clock.now() + timedelta(milliseconds=240)
    plant.ask(replace(press("p1", 1), lease=timedelta(milliseconds=50)))
    assert plant.controller.deadline() == plant.clock.now() + timedelta(milliseconds=50)


def test_only_a_growing_sequence_renews() -> None:
    plant = Plant()
    plant.tick()
    plant.ask(press("p1", 0))
    plant.forward(0.1)
    plant.ask(press("p1", 0))
    plant.forward(0.1)
    assert plant.activity is ActivityName.JOGGING
    plant.forward(0.1)
    assert plant.activity is ActivityName.HOLDING


@pytest.mark.parametrize("ending", ["release", "expiry", "stop", "drive"])
def test_a_press_that_ended_never_moves_the_axis_again(ending: str) -> None:
    plant = Plant()
    plant.tick()
    plant.ask(press("p1"))
    match ending:
        case "release":
            plant.ask(EndJog("p1"))
        case "expiry":
            plant.forward(0.4)
        case "stop":
            plant.ask(Stop())
        case _:
            plant.cut = True
            plant.forward(0.3)
            plant.cut = False
    plant.forward(2.0)
    stood_deg = plant.azimuth_deg
    assert refusal(plant, press("p1", 5)) == ["press_dead"]
    assert refusal(plant, press("p1", 0)) == ["press_dead"]
    plant.forward(0.5)
    assert plant.azimuth_deg == stood_deg


def test_a_renewal_after_the_lease_comes_too_late_even_before_a_tick_has_seen_it() -> None:
    plant = Plant()
    plant.tick()
    plant.ask(press("p1"))
    plant.clock.advance(timedelta(milliseconds=300))
    assert refusal(plant, press("p1", 1)) == ["press_dead"]
    plant.tick()
    assert plant.told.azimuth == HALT


def test_a_heartbeat_of_a_press_that_began_before_a_restart_moves_nothing() -> None:
    plant = Plant()
    plant.tick()
    assert refusal(plant, press("held since yesterday", 57)) == ["press_dead"]


def test_ending_an_unknown_press_is_no_error_but_makes_it_dead() -> None:
    plant = Plant()
    plant.tick()
    assert plant.ask(EndJog("p9")) == []
    assert refusal(plant, press("p9")) == ["press_dead"]


def test_one_owner_at_a_time_and_a_refused_press_stays_dead() -> None:
    plant = Plant()
    plant.tick()
    plant.ask(press("p1"))
    assert refusal(plant, press("p2", direction=-1)) == ["busy"]
    plant.ask(press("p1", 1))
    plant.ask(EndJog("p1"))
    assert refusal(plant, press("p2", 1)) == ["press_dead"]


def test_a_press_keeps_its_direction() -> None:
    plant = Plant()
    plant.tick()
    plant.ask(press("p1"))
    assert refusal(plant, press("p1", 1, direction=-1)) == ["press_changed"]
    plant.tick()
    assert plant.told.azimuth == HALT
    assert refusal(plant, press("p1", 2)) == ["press_dead"]


def test_a_homed_axis_comes_to_rest_at_its_soft_limit() -> None:
    plant = Plant(READY)
    plant.tick()
    hold(plant, "down", 1.0, axis=Axis.AZIMUTH, direction=1)
    plant.forward(2.0)
    hold(plant, "back", 4.0, axis=Axis.AZIMUTH, direction=-1)
    assert 0.0 <= plant.azimuth_deg <= 0.02
    plant.forward(1.0)
    assert refusal(plant, press("again", direction=-1)) == ["at_soft_limit"]
    plant.ask(press("away", direction=1))


def test_an_unhomed_axis_is_stopped_by_its_limit_switch_and_may_only_move_away() -> None:
    plant = Plant()
    plant.tick()
    with pytest.raises(CommandRejected):
        hold(plant, "down", 10.0, axis=Axis.ELEVATION, direction=-1)
    assert plant.happened(EventKind.JOG_ENDED)[-1].data == {"outcome": "limit_switch"}
    plant.forward(1.0)
    assert refusal(plant, press("on", axis=Axis.ELEVATION, direction=-1)) == ["at_limit_switch"]
    stood_deg = plant.elevation_deg
    hold(plant, "away", 1.0, axis=Axis.ELEVATION, direction=1)
    assert plant.elevation_deg > stood_deg


def test_without_a_watchdog_in_the_drive_a_jog_is_made_of_bounded_steps() -> None:
    plant = Plant(watchdog=None)
    plant.tick()
    plant.ask(press("p1"))
    told = plant.told.azimuth
    assert isinstance(told, Position)
    assert 0.0 < told.position_deg - plant.azimuth_deg < 2.0
    assert "no_watchdog" in {notice.code for notice in plant.snapshot.notices}


def test_with_a_watchdog_a_jog_is_a_speed() -> None:
    plant = Plant()
    plant.tick()
    plant.ask(replace(press("p1"), speed=JogSpeed.SLOW, direction=-1))
    assert plant.told.azimuth == Velocity(-CONFIG.azimuth.jog_slow_dps)


def test_no_jog_without_a_drive_nor_during_tracking_nor_while_stopping() -> None:
    plant = Plant(READY)
    with pytest.raises(CommandRejected) as refused:
        plant.controller.handle(press("p0"), plant.clock.now())
    assert [reason.code for reason in refused.value.reasons] == ["drive_unreachable"]
    plant.tick()
    plant.ask(Track())
    plant.forward(1.0)
    assert refusal(plant, press("p1")) == ["busy_tracking"]
    plant.ask(Stop())
    assert refusal(plant, press("p2")) == ["busy_stopping"]


def test_a_jog_switches_waiting_tracking_off_and_says_so() -> None:
    plant = Plant(replace(READY, tracking_on=True, home=None))
    plant.tick()
    assert plant.snapshot.waiting
    assert EventKind.TRACKING_ENDED in plant.ask(press("p1"))
    assert not plant.controller.memory.tracking_on


def test_one_lost_reading_does_not_stop_a_jog_but_two_do_and_the_lease_still_counts() -> None:
    plant = Plant()
    plant.tick()
    plant.ask(press("p1"))
    plant.cut = True
    plant.forward(0.1)
    assert isinstance(plant.told.azimuth, Velocity)
    plant.forward(0.1)
    assert plant.told.azimuth == HALT
    plant.cut = False
    plant.forward(2.0)
    plant.ask(press("p2"))
    plant.forward(0.2)
    plant.cut = True
    plant.forward(0.1)
    assert plant.told.azimuth == HALT
    assert plant.happened(EventKind.JOG_ENDED)[-1].data == {"outcome": "expired"}


def test_small_steps_go_before_homing_and_are_bounded() -> None:
    plant = Plant()
    plant.tick()
    begun_deg = plant.elevation_deg
    assert plant.ask(Step(Axis.ELEVATION, -1.0)) == [EventKind.MOVE_STARTED]
    assert plant.snapshot.activity_text == "Moving by one increment"
    plant.forward(3.0)
    assert plant.elevation_deg == pytest.approx(begun_deg - 1.0, abs=0.05)
    assert plant.activity is ActivityName.HOLDING
    plant.ask(Step(Axis.AZIMUTH, 0.1))
    assert plant.told.elevation == HALT
    with pytest.raises(CommandRejected, match="up to 5 degrees"):
        plant.ask(Step(Axis.AZIMUTH, 5.5))
    with pytest.raises(CommandRejected, match="up to 5 degrees"):
        plant.ask(Step(Axis.AZIMUTH, float("nan")))


def test_a_step_beyond_a_trusted_soft_limit_is_refused() -> None:
    plant = Plant(READY)
    plant.tick()
    with pytest.raises(CommandRejected, match="beyond its soft limit"):
        plant.ask(Step(Axis.ELEVATION, -1.0))
    plant.ask(Step(Axis.ELEVATION, 1.0))


def test_a_step_that_meets_a_switch_ends() -> None:
    plant = Plant()
    plant.tick()
    plant.drive.inject(Fault(FaultKind.UPPER_LIMIT_STUCK, Axis.AZIMUTH))
    happened = plant.ask(Step(Axis.AZIMUTH, 1.0))
    assert happened == [EventKind.MOVE_STARTED, EventKind.LIMIT_REACHED, EventKind.MOVE_ENDED]
    assert plant.told.azimuth == HALT


def test_the_memory_of_dead_presses_is_bounded() -> None:
    plant = Plant()
    plant.tick()
    for number in range(1200):
        plant.controller.handle(EndJog(f"p{number}"), plant.clock.now())
    assert refusal(plant, press("p1199")) == ["press_dead"]
    assert refusal(plant, press("p0", 3)) == ["press_dead"]


def test_a_mode_may_be_selected_and_a_move_refused_while_a_key_is_held() -> None:
    plant = Plant(READY)
    plant.tick()
    plant.ask(press("p1"))
    plant.ask(SelectMode(Mode.DUAL))
    with pytest.raises(CommandRejected, match="being jogged"):
        plant.ask(Move(Orientation(90.0, 45.0)))
