"""Giving up the home position by command raises no alarm; losing it does, and so does a homing that fails."""

import pytest

from app.alarms.conditions import SiteHealth, of_tracker
from app.tracker.commands.commands import Command, Home, SetHome, Stop, UndoHome
from app.tracker.settings.axes import Axis
from app.tracker.state.snapshot import ActivityName, Snapshot
from tests.tracker.plant import BLANK, READY, Plant
from tests.tracker.scripted import Scripted


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
