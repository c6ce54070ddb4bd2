"""Setting zero, searching the origin, and losing the trust in it."""

from dataclasses import replace
from datetime import timedelta

import pytest

from app.simulation.faults import Fault, FaultKind
from app.tracker.commands.commands import CommandRejected, Home, SetHome, Stop, Track
from app.tracker.memory.memory import Confirmation, Pointing, Sighting, StepName
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import DriveConfig, DriveKind
from app.tracker.state.snapshot import ActivityName, EventKind
from app.tracker.values.motion import AxisFeedback, Feedback, RequestKind
from tests.fault_result import HOME_AGAIN, VIRTUAL, FaultResult
from tests.tracker.plant import CONFIG, MORNING, READY, TRUST, Plant
from tests.tracker.scripted import Scripted

NEEDS_HOME = ("move", "track", "park", "go_to_start", "run_show")


def test_zero_is_set_axis_by_axis_read_back_and_trusted() -> None:
    plant = Plant()
    plant.tick()
    plant.ask(SetHome())
    assert plant.activity is ActivityName.SETTING_HOME
    assert plant.snapshot.activity_text == "Setting the home position"
    plant.forward(1.0)
    assert (plant.azimuth_deg, plant.elevation_deg) == (0.0, 0.0)
    assert plant.snapshot.homed
    home = plant.controller.memory.home
    assert home is not None
    assert (home.by, home.how, home.boot_count) == ("technician", "set manually", 1)
    assert plant.controller.memory.confirmations[StepName.HOMING].location_revision == 1
    assert len(plant.happened(EventKind.HOME_POSITION_SET)) == 1


def test_one_axis_alone_is_not_enough_for_trust() -> None:
    plant = Plant()
    plant.tick()
    plant.ask(SetHome((Axis.ELEVATION,)))
    plant.forward(1.0)
    assert plant.happened(EventKind.HOME_POSITION_SET)[0].data == {"axes": ["elevation"]}
    assert not plant.snapshot.homed
    assert all("tracker_not_homed" in plant.reasons(action) for action in NEEDS_HOME)
    plant.ask(SetHome((Axis.AZIMUTH,)))
    plant.forward(1.0)
    assert plant.snapshot.homed


def test_zero_needs_axes_at_rest_a_drive_and_an_axis() -> None:
    plant = Plant()
    assert plant.reasons("set_home") == {"drive_unreachable"}
    plant.tick()
    with pytest.raises(CommandRejected, match="No axis of this mount was selected for homing"):
        plant.ask(SetHome(()))
    script = Scripted()
    script.reading = replace(script.reading, azimuth=replace(script.reading.azimuth, moving=True))
    script.tick()
    with pytest.raises(CommandRejected, match="are still moving"):
        script.ask(SetHome())


@pytest.mark.parametrize(
    ("answer", "why"),
    [
        ({"request_failed": True}, "refused the command for the azimuth axis"),
        ({"azimuth": AxisFeedback(3.0, 0.0, moving=False, homed=True)}, "reads 3.00 degrees instead of 0"),
        ({"azimuth": AxisFeedback(0.0, 0.0, moving=False, homed=False)}, "does not report the azimuth axis"),
    ],
)
def test_a_zero_that_does_not_read_back_fails_with_a_sentence(answer: dict[str, object], why: str) -> None:
    script = Scripted(READY)
    script.tick()
    script.ask(SetHome((Axis.AZIMUTH,)))
    request = script.told.request
    assert request is not None
    assert request.kind is RequestKind.SET_HOME_AZIMUTH
    script.reading = replace(script.reading, request_done=request.number, **answer)
    happened = [event.message for event in script.tick()]
    assert why in happened[0]
    assert not script.snapshot.homed
    assert script.controller.activity is ActivityName.HOLDING


def test_a_drive_that_does_not_answer_a_request_is_not_waited_for_for_ever() -> None:
    script = Scripted()
    script.tick()
    script.ask(SetHome())
    script.forward(5.5)
    assert "did not answer in time" in script.happened(EventKind.HOME_POSITION_NOT_SET)[0].message


