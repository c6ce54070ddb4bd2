"""Stories of a tracker in bad weather: it stows, stays, goes on, and never moves unasked."""

from copy import deepcopy
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from functools import cache

import pytest

from app.simulation.faults import Fault, FaultKind
from app.sun.position import Location
from app.tracker.commands.commands import (
    CommandRejected,
    EndJog,
    GoToStart,
    Home,
    Jog,
    Move,
    Park,
    PauseShow,
    ReleaseInhibit,
    Resume,
    RunShow,
    SetInhibit,
    Stop,
    Stow,
    Track,
)
from app.tracker.memory.memory import TrackerMemory
from app.tracker.protections.words import Protection
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import MountConfig, MountKind, Orientation, TrackerConfig
from app.tracker.settings.protections import (
    Facing,
    ProtectionConfig,
    StowName,
    StowPlace,
    Stows,
    WindProtection,
)
from app.tracker.state.snapshot import ActivityName, EventKind
from app.tracker.weather.weather import Quantity
from tests.fault_result import HOME_AGAIN, VIRTUAL, FaultResult
from tests.tracker.plant import CONFIG, READY, Plant
from tests.tracker.shows import SOLSTICE

CALM_S = 61.0
STORM = 24.0
QUICK = replace(CONFIG, protection=ProtectionConfig(WindProtection(resume_after_s=CALM_S - 1.0)))
"""A minute of calm ends a storm; the default is ten."""


def doing(plant: Plant) -> ActivityName:
    """Return what the tracker does now; the type checker would take an attribute for unchanged."""
    return plant.activity


def protected(protection: ProtectionConfig) -> TrackerConfig:
    return replace(CONFIG, protection=protection)


@cache
def _tracking(config: TrackerConfig) -> Plant:
    plant = Plant(READY, config=config).blow().forward(1)
    plant.ask(Track())
    plant.forward(60)
    assert doing(plant) is ActivityName.TRACKING
    return plant


def tracking(config: TrackerConfig = QUICK) -> Plant:
    """Return a tracker that follows the sun in calm weather."""
    return deepcopy(_tracking(config))


def calm() -> Plant:
    """Return a tracker that rests in calm weather."""
    return Plant(READY, config=QUICK).blow().forward(1)


def showing() -> Plant:
    """Return a tracker that runs a show in calm weather."""
    plant = calm()
    plant.ask(GoToStart(SOLSTICE))
    plant.forward(30)
    plant.ask(RunShow(SOLSTICE))
    return plant.forward(2)


def restarted(plant: Plant) -> Plant:
    """Return the machine after a restart of the controller: only the memory is left."""
    fresh = Plant(plant.controller.memory, config=QUICK, at=plant.clock.now())
    fresh.weather = plant.weather
    return fresh


def test_a_storm_stows_a_tracking_panel_and_calm_minutes_bring_it_back() -> None:
    plant = tracking()
    azimuth_deg = plant.azimuth_deg
    plant.blow(STORM).forward(1)
    seen = plant.snapshot
    assert doing(plant) is ActivityName.STOWING
    assert seen.warning is not None
    assert seen.protection is not None
    assert (seen.protection.protection, seen.stow) == (Protection.WIND_STOW, StowName.WIND)
    assert plant.told.horn
    plant.forward(40)
    assert doing(plant) is ActivityName.STOWED
    assert plant.elevation_deg == pytest.approx(90.0, abs=0.1)
    assert plant.azimuth_deg == pytest.approx(azimuth_deg, abs=0.1)
    assert plant.snapshot.tracking_on
    assert [reason.message for reason in plant.snapshot.waiting] == [
        "The wind at Tracker 1 is too strong: 24.0 m/s."
    ]
    plant.blow(5.0).forward(CALM_S - 2)
    assert "was too strong; it is 5.0 m/s now" in plant.snapshot.waiting[0].message
    assert doing(plant) is ActivityName.STOWED
    seen = plant.snapshot
    assert seen.protection is not None
    assert seen.protection.earliest_end == pytest.approx(plant.clock.now(), abs=timedelta(seconds=3))
    plant.forward(60)
    assert doing(plant) is ActivityName.TRACKING
    assert plant.snapshot.protection is None
    assert plant.elevation_deg < 80.0
    assert plant.happened(EventKind.TRACKING_RESUMED)


