"""Setting zero, searching the origin, and losing the trust in it."""

from dataclasses import replace
from datetime import timedelta

import pytest

from app.alarms.conditions import SiteHealth, of_tracker
from app.tracker.commands.commands import Command, CommandRejected, Home, SetHome, Stop, UndoHome
from app.tracker.memory.memory import CommissioningLock, Pointing, Sighting, StepName
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import DriveConfig, DriveKind
from app.tracker.state.snapshot import ActivityName, EventKind, Snapshot
from app.tracker.values.motion import AxisFeedback, RequestKind
from tests.fault_result import HOME_AGAIN, VIRTUAL, FaultResult
from tests.tracker.plant import BLANK, CONFIG, MORNING, READY, TRUST, Plant
from tests.tracker.scripted import Scripted

NEEDS_HOME = ("move", "track", "park", "go_to_start", "run_show")


def test_zero_is_set_axis_by_axis_read_back_and_trusted(blank: Plant) -> None:
    blank.ask(SetHome())
    assert blank.activity is ActivityName.SETTING_HOME
    assert blank.snapshot.activity_text == "Setting the home position"
    blank.forward(1.0)
    assert (blank.azimuth_deg, blank.elevation_deg) == (0.0, 0.0)
    assert blank.snapshot.homed
    home = blank.controller.memory.home
    assert home is not None
    assert (home.by, home.how, home.boot_count) == ("technician", "set manually", 1)
    assert blank.controller.memory.confirmations[StepName.HOMING].location_revision == 1
    assert len(blank.happened(EventKind.HOME_POSITION_SET)) == 1


def test_one_axis_alone_is_not_enough_for_trust(blank: Plant) -> None:
    blank.ask(SetHome((Axis.ELEVATION,)))
    blank.forward(1.0)
    assert blank.happened(EventKind.HOME_POSITION_SET)[0].data == {"axes": ["elevation"]}
    assert not blank.snapshot.homed
    assert all("tracker_not_homed" in blank.reasons(action) for action in NEEDS_HOME)
    blank.ask(SetHome((Axis.AZIMUTH,)))
    blank.forward(1.0)
    assert blank.snapshot.homed


def test_zero_needs_axes_at_rest_a_drive_and_an_axis() -> None:
    plant = Plant()
    assert plant.reasons("set_home") == {"drive_unreachable"}
    plant.tick()
    with pytest.raises(CommandRejected, match="No axis of this mount was selected for homing"):
        plant.ask(SetHome(()))
    script = Scripted()
    script.sees(azimuth=replace(script.reading.azimuth, moving=True))
    script.tick()
    for command in (SetHome(), Home(), UndoHome()):
        with pytest.raises(CommandRejected, match="are still moving"):
            script.ask(command)


def test_locked_settings_keep_the_home_position_that_was_set() -> None:
    plant = Plant(replace(READY, settings_lock=CommissioningLock("ada", MORNING)))
    plant.tick()
    assert "settings_locked" in plant.reasons("set_home") & plant.reasons("undo_home")
    with pytest.raises(CommandRejected, match="locked"):
        plant.ask(SetHome())


@pytest.mark.parametrize(
    ("answer", "why"),
    [
        ({"request_failed": True}, "refused the command for the azimuth axis"),
        ({"azimuth": AxisFeedback(3.0, 0.0, moving=False, homed=True)}, "reads 3.00 degrees instead of 0"),
        ({"azimuth": AxisFeedback(0.0, 0.0, moving=False, homed=False)}, "does not report the azimuth axis"),
    ],
)
def test_a_zero_that_does_not_read_back_fails_with_a_sentence(
    script: Scripted, answer: dict[str, object], why: str
) -> None:
    script.ask(SetHome((Axis.AZIMUTH,)))
    request = script.told.request
    assert request is not None
    assert request.kind is RequestKind.SET_HOME_AZIMUTH
    script.answers(**answer)
    happened = [event.message for event in script.tick()]
    assert why in happened[0]
    assert not script.snapshot.homed
    assert script.controller.activity is ActivityName.HOLDING


def test_a_drive_that_does_not_answer_a_request_is_not_waited_for_for_ever(blank_script: Scripted) -> None:
    blank_script.ask(SetHome())
    blank_script.forward(5.5)
    assert "did not answer in time" in blank_script.happened(EventKind.HOME_POSITION_NOT_SET)[0].message


def test_request_numbers_go_on_from_what_the_drive_has_answered_and_stay_within_16_bits() -> None:
    script = Scripted()
    script.sees(request_done=30_000)
    script.tick()
    script.ask(SetHome())
    assert script.told.request is not None
    assert script.told.request.number == 1


def test_stopping_while_zero_is_being_set_gives_up_the_old_zero(script: Scripted) -> None:
    script.ask(SetHome())
    happened = script.ask(Stop())
    assert happened == [EventKind.HOME_POSITION_NOT_SET, EventKind.HOME_LOST, EventKind.STOPPED]


def test_the_drive_searches_its_origin_by_itself(blank: Plant) -> None:
    assert blank.ask(Home()) == [EventKind.HOMING_STARTED]
    blank.forward(1.0)
    assert blank.activity is ActivityName.HOMING
    assert blank.snapshot.activity_text == "Searching for the home switches"
    assert "busy_homing" in blank.reasons("jog")
    blank.forward(60.0)
    assert blank.happened(EventKind.HOMING_ENDED)[0].data == {"outcome": "homed"}
    home = blank.controller.memory.home
    assert home is not None
    assert home.how == "home switches"
    assert blank.drive.true_orientation.azimuth_deg == pytest.approx(0.0, abs=0.6)


