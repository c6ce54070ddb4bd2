"""Tracking: within the deadband by day, ready for the sunrise by night, and never by itself after a doubt."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest

from app.sun.position import Location, SunPosition
from app.tracker.commands.commands import CommandRejected, Move, SetHome, Stop, Track
from app.tracker.memory.memory import Confirmation, StepName, TrackerMemory
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import NightBehaviour, Orientation, TrackerConfig
from app.tracker.state.snapshot import ActivityName, EventKind, Snapshot
from app.tracker.values.mode import Mode
from app.tracker.values.motion import HALT, DriveCommand
from tests.fault_result import FaultResult
from tests.tracker.plant import BLANK, CONFIG, MORNING, READY, SAMSUN, Plant
from tests.tracker.scripted import Scripted


def tracking(
    memory: TrackerMemory = READY,
    *,
    config: TrackerConfig = CONFIG,
    at: datetime = MORNING,
    location: Location = SAMSUN,
) -> Plant:
    """Return a plant that has tracked for two minutes at one tick a second."""
    plant = Plant(memory, config=config, at=at, location=location, watchdog=None)
    plant.period = timedelta(seconds=1)
    plant.tick()
    plant.ask(Track())
    return plant.forward(120.0)


def test_the_panel_stays_within_the_deadband_of_the_sun_and_rests_between_its_moves() -> None:
    plant = tracking()
    off_deg, resting = [], 0

    def look() -> None:
        nonlocal resting
        off_deg.append(plant.snapshot.off_sun_deg or 0.0)
        resting += plant.told.azimuth == HALT and plant.told.elevation == HALT

    plant.forward(300.0, look)
    assert 0.3 < max(off_deg) < CONFIG.deadband_deg
    assert resting > 270
    assert plant.snapshot.activity_text.startswith("Tracking: next move")


def test_at_night_the_panel_turns_once_to_where_the_sun_will_rise() -> None:
    plant = tracking(at=datetime(2026, 6, 21, 20, 0, tzinfo=UTC))
    plant.forward(60.0)
    shown = plant.snapshot
    assert plant.dawn is not None
    assert plant.azimuth_deg == pytest.approx(plant.dawn.azimuth_deg, abs=0.05)
    assert plant.elevation_deg == pytest.approx(0.0, abs=0.05)
    assert shown.activity_text == "Tracking: holding until sunrise"
    assert [reason.code for reason in shown.waiting] == ["sun_down"]
    assert shown.off_sun_deg is None
    assert not shown.sun_is_up


def test_a_range_wound_up_by_day_is_unwound_although_the_panel_faces_the_same_way() -> None:
    wide = replace(CONFIG, azimuth=replace(CONFIG.azimuth, minimum_deg=0.0, maximum_deg=540.0))
    plant = tracking(config=wide, at=datetime(2026, 6, 21, 20, 0, tzinfo=UTC))
    low_deg = plant.azimuth_deg
    plant.ask(Stop())
    plant.forward(2.0)
    for azimuth_deg in (170.0, 300.0, 359.0):
        plant.ask(Move(Orientation(azimuth_deg, 0.0)))
        plant.forward(60.0)
    plant.ask(Move(Orientation(low_deg, 0.0)))
    plant.forward(60.0)
    assert plant.azimuth_deg == pytest.approx(low_deg + 360.0, abs=0.05)
    plant.ask(Track())
    assert plant.snapshot.activity_text == "Tracking: the sun is down, going to the night position"
    plant.forward(90.0)
    assert plant.azimuth_deg == pytest.approx(low_deg, abs=0.05)


def test_in_the_south_a_range_of_more_than_a_turn_waits_for_the_sunrise_at_its_upper_end() -> None:
    wide = replace(CONFIG, azimuth=replace(CONFIG.azimuth, minimum_deg=0.0, maximum_deg=540.0))
    plant = tracking(config=wide, at=datetime(2026, 12, 21, 12, tzinfo=UTC), location=Location(-34.0, 150.0))
    plant.forward(60.0)
    assert plant.dawn is not None
    assert plant.azimuth_deg == pytest.approx(plant.dawn.azimuth_deg + 360.0, abs=0.5)


@pytest.mark.parametrize("night", [NightBehaviour.HOLD, NightBehaviour.PARK])
def test_other_nights(night: NightBehaviour) -> None:
    plant = tracking(config=replace(CONFIG, night=night), at=datetime(2026, 6, 21, 20, 0, tzinfo=UTC))
    plant.forward(60.0)
    elevation_deg = 90.0 if night is NightBehaviour.PARK else 0.0
    assert plant.elevation_deg == pytest.approx(elevation_deg, abs=0.05)
    assert (plant.snapshot.target is None) == (night is NightBehaviour.HOLD)


def test_in_the_polar_night_there_is_no_sunrise_to_turn_to_but_a_park_position() -> None:
    noon, north = datetime(2026, 12, 21, 12, tzinfo=UTC), Location(85.0, 20.0)
    parked = tracking(config=replace(CONFIG, night=NightBehaviour.PARK), at=noon, location=north)
    assert parked.elevation_deg == pytest.approx(90.0, abs=0.05)
    plant = tracking(at=noon, location=north)
    assert plant.dawn is None
    assert plant.told == DriveCommand()
    assert plant.snapshot.activity_text == "Tracking: holding until sunrise"


def test_azimuth_tracking_holds_its_elevation_and_fixed_tracks_nothing() -> None:
    plant = tracking(replace(READY, mode=Mode.AZIMUTH, orientation=Orientation(0.0, 25.0)))
    assert plant.elevation_deg == pytest.approx(25.0, abs=0.05)
    shown = plant.snapshot
    assert shown.sun is not None
    assert plant.azimuth_deg == pytest.approx(shown.sun.azimuth_deg, abs=CONFIG.deadband_deg)
    plant = tracking(replace(READY, mode=Mode.FIXED, orientation=Orientation(40.0, 25.0)))
    assert (plant.azimuth_deg, plant.elevation_deg) == pytest.approx((40.0, 25.0), abs=0.05)
    assert plant.snapshot.activity_text == "Tracking: holding the fixed orientation"


def test_a_sun_beyond_the_limits_is_faced_as_nearly_as_possible_and_it_is_said() -> None:
    low = replace(CONFIG, elevation=replace(CONFIG.elevation, maximum_deg=30.0))
    plant = tracking(config=low, at=datetime(2026, 6, 21, 10, 0, tzinfo=UTC))
    plant.forward(3.0)
    shown = plant.snapshot
    assert "edge of the axes' range" in shown.activity_text
    assert "limited" in {notice.code for notice in shown.notices}
    assert shown.measured is not None
    assert shown.measured.elevation_deg == pytest.approx(30.0, abs=0.05)


@pytest.mark.fault(34)
def test_a_slow_azimuth_axis_says_that_it_passes_the_zenith(fault: FaultResult) -> None:
    slow = replace(CONFIG, azimuth=replace(CONFIG.azimuth, speed_dps=0.2, jog_slow_dps=0.1, jog_fast_dps=0.2))
    noon = datetime(2026, 6, 10, 11, 45, tzinfo=UTC)
    plant = tracking(config=slow, at=noon, location=Location(23.0, 0.0))
    shown = ""
    while not shown.startswith("Tracking: passing") and plant.clock.now() < noon + timedelta(minutes=30):
        shown = plant.forward(30.0).snapshot.activity_text
    assert shown == "Tracking: passing the zenith as fast as the azimuth axis can"
    fault.prevented("the aim is led or held within the speed of the axis")
    fault.shows(shown)
    while not plant.snapshot.in_position and plant.clock.now() < noon + timedelta(minutes=60):
        plant.forward(30.0)
    assert plant.snapshot.in_position
    assert not plant.happened(EventKind.FAULT_RAISED)
    fault.recovers("automatic: after the zenith the panel is in position again")


def test_tracking_needs_everything_that_the_earlier_steps_give_and_says_all_of_it() -> None:
    plant = Plant(BLANK, location=None)
    plant.clock_trusted = False
    plant.tick()
    with pytest.raises(CommandRejected) as refused:
        plant.ask(Track())
    assert [reason.code for reason in refused.value.reasons] == [
        "tracker_not_homed",
        "location_unknown",
        "clock_untrusted",
        "mode_not_selected",
    ]


def test_a_step_saved_for_a_former_location_has_to_be_confirmed_first() -> None:
    plant = Plant(replace(READY, confirmations={StepName.MODE: Confirmation(MORNING, "technician", 0)}))
    plant.tick()
    with pytest.raises(CommandRejected, match="location has changed since step 4, mode"):
        plant.ask(Track())


def test_after_a_restart_tracking_goes_on_by_itself() -> None:
    plant = Plant(replace(READY, tracking_on=True))
    plant.cut = True
    plant.forward(1.0)
    plant.cut = False
    plant.tick()
    assert plant.activity is ActivityName.TRACKING
    assert len(plant.happened(EventKind.TRACKING_RESUMED)) == 1


@pytest.mark.parametrize(
    ("memory", "code"),
    [
        (replace(READY, tracking_on=True, home=None), "tracker_not_homed"),
        (replace(READY, tracking_on=True, fault_code="drive_fault", fault_text="Hot."), "fault"),
    ],
)
def test_after_a_restart_without_trust_it_waits_visibly(memory: TrackerMemory, code: str) -> None:
    plant = Plant(memory)
    plant.forward(1.0)
    assert plant.activity is not ActivityName.TRACKING
    assert len(plant.happened(EventKind.TRACKING_INTERRUPTED)) == 1
    assert code in {reason.code for reason in plant.snapshot.waiting}


def test_a_drive_that_answers_late_after_a_restart_does_not_start_to_move() -> None:
    plant = Plant(replace(READY, tracking_on=True))
    plant.cut = True
    plant.forward(11.0)
    plant.cut = False
    plant.forward(1.0)
    assert plant.activity is ActivityName.HOLDING
    assert "drive_lost" in {reason.code for reason in plant.snapshot.waiting}


def test_rehoming_leaves_the_start_to_the_operator() -> None:
    plant = Plant(replace(READY, tracking_on=True, home=None))
    plant.tick()
    plant.ask(SetHome(tuple(Axis)))
    plant.forward(1.0)
    shown = plant.snapshot
    assert shown.activity is ActivityName.HOLDING
    assert shown.activity_text == "Holding; tracking needs the operator"
    assert shown.waiting
    assert not shown.actions["track"]
    plant.ask(Track())
    assert plant.activity is ActivityName.TRACKING


def test_a_run_that_does_not_arrive_is_a_fault() -> None:
    script = Scripted(READY)
    script.sun = SunPosition(0.9, 0.9, 0.9)
    script.tick()
    script.ask(Track())
    script.forward(7.0)
    assert script.controller.memory.fault_code == "move_overdue"


def test_starting_twice_is_starting_once_and_stop_switches_tracking_off_for_good() -> None:
    plant = tracking()
    assert plant.ask(Track()) == []
    assert len(plant.happened(EventKind.TRACKING_STARTED)) == 1
    assert plant.ask(Stop()) == [EventKind.TRACKING_ENDED, EventKind.STOPPED]
    assert not plant.controller.memory.tracking_on
    plant.forward(30.0)
    assert plant.activity is ActivityName.HOLDING
    assert plant.snapshot.waiting == ()


def test_a_frame_is_the_tick_as_numbers() -> None:
    plant = tracking()
    elapsed, sun_time, *row = plant.controller.frame()
    shown: Snapshot = plant.snapshot
    assert elapsed != elapsed
    assert sun_time != sun_time
    assert shown.sun is not None
    assert row[:2] == [shown.sun.azimuth_deg, shown.sun.apparent_elevation_deg]
    assert row[2:4] == row[:2]
    assert row[6:8] == [plant.azimuth_deg, plant.elevation_deg]
    assert list(ActivityName)[int(row[-1])] is ActivityName.TRACKING
    empty = Plant(location=None)
    assert all(value != value for value in empty.controller.frame()[2:10])
