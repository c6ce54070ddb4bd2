"""The last change of a tracker's settings is undone by one order, and that by another."""

from dataclasses import replace

import pytest

from app.link.messages import (
    ConfigureTracker,
    RemoveTracker,
)
from app.link.settings_orders import LockSettings, UndoSettings
from app.tracker.commands.commands import CommandRejected
from app.tracker.settings.config import Orientation, TrackerConfig
from tests.site.plant import Plant, make_plant


def config(plant: Plant) -> TrackerConfig:
    return plant.site.model.tracker("T1").config


async def test_the_last_change_is_undone_and_redone(plant: Plant) -> None:
    first = config(plant)
    with pytest.raises(CommandRejected, match="no stored settings change to undo"):
        await plant.ask(UndoSettings("T1"))
    second = replace(first, deadband_deg=1.5, park=Orientation(90.0, 45.0))
    await plant.ask(ConfigureTracker(second))
    other_axis = replace(second, azimuth=replace(second.azimuth, maximum_deg=300.0))
    await plant.ask(ConfigureTracker(other_axis))
    await plant.ask(UndoSettings("T1"))
    assert config(plant) == second
    await plant.ask(UndoSettings("T1"))
    assert config(plant) == other_axis


async def test_locked_settings_are_not_undone_and_a_removed_tracker_leaves_nothing() -> None:
    plant = make_plant()
    await plant.start()
    await plant.ask(ConfigureTracker(replace(config(plant), deadband_deg=1.5)))
    await plant.ask(LockSettings("T1"))
    with pytest.raises(CommandRejected, match="locked"):
        await plant.ask(UndoSettings("T1"))
    assert config(plant).deadband_deg == 1.5
    await plant.close()
    plant = make_plant()
    await plant.start()
    await plant.ask(ConfigureTracker(replace(config(plant), deadband_deg=1.5)))
    await plant.ask(RemoveTracker("T1"))
    assert plant.site.model.state.former == {}
    await plant.close()
