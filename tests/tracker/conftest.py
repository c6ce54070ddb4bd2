"""Trackers that most stories begin with: at rest, heard once."""

import pytest

from tests.tracker.plant import READY, Plant
from tests.tracker.scripted import Scripted


@pytest.fixture
def plant() -> Plant:
    """Return a homed tracker in its commissioned mode."""
    plant = Plant(READY)
    plant.tick()
    return plant


@pytest.fixture
def blank() -> Plant:
    """Return a tracker that was never homed nor commissioned."""
    plant = Plant()
    plant.tick()
    return plant


@pytest.fixture
def script() -> Scripted:
    """Return a homed tracker whose readings the story writes down."""
    script = Scripted(READY)
    script.tick()
    return script


@pytest.fixture
def blank_script() -> Scripted:
    """Return one that was never homed."""
    script = Scripted()
    script.tick()
    return script