def test_nothing_moves_while_the_motion_is_announced_and_stop_prevents_it() -> None:
    plant = tracking()
    before = plant.elevation_deg
    plant.blow(STORM).forward(4.8)
    assert plant.elevation_deg == before
    plant.ask(Stop())
    plant.forward(30)
    assert plant.elevation_deg == pytest.approx(before, abs=0.01)
    assert plant.snapshot.warning is None
    assert not plant.told.horn
    assert plant.snapshot.not_stowed is not None
    assert doing(plant) is ActivityName.HOLDING


def test_after_stop_the_panel_is_not_stowed_and_says_so() -> None:
    plant = tracking()
    plant.ask(Stop())
    plant.forward(2)
    before = plant.elevation_deg
    plant.blow(STORM).forward(30)
    seen = plant.snapshot
    assert plant.elevation_deg == before
    assert seen.not_stowed is not None
    assert seen.not_stowed.code == "not_stowed"
    assert len(plant.happened(EventKind.NOT_STOWED)) == 1
    plant.ask(Stow(StowName.WIND))
    plant.forward(40)
    assert plant.snapshot.not_stowed is None
    assert doing(plant) is ActivityName.STOWED
    plant.ask(Stop())
    plant.forward(5)
    assert plant.snapshot.not_stowed is None, "it stands level already"


def promised(plant: Plant) -> str:
    """Return what the protection says that this tracker will do after the storm."""
    protection = plant.snapshot.protection
    assert protection is not None
    return str(protection.reason.hint)


def test_what_the_protection_promises_is_what_the_tracker_does() -> None:
    plant = tracking()
    plant.blow(STORM).forward(40)
    assert promised(plant) == "Tracking continues once the wind has been calm for 1 min."
    stopped = deepcopy(plant)
    plant.blow(2.0).forward(CALM_S + 5.0)
    assert doing(plant) is ActivityName.TRACKING

    stopped.ask(Stop())
    stopped.forward(1)
    assert promised(stopped) == "Tracking stays off. Press Start tracking once the weather is calm."
    stopped.blow(2.0).forward(CALM_S + 5.0)
    assert doing(stopped) is ActivityName.HOLDING


def test_a_manual_tracker_in_a_storm_reads_that_it_is_not_stowed() -> None:
    plant = calm()
    plant.blow(STORM).forward(5)
    assert doing(plant) is ActivityName.HOLDING
    assert promised(plant) == ("The panel is not stowed. Clear the area, then press Stow; or jog the panel.")


def test_a_panel_that_was_stowed_or_parked_by_command_reads_where_it_will_be() -> None:
    plant = calm()
    plant.ask(Stow(StowName.CLEANING))
    plant.forward(60)
    plant.blow(STORM).forward(60)
    assert promised(plant) == "The panel then stays stowed until you press Resume."
    plant.blow(2.0).forward(CALM_S + 60.0)
    assert plant.snapshot.stow is StowName.CLEANING
    parked = calm()
    parked.ask(Park())
    parked.forward(60)
    parked.blow(STORM).forward(60)
    assert promised(parked) == "Afterward, the panel returns to its park position."


