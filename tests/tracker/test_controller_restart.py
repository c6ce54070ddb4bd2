"""A tracker whose controller was started again: what the last life knew of the weather, and what it left."""

from dataclasses import replace

import pytest

from app.simulation.faults import Fault, FaultKind
from app.tracker.commands.commands import (
    Command,
    GoToStart,
    Jog,
    Park,
    PauseShow,
    RunShow,
    SetInhibit,
    Stop,
    Track,
)
from app.tracker.memory.memory import TrackerMemory
from app.tracker.protections.words import Protection
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import TrackerConfig
from app.tracker.settings.protections import ProtectionConfig, Reaction, StowName, WindProtection
from app.tracker.state.snapshot import ActivityName, EventKind, ShowPhase
from app.tracker.weather.weather import Quality, Quantity, Reading, Sensed
from tests.amount import amount
from tests.fault_result import BY_ITSELF, VIRTUAL, FaultResult
from tests.tracker.plant import CONFIG, READY, Plant
from tests.tracker.shows import SOLSTICE

STORM = 28.0
TRACKED = replace(READY, tracking_on=True, sensors=(Quantity.WIND,))


def doing(plant: Plant) -> ActivityName:
    return plant.activity


def known(wind_mps: float, mean_mps: float = 3.0, unheard_s: float = 0.0) -> Sensed:
    """Return what is known of the wind from before the restart."""
    wind = Reading(wind_mps, Quality.BEFORE_RESTART, 4.0, "station")
    return Sensed(wind, wind_mean_mps=mean_mps, unheard_s=unheard_s)


def reborn(memory: TrackerMemory, weather: Sensed, config: TrackerConfig = CONFIG) -> Plant:
    """Return a tracker at the first tick of a new life of its controller."""
    plant = Plant(memory, config=config)
    plant.weather = weather
    plant.tick()
    return plant


def wind(**settings: object) -> TrackerConfig:
    limits = WindProtection(**settings)  # type: ignore[arg-type]
    return replace(CONFIG, protection=ProtectionConfig(limits))


@pytest.mark.fault(81)
def test_a_storm_before_the_restart_stows_at_the_first_tick(fault: FaultResult) -> None:
    plant = reborn(TRACKED, known(STORM))
    assert doing(plant) is ActivityName.STOWING
    assert plant.controller.memory.protection is Protection.WIND_STOW
    seen = plant.snapshot
    assert seen.protection is not None
    text = "The wind at Tracker 1 was 28.0 m/s before the restart and is not known to be calm."
    assert seen.protection.reason.message == text
    fault.noticed(0.0, VIRTUAL)
    fault.shows(text)
    plant.forward(40)
    assert doing(plant) is ActivityName.STOWED
    plant.forward(amount(660, 3600))
    assert doing(plant) is ActivityName.STOWED
    plant.blow(3.0).forward(599)
    assert doing(plant) is ActivityName.STOWED
    plant.forward(10)
    assert doing(plant) is ActivityName.TRACKING
    fault.recovers(f"{BY_ITSELF} once the wind has been heard calm for the whole delay")


def test_its_motion_is_announced_once_and_waits_for_its_warning() -> None:
    plant = reborn(TRACKED, known(STORM))
    elevation_deg = plant.elevation_deg
    plant.forward(4.8)
    assert plant.elevation_deg == elevation_deg
    assert plant.told.horn
    assert len(plant.happened(EventKind.MOTION_ANNOUNCED)) == 1
    plant.forward(2)
    assert plant.elevation_deg > elevation_deg


@pytest.mark.parametrize(
    ("weather", "stows"),
    [
        (known(17.0), True),
        (known(16.9), False),
        (known(3.0, mean_mps=17.0), True),
        (known(3.0, mean_mps=16.9), False),
    ],
)
def test_it_is_judged_by_the_limits_of_the_tracker(weather: Sensed, stows: bool) -> None:
    assert (doing(reborn(TRACKED, weather)) is ActivityName.STOWING) is stows


