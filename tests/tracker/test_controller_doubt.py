"""What is not known: nothing goes on, nothing is confirmed, and everything that ends says so."""

from dataclasses import replace

import pytest

from app.tracker.commands.commands import Command, Home, Move, Park, SelectMode, Track
from app.tracker.memory.memory import StepName
from app.tracker.settings.config import Orientation
from app.tracker.state.snapshot import ActivityName, EventKind
from app.tracker.values.mode import Mode
from app.tracker.values.motion import DriveCommand, Velocity
from tests.tracker.plant import Plant
from tests.tracker.scripted import Scripted

STANDSTILL = DriveCommand(Velocity(0.0), Velocity(0.0))


def test_a_drive_that_is_lost_while_it_searches_is_told_to_end_the_search(blank_script: Scripted) -> None:
    blank_script.ask(Home())
    blank_script.sees(homing=True)
    blank_script.forward(1.0)
    blank_script.reading = None
    blank_script.forward(1.0)
    assert blank_script.happened(EventKind.DRIVE_LOST)
    assert blank_script.told == STANDSTILL, "a halt alone lets the search go on"


@pytest.mark.parametrize(
    ("homed", "moved_deg", "boots", "code", "words"),
    [
        (True, 0.0, 0, "drive_back", "reports no restart"),
        (True, 3.0, 0, "drive_elsewhere", "position has changed"),
        (False, 0.0, 0, "drive_restarted", "has restarted and has lost its home reference"),
        (True, 0.0, 1, "drive_restarted", "has restarted."),
    ],
)
def test_a_drive_that_answers_again_tells_what_can_be_known_and_no_more(
    script: Scripted, homed: bool, moved_deg: float, boots: int, code: str, words: str
) -> None:
    seen = script.reading
    assert seen is not None
    both = {axis: replace(getattr(seen, axis), homed=True) for axis in ("azimuth", "elevation")}
    script.reading = seen = replace(seen, **both)
    script.forward(0.5)
    script.reading = None
    script.forward(1.0)
    azimuth = replace(seen.azimuth, homed=homed, position_deg=seen.azimuth.position_deg + moved_deg)
    script.reading = replace(seen, azimuth=azimuth, boot_count=seen.boot_count + boots)
    script.forward(0.5)
    told = {notice.code: notice.message for notice in script.snapshot.notices}
    assert words in told[code]
    script.reading = None
    script.forward(1.0)
    assert code not in {notice.code for notice in script.snapshot.notices}, "it is gone again"


def test_an_old_reading_confirms_no_orientation(script: Scripted) -> None:
    script.reading = None
    script.forward(1.0)
    script.ask(SelectMode(Mode.FIXED, Orientation(0.0, 0.0)))
    assert StepName.MODE not in script.controller.memory.confirmations


def test_a_move_that_another_order_replaces_says_that_it_ended(plant: Plant) -> None:
    plant.ask(Move(Orientation(120.0, 40.0)))
    orders: tuple[Command, ...] = (Move(Orientation(60.0, 30.0)), Park(), Track())
    for number, order in enumerate(orders, start=1):
        plant.forward(1.0)
        plant.ask(order)
        ended = plant.happened(EventKind.MOVE_ENDED)
        assert [event.data["outcome"] for event in ended] == ["interrupted"] * number
    assert plant.activity is ActivityName.TRACKING