@pytest.mark.fault(42)
def test_without_a_zero_or_with_a_fault_the_panel_is_not_stowed(fault: FaultResult) -> None:
    plant = Plant().blow(STORM)
    begun = plant.clock.now()
    while plant.snapshot.not_stowed is None:
        assert plant.clock.now() - begun < timedelta(seconds=5)
        plant.forward(0.1)
    fault.noticed((plant.clock.now() - begun).total_seconds(), VIRTUAL)
    reason = plant.snapshot.not_stowed
    assert reason is not None
    assert "is not homed" in reason.message
    assert doing(plant) is ActivityName.HOLDING
    fault.shows(reason.message)
    plant.ask(Home())
    plant.forward(120)
    plant.ask(Stow(StowName.WIND))
    plant.forward(60)
    assert plant.snapshot.not_stowed is None
    assert doing(plant) is ActivityName.STOWED
    fault.recovers(f"{HOME_AGAIN}, and the tracker is stowed")


def test_a_lost_drive_in_a_storm_raises_the_condition() -> None:
    plant = tracking()
    plant.blow(STORM).forward(60)
    plant.cut = True
    plant.forward(3)
    reason = plant.snapshot.not_stowed
    assert reason is not None
    assert "does not answer" in reason.message
    plant.cut = False
    plant.forward(30)
    assert doing(plant) is ActivityName.HOLDING


def test_at_a_limit_switch_the_panel_is_to_be_jogged_away_and_not_to_be_stowed_again() -> None:
    plant = tracking()
    plant.drive.inject(Fault(FaultKind.UPPER_LIMIT_STUCK, Axis.ELEVATION))
    plant.blow(STORM)
    for command in (None, Stow(StowName.WIND)):
        if command:
            plant.ask(command)
        plant.forward(60)
        reason = plant.snapshot.not_stowed
        assert reason is not None
        assert "has reached its limit switch" in reason.message
        assert reason.hint == "Jog the axis away from the switch and check the home position."


def test_a_jog_goes_on_for_five_seconds_while_the_wind_comes() -> None:
    plant = calm()
    sequence = 1
    plant.ask(Jog("a", Axis.AZIMUTH, 1, sequence=sequence))
    plant.blow(STORM)
    for _ in range(48):
        sequence += 1
        plant.ask(Jog("a", Axis.AZIMUTH, 1, sequence=sequence))
        plant.forward(0.1)
    assert doing(plant) is ActivityName.JOGGING
    warning = plant.snapshot.warning
    assert warning is not None
    assert warning.reason.code == "hand_motion_ends"
    assert warning.remaining_s < 1.0
    for _ in range(2):  # the button is still held
        sequence += 1
        plant.ask(Jog("a", Axis.AZIMUTH, 1, sequence=sequence))
        plant.forward(0.1)
    assert doing(plant) is ActivityName.HOLDING
    with pytest.raises(CommandRejected):
        plant.ask(Jog("a", Axis.AZIMUTH, 1, sequence=sequence + 1))
    plant.ask(Jog("b", Axis.AZIMUTH, 1))
    assert doing(plant) is ActivityName.JOGGING
    plant.ask(EndJog("b"))


def test_a_running_show_ends_and_the_panel_stays_stowed_until_it_is_resumed() -> None:
    plant = showing()
    plant.blow(STORM).forward(60)
    ended = plant.happened(EventKind.SHOW_ENDED)
    assert [event.data["outcome"] for event in ended] == ["interrupted"]
    assert doing(plant) is ActivityName.STOWED
    plant.blow(2.0).forward(CALM_S + 5)
    assert doing(plant) is ActivityName.STOWED
    plant.ask(Resume())
    assert doing(plant) is ActivityName.HOLDING


def test_a_show_that_stands_ends_and_nothing_moves() -> None:
    plant = showing()
    plant.ask(PauseShow())
    plant.forward(3)
    before = plant.elevation_deg
    plant.blow(STORM).forward(30)
    assert doing(plant) is ActivityName.HOLDING
    assert plant.elevation_deg == pytest.approx(before, abs=0.01)
    assert plant.snapshot.not_stowed is not None


