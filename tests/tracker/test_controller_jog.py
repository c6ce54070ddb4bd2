"""Hold-to-run: the axis turns while the lease is renewed, and not a moment longer."""

from dataclasses import replace
from datetime import timedelta

import pytest

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


def test_a_held_key_turns_the_axis_before_any_homing_and_a_released_one_stops_it(blank: Plant) -> None:
    begun_deg = blank.azimuth_deg
    hold(blank, "p1", 2.0)
    assert blank.activity is ActivityName.JOGGING
    assert blank.azimuth_deg - begun_deg > 4.0
    assert blank.snapshot.activity_text == "Jogging azimuth east (clockwise), fast"
    assert "no_soft_limits" in {notice.code for notice in blank.snapshot.notices}
    assert blank.ask(EndJog("p1")) == [EventKind.JOG_ENDED]
    assert blank.told.azimuth == HALT
    blank.forward(1.5)
    at_rest_deg = blank.azimuth_deg
    blank.forward(1.0)
    assert blank.azimuth_deg == at_rest_deg


def test_the_lease_ends_by_itself_and_the_deadline_tells_when(blank: Plant) -> None:
    blank.ask(press("p1"))
    assert blank.controller.deadline() == blank.clock.now() + timedelta(milliseconds=240)
    blank.clock.advance(timedelta(milliseconds=239))
    blank.tick()
    assert blank.told.azimuth != HALT
    blank.clock.advance(timedelta(milliseconds=1))
    blank.tick()
    assert blank.told.azimuth == HALT
    assert blank.controller.deadline() is None
    assert blank.happened(EventKind.JOG_ENDED)[0].data == {"outcome": "expired"}


def test_a_lease_is_never_longer_than_240_ms_and_may_be_shorter(blank: Plant) -> None:
    blank.ask(replace(press("p1"), lease=timedelta(hours=1)))
    assert blank.controller.deadline() == blank.clock.now() + timedelta(milliseconds=240)
    blank.ask(replace(press("p1", 1), lease=timedelta(milliseconds=50)))
    assert blank.controller.deadline() == blank.clock.now() + timedelta(milliseconds=50)


def test_only_a_growing_sequence_renews(blank: Plant) -> None:
    blank.ask(press("p1", 0))
    blank.forward(0.1)
    blank.ask(press("p1", 0))
    blank.forward(0.1)
    assert blank.activity is ActivityName.JOGGING
    blank.forward(0.1)
    assert blank.activity is ActivityName.HOLDING


@pytest.mark.parametrize("ending", ["release", "expiry", "stop", "drive"])
def test_a_press_that_ended_never_moves_the_axis_again(blank: Plant, ending: str) -> None:
    blank.ask(press("p1"))
    match ending:
        case "release":
            blank.ask(EndJog("p1"))
        case "expiry":
            blank.forward(0.4)
        case "stop":
            blank.ask(Stop())
        case _:
            blank.cut = True
            blank.forward(0.3)
            blank.cut = False
    blank.forward(2.0)
    stood_deg = blank.azimuth_deg
    assert refusal(blank, press("p1", 5)) == ["press_dead"]
    assert refusal(blank, press("p1", 0)) == ["press_dead"]
    blank.forward(0.5)
    assert blank.azimuth_deg == stood_deg


def test_a_renewal_after_the_lease_comes_too_late_even_before_a_tick_has_seen_it(blank: Plant) -> None:
    blank.ask(press("p1"))
    blank.clock.advance(timedelta(milliseconds=300))
    assert refusal(blank, press("p1", 1)) == ["press_dead"]
    blank.tick()
    assert blank.told.azimuth == HALT


def test_a_press_that_is_not_known_is_dead(blank: Plant) -> None:
    assert refusal(blank, press("held since before a restart", 57)) == ["press_dead"]
    assert blank.ask(EndJog("p9")) == []
    assert refusal(blank, press("p9")) == ["press_dead"]


def test_an_old_press_stays_dead_when_a_thousand_have_come_since(blank: Plant) -> None:
    for number in range(1200):
        blank.controller.handle(EndJog(f"p{number}"), blank.clock.now())
    assert refusal(blank, press("p1199")) == refusal(blank, press("p300")) == ["press_dead"]
    assert refusal(blank, press("p0", 3)) == ["press_dead"]


def test_one_owner_at_a_time_and_a_refused_press_stays_dead(blank: Plant) -> None:
    blank.ask(press("p1"))
    assert refusal(blank, press("p2", direction=-1)) == ["busy"]
    blank.ask(press("p1", 1))
    blank.ask(EndJog("p1"))
    assert refusal(blank, press("p2", 1)) == ["press_dead"]