@pytest.mark.fault(23)
def test_a_search_that_is_stopped_leaves_no_zero_and_the_drive_at_rest(
    blank: Plant, fault: FaultResult
) -> None:
    blank.ask(Home())
    blank.forward(0.5)
    blank.ask(Stop())
    fault.noticed(0.0, VIRTUAL)
    blank.forward(1.0)
    assert not blank.snapshot.homed
    assert not blank.drive.observe().homing
    assert blank.activity is ActivityName.HOLDING
    assert "was not finished" in blank.controller.memory.home_lost
    fault.shows(blank.controller.memory.home_lost)
    blank.ask(Home())
    blank.forward(120.0)
    assert blank.snapshot.homed
    fault.recovers(HOME_AGAIN)


def test_while_the_search_runs_no_place_says_that_it_was_not_finished(blank: Plant) -> None:
    blank.ask(Home())
    blank.forward(1.0)
    seen = blank.snapshot
    reasons = [reason.message for given in seen.actions.values() for reason in given]
    said = [seen.home_lost, seen.activity_text, *(one.message for one in seen.notices), *reasons]
    assert blank.activity is ActivityName.HOMING
    assert "a search for the home switches was started." in said
    assert not [text for text in said if "not finished" in text]
    since = seen.home_lost_at
    blank.ask(Stop())
    assert blank.snapshot.home_lost == "the search for the home switches was not finished."
    assert blank.snapshot.home_lost_at == since


def test_a_search_that_a_restart_cut_off_was_not_finished(blank: Plant) -> None:
    blank.ask(Home())
    blank.forward(1.0)
    again = Plant(blank.controller.memory, at=blank.clock.now())
    again.tick()
    assert again.snapshot.home_lost == "the search for the home switches was not finished."


@pytest.mark.parametrize(
    ("answer", "why"),
    [({"request_failed": True}, "did not find them"), ({}, "does not report both axes as homed")],
)
def test_a_search_that_fails_says_why(blank_script: Scripted, answer: dict[str, bool], why: str) -> None:
    blank_script.ask(Home())
    blank_script.answers(**answer)
    blank_script.tick()
    assert why in blank_script.happened(EventKind.HOMING_ENDED)[0].message


@pytest.mark.fault(19)
def test_a_search_waits_for_rest_and_ends_when_it_takes_too_long(blank_script: Scripted) -> None:
    blank_script.ask(Home())
    blank_script.answers(homing=True)
    blank_script.tick()
    assert blank_script.controller.activity is ActivityName.HOMING
    blank_script.sees(request_done=0)
    blank_script.period = timedelta(seconds=60)
    blank_script.forward(3600.0)
    assert "took too long" in blank_script.happened(EventKind.HOMING_ENDED)[0].message


def test_a_drive_without_home_switches_searches_nothing() -> None:
    script = Scripted(capabilities={"automatic_homing": False})
    script.tick()
    with pytest.raises(CommandRejected, match="no home switches"):
        script.ask(Home())


def test_a_search_that_the_drive_still_pursues_is_ended() -> None:
    script = Scripted()
    script.sees(homing=True)
    script.tick()
    assert script.told.azimuth != script.told.__class__().azimuth


def test_sightings_and_pointing_are_kept_beside_the_zero(plant: Plant) -> None:
    sighting = Sighting(MORNING, 90.0, 40.0, 91.0, 40.5)
    plant.controller.set_sightings((sighting,))
    plant.controller.set_pointing(Pointing(azimuth_offset_deg=1.0))
    memory = plant.controller.memory
    assert (memory.sightings, memory.home) == ((sighting,), TRUST)
    assert memory.pointing.azimuth_offset_deg == 1.0
    plant.tick()
    plant.tick()
    assert plant.controller.memory is memory


def test_another_drive_is_another_zero(plant: Plant) -> None:
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


def is_alarmed(shown: Snapshot) -> bool:
    return any(found.code == "home_lost" for found in of_tracker(shown, SiteHealth(), frozenset()))


def alarmed_during(plant: Plant, command: Command, seconds: float) -> int:
    """Return at how many looks the alarm was there, from the command on."""
    plant.ask(command)
    found = int(is_alarmed(plant.snapshot))

    def look() -> None:
        nonlocal found
        found += is_alarmed(plant.snapshot)

    plant.forward(seconds, look, every=5)
    return found


@pytest.mark.parametrize("command", [Home(), SetHome((Axis.AZIMUTH,))], ids=["search", "set"])
@pytest.mark.parametrize("homed", [True, False])
def test_giving_up_a_zero_by_command_and_undoing_it_raise_no_alarm(command: Command, *, homed: bool) -> None:
    plant = Plant(READY if homed else BLANK)
    plant.tick()
    assert alarmed_during(plant, command, 60.0) == 0
    assert plant.activity is ActivityName.HOLDING
    if isinstance(command, SetHome):
        assert plant.snapshot.can_undo_home
        assert alarmed_during(plant, UndoHome(), 2.0) == 0
        assert plant.snapshot.homed is homed


@pytest.mark.parametrize("during", [None, Home()], ids=["at rest", "homing"])
def test_a_drive_that_restarts_raises_it_at_once(script: Scripted, during: Command | None) -> None:
    if during is not None:
        script.ask(during)
    assert not is_alarmed(script.snapshot)
    script.sees(boot_count=script.reading.boot_count + 1)
    script.tick()
    assert is_alarmed(script.snapshot)


def test_a_homing_that_fails_raises_it_at_once(script: Scripted) -> None:
    script.ask(Home())
    script.answers(request_failed=True)
    script.tick()
    assert script.controller.activity is ActivityName.HOLDING
    assert is_alarmed(script.snapshot)


def test_a_homing_that_is_stopped_raises_it(script: Scripted) -> None:
    script.ask(Home())
    script.ask(Stop())
    assert is_alarmed(script.snapshot)