def test_a_parked_panel_is_stowed_and_parked_again() -> None:
    config = replace(QUICK, park=Orientation(180.0, 30.0))
    plant = Plant(READY, config=config).blow().forward(1)
    plant.ask(Park())
    plant.forward(60)
    assert doing(plant) is ActivityName.HOLDING
    plant.blow(STORM).forward(60)
    assert doing(plant) is ActivityName.STOWED
    plant.blow(2.0).forward(CALM_S + 60)
    assert doing(plant) is ActivityName.HOLDING
    assert plant.elevation_deg == pytest.approx(30.0, abs=0.1)


def test_a_stow_by_command_waits_for_resume_and_wind_wins_over_it() -> None:
    plant = tracking()
    plant.ask(Stow(StowName.HAIL))
    plant.forward(60)
    assert plant.elevation_deg == pytest.approx(15.0, abs=0.1)
    plant.blow(STORM).forward(60)
    assert plant.elevation_deg == pytest.approx(90.0, abs=0.1)
    plant.blow(2.0, snow_kg=9.0).forward(CALM_S + 90)
    assert plant.snapshot.stow is StowName.HAIL
    assert plant.elevation_deg == pytest.approx(15.0, abs=0.1)
    plant.blow(2.0).forward(5)
    plant.ask(Resume())
    assert doing(plant) is ActivityName.TRACKING
    with pytest.raises(CommandRejected):
        plant.ask(Resume())


@pytest.mark.fault(41)
def test_wind_takes_a_tracker_that_snow_has_stowed(fault: FaultResult) -> None:
    plant = tracking()
    plant.blow(2.0, snow_kg=4.0).forward(120)
    assert plant.snapshot.stow is StowName.SNOW
    plant.blow(STORM, snow_kg=4.0)
    begun = plant.clock.now()
    while plant.snapshot.stow is not StowName.WIND:
        assert plant.clock.now() - begun < timedelta(seconds=5)
        plant.forward(0.1)
    fault.noticed((plant.clock.now() - begun).total_seconds(), VIRTUAL)
    seen = plant.snapshot.protection
    assert seen is not None
    fault.shows(seen.reason.message)
    plant.blow(2.0, snow_kg=4.0).forward(CALM_S + 120)
    assert plant.snapshot.stow is StowName.SNOW
    fault.recovers("automatic: after the calm the snow stow continues")


def test_in_too_little_light_a_panel_stowed_by_command_reads_that_it_stays_so() -> None:
    plant = tracking()
    plant.ask(Stow(StowName.HAIL))
    plant.blow(2.0, irradiance_wm2=10.0).forward(920)
    assert promised(plant) == "The panel then stays stowed until you press Resume."


def test_in_too_little_light_the_panel_stays_where_it_is() -> None:
    plant = tracking()
    plant.blow(2.0, irradiance_wm2=10.0).forward(620)
    before = plant.azimuth_deg
    plant.forward(300)
    seen = plant.snapshot
    assert plant.azimuth_deg == before
    assert seen.protection is not None
    assert seen.protection.protection is Protection.LOW_LIGHT_HOLD
    assert "in low-light hold" in seen.activity_text
    assert [reason.code for reason in seen.waiting] == ["hibernation"]
    plant.blow(2.0, irradiance_wm2=700.0).forward(2)
    assert plant.snapshot.warning is not None
    plant.forward(20)
    assert plant.azimuth_deg > before + 0.5


def test_what_needs_calm_is_refused_in_a_storm_and_tracking_may_be_switched_on() -> None:
    plant = Plant(READY).blow(STORM).forward(1)
    for command in (Move(Orientation(90.0, 30.0)), Park(), GoToStart(SOLSTICE)):
        with pytest.raises(CommandRejected) as refused:
            plant.ask(command)
        assert "stow_demanded" in {reason.code for reason in refused.value.reasons}
    assert "stow_demanded" in plant.reasons("run_show") & plant.reasons("resume_show")
    plant.ask(Track())
    plant.forward(60)
    assert doing(plant) is ActivityName.STOWED