def test_a_press_keeps_its_direction(blank: Plant) -> None:
    blank.ask(press("p1"))
    assert refusal(blank, press("p1", 1, direction=-1)) == ["press_changed"]
    blank.tick()
    assert blank.told.azimuth == HALT
    assert refusal(blank, press("p1", 2)) == ["press_dead"]


def test_a_homed_axis_comes_to_rest_at_its_soft_limit(plant: Plant) -> None:
    hold(plant, "down", 1.0, axis=Axis.AZIMUTH, direction=1)
    plant.forward(2.0)
    hold(plant, "back", 4.0, axis=Axis.AZIMUTH, direction=-1)
    assert 0.0 <= plant.azimuth_deg <= 0.02
    plant.forward(1.0)
    assert refusal(plant, press("again", direction=-1)) == ["at_soft_limit"]
    plant.ask(press("away", direction=1))


def test_an_unhomed_axis_is_stopped_by_its_limit_switch_and_may_only_move_away(blank: Plant) -> None:
    with pytest.raises(CommandRejected):
        hold(blank, "down", 10.0, axis=Axis.ELEVATION, direction=-1)
    assert blank.happened(EventKind.JOG_ENDED)[-1].data == {"outcome": "limit_switch"}
    blank.forward(1.0)
    assert refusal(blank, press("on", axis=Axis.ELEVATION, direction=-1)) == ["at_limit_switch"]
    stood_deg = blank.elevation_deg
    hold(blank, "away", 1.0, axis=Axis.ELEVATION, direction=1)
    assert blank.elevation_deg > stood_deg


def test_without_a_watchdog_in_the_drive_a_jog_is_made_of_bounded_steps() -> None:
    plant = Plant(watchdog=None)
    plant.tick()
    plant.ask(press("p1"))
    told = plant.told.azimuth
    assert isinstance(told, Position)
    assert 0.0 < told.position_deg - plant.azimuth_deg < 2.0
    assert "no_watchdog" in {notice.code for notice in plant.snapshot.notices}


@pytest.mark.parametrize(
    ("speed", "speed_dps"), [(JogSpeed.SLOW, CONFIG.azimuth.jog_slow_dps), (JogSpeed.FAST, 3.0)]
)
def test_with_a_watchdog_a_jog_is_its_speed_in_its_direction(
    blank: Plant, speed: JogSpeed, speed_dps: float
) -> None:
    blank.ask(replace(press("p1", direction=-1), speed=speed))
    assert blank.told.azimuth == Velocity(-speed_dps)
    assert CONFIG.azimuth.jog_slow_dps < CONFIG.azimuth.jog_fast_dps


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


def test_a_lost_reading_does_not_lengthen_the_lease(blank: Plant) -> None:
    blank.ask(press("p1"))
    blank.forward(0.2)
    assert blank.told.azimuth == Velocity(CONFIG.azimuth.jog_fast_dps)
    blank.cut = True
    blank.forward(0.1)
    assert blank.told.azimuth == HALT
    assert blank.happened(EventKind.JOG_ENDED)[-1].data == {"outcome": "expired"}


def test_small_steps_go_before_homing_and_are_bounded(blank: Plant) -> None:
    begun_deg = blank.elevation_deg
    assert blank.ask(Step(Axis.ELEVATION, -1.0)) == [EventKind.MOVE_STARTED]
    assert blank.snapshot.activity_text == "Moving by one increment"
    blank.forward(3.0)
    assert blank.elevation_deg == pytest.approx(begun_deg - 1.0, abs=0.05)
    assert blank.activity is ActivityName.HOLDING
    blank.ask(Step(Axis.AZIMUTH, 0.1))
    assert blank.told.elevation == HALT
    with pytest.raises(CommandRejected, match="up to 5 degrees"):
        blank.ask(Step(Axis.AZIMUTH, 5.5))
    with pytest.raises(CommandRejected, match="up to 5 degrees"):
        blank.ask(Step(Axis.AZIMUTH, float("nan")))


def test_a_step_beyond_a_trusted_soft_limit_is_refused(plant: Plant) -> None:
    with pytest.raises(CommandRejected, match="beyond its soft limit"):
        plant.ask(Step(Axis.ELEVATION, -1.0))
    plant.ask(Step(Axis.ELEVATION, 1.0))


def test_a_mode_may_be_selected_and_a_move_refused_while_a_key_is_held(plant: Plant) -> None:
    plant.ask(press("p1"))
    plant.ask(SelectMode(Mode.DUAL))
    with pytest.raises(CommandRejected, match="being jogged"):
        plant.ask(Move(Orientation(90.0, 45.0)))
