"""Forbidden regions: no way leads through them, whoever asks and however the axes start."""

from dataclasses import replace
from random import Random

import pytest

from app.tracker.commands.commands import Command, CommandRejected, Jog, Move, Step
from app.tracker.settings.axes import Axis, JogSpeed
from app.tracker.settings.config import Orientation
from app.tracker.settings.mechanics import Corner, MachineProtection, Region
from app.tracker.state.snapshot import ActivityName, EventKind
from app.tracker.supervision.regions import Span, touches
from tests.fault_result import FaultResult
from tests.tracker.plant import CONFIG, READY, Plant

CORNERS = ((40.0, 10.0), (70.0, 10.0), (70.0, 50.0), (55.0, 60.0), (40.0, 50.0))
WALL = Region("wall", tuple(Corner(*corner) for corner in CORNERS))
WALLED = replace(CONFIG, machine=MachineProtection(regions=(WALL,)))


@pytest.fixture
def plant() -> Plant:
    plant = Plant(READY, config=WALLED)
    plant.tick()
    return plant


def is_in(plant: Plant) -> bool:
    azimuth_deg, elevation_deg = plant.azimuth_deg, plant.elevation_deg
    return touches(WALL, Span(azimuth_deg, azimuth_deg), Span(elevation_deg, elevation_deg))


def takes(plant: Plant, command: Command) -> bool:
    """Return whether a command was taken."""
    try:
        plant.ask(command)
    except CommandRejected:
        return False
    return True


@pytest.mark.fault(25)
def test_no_random_move_enters_the_region(plant: Plant) -> None:
    chance = Random(25)
    refused = 0
    for _ in range(20):
        place = Orientation(chance.uniform(0.0, 120.0), chance.uniform(0.0, 90.0))
        refused += not takes(plant, Move(place))
        for _ in range(chance.choice([5, 20, 100])):
            plant.forward(0.1)
            assert not is_in(plant)
    assert 2 < refused < 18, "some ways are free and some are not"


@pytest.mark.fault(25)
def test_a_held_key_and_steps_end_before_the_region(plant: Plant, fault: FaultResult) -> None:
    plant.ask(Move(Orientation(0.0, 30.0)))
    plant.forward(20.0)
    beat = 1
    while takes(plant, Jog("press", Axis.AZIMUTH, 1, JogSpeed.FAST, beat)) and beat < 300:
        beat += 1
        plant.forward(0.1)
        assert not is_in(plant)
    plant.forward(2.0)
    stood_deg = plant.azimuth_deg
    assert 30.0 < stood_deg < 40.0
    assert plant.happened(EventKind.LIMIT_REACHED)[-1].data["region"] == "wall"
    plant.ask(Step(Axis.AZIMUTH, 5.0))
    plant.forward(4.0)
    assert plant.azimuth_deg == pytest.approx(stood_deg, abs=0.05)
    assert plant.activity is ActivityName.HOLDING
    fault.prevented("the motion is refused, or ends before the region")
    fault.shows(plant.happened(EventKind.LIMIT_REACHED)[-1].message)
    plant.ask(Step(Axis.AZIMUTH, -5.0))
    plant.forward(4.0)
    assert plant.azimuth_deg < stood_deg - 4.0
    fault.recovers("the axis leaves, the way that it came")