def test_after_a_restart_in_a_storm_the_journal_says_that_the_panel_stows_first() -> None:
    plant = restarted(tracking().blow(STORM))
    plant.forward(40)
    assert doing(plant) is ActivityName.STOWED
    assert not plant.happened(EventKind.TRACKING_RESUMED)
    told = [event.message for event in plant.events]
    waits, goes = "Tracking is on, but the panel stows first.", "Tracker 1 goes to the stow position wind."
    assert told.index(waits) < told.index(goes)
    plant.blow(5.0).forward(CALM_S + 60)
    assert doing(plant) is ActivityName.TRACKING
    (event,) = plant.happened(EventKind.TRACKING_RESUMED)
    assert event.message == "Tracking continues after the stow."


@pytest.mark.fault(38)
def test_a_wind_sensor_that_fails_stows_after_a_minute(fault: FaultResult) -> None:
    plant = tracking(CONFIG)
    plant.blow(None).forward(55)
    assert doing(plant) is ActivityName.TRACKING
    begun = plant.clock.now() - timedelta(seconds=55)
    while "wind_sensor_bad" not in {reason.code for reason in plant.snapshot.notices}:
        assert plant.clock.now() - begun <= timedelta(seconds=61)
        plant.forward(0.1)
    fault.noticed((plant.clock.now() - begun).total_seconds(), VIRTUAL)
    plant.forward(55)
    seen = plant.snapshot
    assert doing(plant) is ActivityName.STOWED
    assert seen.protection is not None
    assert seen.protection.reason.code == "wind_sensor_bad"
    assert "wind_sensor_bad" in {reason.code for reason in seen.notices}
    assert [event.data["quantity"] for event in plant.happened(EventKind.SENSOR_INVALID)] == [Quantity.WIND]
    fault.shows(seen.protection.reason.message)
    plant.blow(2.0).forward(630)
    assert doing(plant) is ActivityName.TRACKING
    fault.recovers("automatic: after 600 s of calm that a good sensor saw")


@pytest.mark.parametrize(
    ("facing", "wind_from_deg", "azimuth_deg"),
    [(Facing.BACK, 20.0, 200.0), (Facing.EDGE, 180.0, 90.0)],
)
def test_the_panel_turns_its_back_or_edge_into_the_wind(
    facing: Facing, wind_from_deg: float, azimuth_deg: float
) -> None:
    protection = ProtectionConfig(wind=WindProtection(facing=facing), stows=Stows(wind=StowPlace(60.0)))
    plant = tracking(protected(protection))
    plant.blow(STORM, wind_from_deg=wind_from_deg).forward(90)
    assert doing(plant) is ActivityName.STOWED
    assert plant.azimuth_deg == pytest.approx(azimuth_deg, abs=0.1)
    assert plant.elevation_deg == pytest.approx(60.0, abs=0.1)


def test_a_single_axis_panel_stows_as_level_as_it_can() -> None:
    mount = MountConfig(MountKind.HORIZONTAL_SINGLE_AXIS)
    axis = replace(CONFIG.azimuth, minimum_deg=-60.0, maximum_deg=60.0)
    config = replace(CONFIG, mount=mount, azimuth=axis)
    plant = tracking(config)
    plant.blow(STORM).forward(120)
    assert doing(plant) is ActivityName.STOWED
    assert plant.azimuth_deg == pytest.approx(0.0, abs=0.1)


