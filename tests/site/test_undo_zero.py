"""A home position that was set by mistake is undone: angles, trust and motion are as they were before."""

from collections.abc import AsyncIterator

import pytest

from app.tracker.commands.commands import CommandRejected, Move, SetHome, Step, UndoHome
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import Orientation
from app.tracker.state.snapshot import ActivityName, AxisState, EventKind, Snapshot
from tests.site.plant import Plant, make_plant


@pytest.fixture
async def plant() -> AsyncIterator[Plant]:
    made = make_plant()
    await made.start()
    await made.commission()
    await made.ask(Move(Orientation(102.4, 36.6)))
    await made.until(lambda seen: seen.in_position and seen.activity is ActivityName.HOLDING)
    yield made
    await made.close()


def angles(seen: Snapshot) -> tuple[float, float]:
    assert seen.measured is not None
    return round(seen.measured.azimuth_deg, 1), round(seen.measured.elevation_deg, 1)


async def set_here(plant: Plant) -> None:
    await plant.ask(SetHome())
    await plant.until(lambda seen: seen.activity is ActivityName.HOLDING and seen.homed)
    assert angles(plant.tracker()) == (0.0, 0.0)


async def test_undone_the_angles_and_who_set_it_are_those_before(plant: Plant) -> None:
    before = plant.tracker()
    assert angles(before) == (102.4, 36.6)
    await set_here(plant)
    assert plant.tracker().can_undo_home
    await plant.ask(UndoHome())
    await plant.forward(seconds=2.0)
    now = plant.tracker()
    assert angles(now) == (102.4, 36.6)
    assert (now.home, now.homed, now.fault) == (before.home, True, None)
    assert [event.actor for event in plant.happened(EventKind.HOME_POSITION_UNDONE)] == ["technician"]
    with pytest.raises(CommandRejected, match="no former home position"):
        await plant.ask(UndoHome())


async def test_the_panel_really_moves_from_the_former_home_position(plant: Plant) -> None:
    drive = plant.drives["T1"]
    await set_here(plant)
    await plant.ask(UndoHome())
    await plant.forward(seconds=1.0)
    await plant.ask(Move(Orientation(110.0, 40.0)))
    await plant.until(lambda seen: seen.in_position and seen.activity is ActivityName.HOLDING)
    assert angles(plant.tracker()) == (110.0, 40.0)
    read = await drive.read()
    assert read.azimuth.position_deg == pytest.approx(110.0 - 102.4, abs=0.1)
    assert read.elevation.position_deg == pytest.approx(40.0 - 36.6, abs=0.1)


async def test_the_next_home_position_counts_from_the_drive_again(plant: Plant) -> None:
    await set_here(plant)
    await plant.ask(UndoHome())
    await plant.forward(seconds=1.0)
    await set_here(plant)
    assert plant.site.model.tracker("T1").memory.home_shift.azimuth_deg == 0.0


async def test_what_has_moved_since_is_not_undone(plant: Plant) -> None:
    await set_here(plant)
    await plant.ask(Step(Axis.ELEVATION, 1.0))
    await plant.until(lambda seen: seen.activity is ActivityName.HOLDING and angles(seen) == (0.0, 1.0))
    assert not plant.tracker().can_undo_home
    with pytest.raises(CommandRejected, match="have moved since"):
        await plant.ask(UndoHome())
    assert angles(plant.tracker()) == (0.0, 1.0)


async def test_an_axis_that_was_not_homed_before_is_not_shown_as_homed_again(plant: Plant) -> None:
    await plant.ask(Step(Axis.AZIMUTH, 5.0))
    await plant.until(lambda seen: seen.activity is ActivityName.HOLDING)
    await set_here(plant)
    assert [axis.homed for axis in axes(plant)] == [True, True]
    await plant.ask(UndoHome())
    await plant.forward(seconds=1.0)
    assert not plant.tracker().homed
    assert [axis.homed for axis in axes(plant)] == [False, False]
    await set_here(plant)
    assert [axis.homed for axis in axes(plant)] == [True, True]


def axes(plant: Plant) -> list[AxisState]:
    seen = plant.tracker()
    return [axis for axis in (seen.azimuth, seen.elevation) if axis is not None]