def test_a_tracker_without_wind_protection_is_not_stowed() -> None:
    assert doing(reborn(TRACKED, known(60.0), wind(enabled=False))) is ActivityName.TRACKING


@pytest.mark.fault(81)
def test_a_sensor_that_is_not_heard_again_is_a_bad_one(fault: FaultResult) -> None:
    plant = reborn(TRACKED, known(4.0)).forward(59)
    assert doing(plant) is ActivityName.TRACKING
    plant.forward(2)
    assert doing(plant) is ActivityName.STOWING
    text = "The wind sensor has reported nothing since the restart; the panel is stowed as a precaution."
    assert [one.message for one in plant.happened(EventKind.SENSOR_INVALID)] == [text]
    fault.shows(text)


def test_a_sensor_that_only_the_last_life_knew_is_missed_too() -> None:
    plant = reborn(replace(TRACKED, sensors=()), known(4.0)).forward(61)
    assert doing(plant) is ActivityName.STOWING
    assert plant.controller.memory.sensors == (Quantity.WIND,)


@pytest.mark.parametrize(("unheard_s", "after_s"), [(0.0, 60.0), (45.0, 15.0), (3600.0, 0.0)])
def test_its_time_counts_over_lives_that_heard_nothing(unheard_s: float, after_s: float) -> None:
    plant = reborn(TRACKED, known(4.0, unheard_s=unheard_s)).forward(max(0.0, after_s - 0.5))
    assert (doing(plant) is ActivityName.STOWING) is (after_s == 0.0)
    plant.forward(1.0)
    assert doing(plant) is ActivityName.STOWING


@pytest.mark.parametrize(
    ("reaction", "activity", "rests"),
    [
        (Reaction.IGNORE, ActivityName.TRACKING, False),
        (Reaction.WARN, ActivityName.TRACKING, False),
        (Reaction.HOLD, ActivityName.TRACKING, True),
        (Reaction.STOW, ActivityName.STOWING, False),
    ],
)
def test_what_is_set_for_a_bad_sensor_follows(
    reaction: Reaction, activity: ActivityName, *, rests: bool
) -> None:
    plant = reborn(TRACKED, known(4.0), wind(bad=reaction)).forward(62)
    assert doing(plant) is activity
    assert (plant.snapshot.protection is not None) is (rests or activity is ActivityName.STOWING)


def test_once_heard_it_is_a_sensor_like_any_other() -> None:
    plant = reborn(TRACKED, known(4.0)).forward(30)
    plant.blow(4.0).forward(120)
    assert doing(plant) is ActivityName.TRACKING
    assert not plant.happened(EventKind.SENSOR_INVALID)


@pytest.mark.fault(83)
def test_tracking_that_waits_for_the_clock_stows_and_waits_on(fault: FaultResult) -> None:
    plant = Plant(TRACKED)
    plant.weather, plant.clock_trusted = known(STORM), False
    plant.tick()
    assert doing(plant) is ActivityName.STOWING
    plant.forward(40)
    assert doing(plant) is ActivityName.STOWED
    plant.blow(3.0).forward(602)
    assert doing(plant) is ActivityName.HOLDING
    assert "clock_untrusted" in {reason.code for reason in plant.snapshot.waiting}
    fault.noticed(0.0, VIRTUAL)


def test_a_storm_that_comes_while_tracking_waits_since_the_restart_stows_too() -> None:
    plant = Plant(TRACKED)
    plant.clock_trusted = False
    plant.forward(20)
    assert doing(plant) is ActivityName.HOLDING
    plant.blow(STORM).forward(1)
    assert doing(plant) is ActivityName.STOWING