def test_a_maintenance_lock_forbids_the_stow_too_and_outlives_a_restart() -> None:
    plant = tracking()
    plant.ask(SetInhibit("Ada", "new bearing"))
    plant.forward(5)
    before = plant.elevation_deg
    plant.blow(STORM).forward(60)
    assert plant.elevation_deg == before
    reason = plant.snapshot.not_stowed
    assert reason is not None
    assert "Ada (new bearing)" in reason.message
    for command in (Track(), Stow(StowName.WIND), Park(), Move(Orientation(90.0, 30.0)), SetInhibit("Bob")):
        with pytest.raises(CommandRejected) as refused:
            plant.ask(command)
        assert "maintenance_inhibit" in {one.code for one in refused.value.reasons}
    for action in ("home", "resume", "go_to_start", "run_show", "resume_show"):
        assert "maintenance_inhibit" in plant.reasons(action), action
    fresh = restarted(plant)
    fresh.forward(30)
    assert fresh.snapshot.lock is not None
    fresh.ask(Jog("a", Axis.AZIMUTH, 1))
    assert doing(fresh) is ActivityName.JOGGING
    fresh.ask(EndJog("a"))
    fresh.ask(ReleaseInhibit())
    fresh.forward(60)
    assert doing(fresh) is ActivityName.HOLDING
    with pytest.raises(CommandRejected):
        fresh.ask(ReleaseInhibit())
    for name, why in (("   ", "requires a name"), ("x" * 61, "requires a name"), ("a\nb", "invisible")):
        with pytest.raises(CommandRejected, match=why):
            fresh.ask(SetInhibit(name))


@pytest.mark.parametrize("via", ["mqtt", "sunspec", "token"])
def test_what_another_machine_starts_is_announced(via: str) -> None:
    plant = calm()
    plant.ask(Move(Orientation(90.0, 30.0)), via=via)
    before = plant.azimuth_deg
    plant.forward(4.7)
    assert plant.azimuth_deg == before
    assert plant.told.horn
    plant.forward(60)
    assert plant.azimuth_deg == pytest.approx(90.0, abs=0.1)
    assert doing(plant) is ActivityName.HOLDING


def test_what_somebody_at_the_machine_starts_begins_at_once() -> None:
    plant = calm()
    before = plant.azimuth_deg
    plant.ask(Move(Orientation(90.0, 30.0)), "mqtt (token)", via="session")
    plant.forward(1)
    assert plant.azimuth_deg > before
    assert not plant.happened(EventKind.MOTION_ANNOUNCED)


def test_the_first_motion_of_the_morning_is_announced() -> None:
    plant = Plant(READY, at=datetime(2026, 6, 21, 1, 30, tzinfo=UTC), watchdog=None).blow(1.0).forward(1)
    plant.ask(Track())
    plant.forward(30)
    assert plant.snapshot.warning is None
    plant.period = timedelta(seconds=2)
    plant.forward(3600)
    announced = plant.happened(EventKind.MOTION_ANNOUNCED)
    assert [event.message for event in announced] == [
        "Tracker 1 begins to follow the sun. Motion starts in 5 s."
    ]
    assert plant.snapshot.in_position


def test_the_warning_time_can_be_switched_off() -> None:
    plant = tracking(protected(ProtectionConfig(warning_s=0.0)))
    plant.blow(STORM).forward(1)
    assert plant.drive.observe().elevation.moving


@pytest.mark.fault(33)
def test_in_the_polar_night_a_storm_stows_and_calm_brings_the_night_back() -> None:
    plant = (
        Plant(
            TrackerMemory(mode=READY.mode, home=READY.home),
            at=datetime(2026, 12, 21, 12, tzinfo=UTC),
            location=Location(78.2, 15.6, 10.0),
            config=QUICK,
        )
        .blow(2.0, irradiance_wm2=0.0)
        .forward(1)
    )
    plant.ask(Track())
    plant.forward(630)
    assert plant.snapshot.protection is None
    plant.blow(STORM, irradiance_wm2=0.0).forward(60)
    assert doing(plant) is ActivityName.STOWED
    plant.blow(2.0, irradiance_wm2=0.0).forward(CALM_S + 30)
    assert doing(plant) is ActivityName.TRACKING


def test_a_clock_that_jumps_does_not_shorten_the_calm_time() -> None:
    plant = tracking()
    plant.blow(STORM).forward(60)
    plant.clock_trusted = False
    plant.blow(2.0).forward(CALM_S - 10)
    assert doing(plant) is ActivityName.STOWED