def test_request_numbers_go_on_from_what_the_drive_has_answered_and_stay_within_16_bits() -> None:
    script = Scripted()
    script.reading = replace(script.reading, request_done=30_000)
    script.tick()
    script.ask(SetHome())
    assert script.told.request is not None
    assert script.told.request.number == 1


def test_stopping_while_zero_is_being_set_gives_up_the_old_zero() -> None:
    script = Scripted(READY)
    script.tick()
    script.ask(SetHome())
    happened = script.ask(Stop())
    assert happened == [EventKind.HOME_POSITION_NOT_SET, EventKind.HOME_LOST, EventKind.STOPPED]


def test_the_drive_searches_its_origin_by_itself() -> None:
    plant = Plant()
    plant.tick()
    assert plant.ask(Home()) == [EventKind.HOMING_STARTED]
    plant.forward(1.0)
    assert plant.activity is ActivityName.HOMING
    assert plant.snapshot.activity_text == "Searching for the home switches"
    assert "busy_homing" in plant.reasons("jog")
    plant.forward(60.0)
    assert plant.happened(EventKind.HOMING_ENDED)[0].data == {"outcome": "homed"}
    home = plant.controller.memory.home
    assert home is not None
    assert home.how == "home switches"
    assert plant.drive.true_orientation.azimuth_deg == pytest.approx(0.0, abs=0.6)


@pytest.mark.fault(23)
def test_a_search_that_is_stopped_leaves_no_zero_and_the_drive_at_rest(fault: FaultResult) -> None:
    plant = Plant()
    plant.tick()
    plant.ask(Home())
    plant.forward(0.5)
    plant.ask(Stop())
    fault.noticed(0.0, VIRTUAL)
    plant.forward(1.0)
    assert not plant.snapshot.homed
    assert not plant.drive.observe().homing
    assert plant.activity is ActivityName.HOLDING
    assert "was not finished" in plant.controller.memory.home_lost
    fault.shows(plant.controller.memory.home_lost)
    plant.ask(Home())
    plant.forward(120.0)
    assert plant.snapshot.homed
    fault.recovers(HOME_AGAIN)


@pytest.mark.parametrize(
    ("answer", "why"),
    [({"request_failed": True}, "did not find them"), ({}, "does not report both axes as homed")],
)
def test_a_search_that_fails_says_why(answer: dict[str, bool], why: str) -> None:
    script = Scripted()
    script.tick()
    script.ask(Home())
    assert script.told.request is not None
    script.reading = replace(script.reading, request_done=script.told.request.number, **answer)
    script.tick()
    assert why in script.happened(EventKind.HOMING_ENDED)[0].message


@pytest.mark.fault(19)
def test_a_search_waits_for_rest_and_ends_when_it_takes_too_long() -> None:
    script = Scripted()
    script.tick()
    script.ask(Home())
    assert script.told.request is not None
    script.reading = replace(script.reading, request_done=script.told.request.number, homing=True)
    script.tick()
    assert script.controller.activity is ActivityName.HOMING
    script.reading = replace(script.reading, request_done=0)
    script.period = timedelta(seconds=60)
    script.forward(3600.0)
    assert "took too long" in script.happened(EventKind.HOMING_ENDED)[0].message


def test_a_drive_without_origin_switches_is_homed_by_hand() -> None:
    script = Scripted(capabilities={"automatic_homing": False})
    script.tick()
    with pytest.raises(CommandRejected, match="no home switches"):
        script.ask(Home())


def test_a_search_that_the_drive_still_pursues_is_ended() -> None:
    script = Scripted()
    script.reading = replace(script.reading, homing=True)
    script.tick()
    assert script.told.azimuth != script.told.__class__().azimuth