def test_nothing_moves_by_itself_once_the_switch_at_the_cabinet_is_back_on_remote() -> None:
    plant = Plant(TRACKED)
    plant.drive.inject(Fault(FaultKind.LOCAL_SWITCH))
    plant.weather = known(STORM)
    plant.forward(2)
    assert doing(plant) is ActivityName.HOLDING
    plant.drive.end_injected_faults()
    plant.forward(30)
    assert doing(plant) is ActivityName.HOLDING
    assert plant.snapshot.not_stowed is not None


def test_what_a_fault_of_the_drive_ended_waits_for_a_person() -> None:
    plant = Plant(TRACKED)
    plant.clock_trusted = False
    plant.forward(2)
    plant.cut = True
    plant.forward(2)
    plant.cut = False
    plant.blow(STORM).forward(5)
    assert doing(plant) is ActivityName.HOLDING
    assert plant.happened(EventKind.NOT_STOWED)


LIVES: dict[str, tuple[Command | float, ...]] = {
    "going": (GoToStart(SOLSTICE), 1.0),
    "ready": (GoToStart(SOLSTICE), 30.0),
    "running": (GoToStart(SOLSTICE), 30.0, RunShow(SOLSTICE), 1.0),
    "paused": (GoToStart(SOLSTICE), 30.0, RunShow(SOLSTICE), 1.0, PauseShow()),
    "stopped": (Track(), Stop(), 5.0),
    "jogged": (Jog("one", Axis.AZIMUTH, 1),),
    "parked": (Park(), 1.0),
    "locked": (Track(), SetInhibit("Ayse", "bearing"), 5.0),
}
"""What was asked, and for how many seconds it went on, before the controller was killed."""


def left(life: str) -> TrackerMemory:
    """Return what is stored when the controller is killed in the middle of something."""
    plant = Plant(READY).blow().forward(1)
    for step in LIVES[life]:
        if isinstance(step, float):
            plant.forward(step)
        else:
            plant.ask(step)
    ready = life == "ready"
    assert ready == (plant.snapshot.show is not None and plant.snapshot.show.phase is ShowPhase.READY)
    return plant.controller.memory


@pytest.mark.fault(83)
@pytest.mark.parametrize("life", ["going", "running", "parked"])
def test_what_moved_by_itself_stows_and_stays(life: str, fault: FaultResult) -> None:
    plant = reborn(left(life), known(STORM))
    assert doing(plant) is ActivityName.STOWING
    plant.forward(60)
    assert doing(plant) is ActivityName.STOWED
    assert plant.controller.memory.show_moves is False
    plant.blow(3.0).forward(700)
    if life != "parked":
        assert doing(plant) is ActivityName.STOWED
        assert plant.controller.memory.stow is StowName.WIND
    fault.shows("Tracker 1 goes to its wind stow position.")
    fault.recovers("the operator resumes")


@pytest.mark.parametrize("life", ["ready", "paused", "stopped", "jogged", "locked"])
def test_what_a_person_had_stopped_stays_and_says_so(life: str) -> None:
    plant = reborn(left(life), known(STORM)).forward(30)
    assert doing(plant) is ActivityName.HOLDING
    assert plant.happened(EventKind.NOT_STOWED)


def test_a_storm_that_comes_after_a_show_was_cut_off_stows_too() -> None:
    plant = reborn(left("running"), known(4.0)).forward(20)
    assert doing(plant) is ActivityName.HOLDING
    plant.blow(STORM).forward(1)
    assert doing(plant) is ActivityName.STOWING


def test_after_a_person_has_stopped_a_show_that_was_cut_off_nothing_moves() -> None:
    plant = reborn(left("running"), known(4.0)).forward(5)
    plant.ask(Stop())
    plant.blow(STORM).forward(20)
    assert doing(plant) is ActivityName.HOLDING


def test_calm_from_before_the_restart_ends_no_storm() -> None:
    stormy = replace(TRACKED, protection=Protection.WIND_STOW)
    plant = reborn(stormy, known(4.0), wind(bad=Reaction.WARN)).forward(1300)
    assert doing(plant) is ActivityName.STOWED