def test_a_restarted_drive_has_lost_its_zero_and_tracking_waits() -> None:
    plant = Plant(READY)
    plant.tick()
    plant.ask(Track())
    plant.forward(5.0)
    plant.drive.inject(Fault(FaultKind.POWER_LOSS))
    plant.forward(0.2)
    assert plant.activity is ActivityName.HOLDING
    assert plant.controller.memory.tracking_on
    assert "restarted" in plant.happened(EventKind.HOME_LOST)[0].message
    assert plant.happened(EventKind.TRACKING_INTERRUPTED)
    assert [reason.code for reason in plant.snapshot.waiting] == ["drive_restarted"], "one cause, told once"
    assert "step 3" in plant.snapshot.waiting[0].hint
    assert "tracker_not_homed" in plant.reasons("track")
    assert "restarted" in plant.controller.memory.home_lost


def test_a_drive_that_restarted_while_nobody_looked_is_noticed() -> None:
    script = Scripted(READY)
    script.reading = replace(script.reading, boot_count=7)
    script.tick()
    assert "restarted since" in script.happened(EventKind.HOME_LOST)[0].message


@pytest.mark.parametrize("axis", list(Axis))
def test_a_drive_that_reports_a_lost_zero_is_believed(axis: Axis) -> None:
    script = Scripted(READY)
    script.tick()
    lost = AxisFeedback(0.0, 0.0, moving=False, homed=False)
    script.reading = replace(script.reading, **{axis.value: lost})
    script.tick()
    assert (
        f"the {axis} axis of Tracker 1 has lost its home reference"
        in script.happened(EventKind.HOME_LOST)[0].message
    )


def test_an_encoder_jump_ends_the_trust_and_an_ordinary_stop_does_not() -> None:
    plant = Plant(READY)
    plant.tick()
    plant.ask(Stop())
    plant.forward(1.0)
    assert plant.snapshot.homed
    plant.drive.inject(Fault(FaultKind.ENCODER_JUMP, Axis.AZIMUTH, 12.0))
    plant.forward(0.2)
    assert "jumped by" in plant.happened(EventKind.HOME_LOST)[0].message
    plant.ask(SetHome((Axis.ELEVATION,)))
    plant.forward(1.0)
    assert not plant.snapshot.homed
    plant.ask(SetHome((Axis.AZIMUTH,)))
    plant.forward(1.0)
    assert plant.snapshot.homed


def test_another_drive_is_another_zero() -> None:
    plant = Plant(READY)
    plant.tick()
    renamed = replace(CONFIG, name="North mast")
    plant.controller.configure(renamed, plant.drive.capabilities)
    plant.tick()
    assert plant.snapshot.homed
    assert plant.snapshot.name == "North mast"
    other = replace(CONFIG, drive=DriveConfig(DriveKind.MODBUS_TCP))
    plant.controller.configure(other, plant.drive.capabilities)
    plant.tick()
    assert not plant.snapshot.homed
    assert "another drive" in plant.happened(EventKind.HOME_LOST)[0].message
    assert plant.controller.config is other


def test_confirmations_sightings_and_pointing_are_kept() -> None:
    plant = Plant(READY)
    saved = Confirmation(MORNING, "technician", 3)
    sighting = Sighting(MORNING, 90.0, 40.0, 91.0, 40.5)
    before = plant.controller.memory
    plant.controller.confirm(StepName.MODE, saved)
    plant.controller.set_sightings((sighting,))
    plant.controller.set_pointing(Pointing(azimuth_offset_deg=1.0))
    memory = plant.controller.memory
    assert memory.confirmations == {StepName.MODE: saved}
    assert memory.sightings == (sighting,)
    assert memory.pointing.azimuth_offset_deg == 1.0
    assert before.sightings == ()
    assert memory.home == TRUST
    plant.tick()
    plant.tick()
    assert plant.controller.memory is memory


def test_a_reading_is_complete() -> None:
    assert Scripted().reading == Feedback(
        AxisFeedback(0.0, 0.0, moving=False, homed=False),
        AxisFeedback(0.0, 0.0, moving=False, homed=False),
        boot_count=1,
    )
