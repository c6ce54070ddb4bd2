"""Details of trackers: kept while nothing changes, and never older than what they are made of."""

import asyncio
from collections.abc import AsyncIterator, Callable
from dataclasses import replace
from datetime import timedelta

import pytest

from app.drives.drive import Drive
from app.link.messages import (
    AddTracker,
    ConfigureTracker,
    ConfirmStep,
    RemoveTracker,
    SetLocation,
    TrackerDetail,
)
from app.modbus.errors import DriveSilent
from app.site.clock.timekeeping import Timekeeper
from app.site.publishing.details import MOST_AT_ONCE, Details
from app.sun.position import Location
from app.tracker.commands.commands import SelectMode, Stop, Track
from app.tracker.memory.drive_check import CheckOutcome, DriveCheck, DriveReadings
from app.tracker.memory.memory import ClockSetting, StepName, TrackerMemory, TrackerState
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.values.mode import Mode
from app.tracker.values.motion import Feedback
from tests.site.plant import Plant, make_plant
from tests.site.wrapped_drive import WrappedDrive, wrapped


def field_of(count: int, wrap: Callable[[Drive], Drive] = lambda drive: drive) -> Plant:
    configs = (TrackerConfig(f"T{number}", "Tracker") for number in range(1, count + 1))
    return make_plant(trackers=tuple(TrackerState(one, TrackerMemory()) for one in configs), wrap=wrap)


@pytest.fixture
async def plant() -> AsyncIterator[Plant]:
    made = field_of(3)
    await made.start()
    yield made
    await made.close()


async def changed(plant: Plant, before: dict[str, TrackerDetail]) -> set[str]:
    """Return whose details are other objects than before; all of them are as if they were made now."""
    now = (await plant.site.detail()).trackers
    assert now == await Details(plant.site.model).all()
    different = {name for name, one in now.items() if before.get(name) is not one}
    before.clear()
    before.update(now)
    return different


async def test_what_has_not_changed_is_the_same_object(plant: Plant) -> None:
    known: dict[str, TrackerDetail] = {}
    everybody = {"T2", "T1", "T3"}
    assert await changed(plant, known) == everybody
    assert not await changed(plant, known)
    await plant.commission("T1")
    assert await changed(plant, known) == everybody
    await plant.forward(seconds=30.0)
    assert not await changed(plant, known)
    await plant.ask(SelectMode(Mode.DUAL, Orientation(180.0, 45.0)), "T1")
    assert await changed(plant, known) == {"T1"}
    await plant.forward(seconds=1.0)
    await plant.ask(ConfirmStep("T1", StepName.MODE))
    assert await changed(plant, known) == {"T1"}
    await plant.ask(Track(), "T1")
    await plant.forward(seconds=120.0)
    assert await changed(plant, known) == {"T1"}
    await plant.forward(seconds=60.0)
    assert not await changed(plant, known)
    await plant.ask(Stop(), "T1")
    assert await changed(plant, known) == {"T1"}
    await plant.ask(ConfigureTracker(replace(plant.site.model.tracker("T3").config, name="Other")))
    assert await changed(plant, known) == {"T3"}
    third = plant.site.model.tracker("T3")
    third.controller.configure(replace(third.config, name="Third"), third.drive.capabilities)
    assert await changed(plant, known) == {"T3"}
    await plant.ask(SetLocation(Location(10.0, 20.0), "UTC"))
    assert await changed(plant, known) == everybody
    await plant.ask(AddTracker(TrackerConfig("T9", "New")))
    assert await changed(plant, known) == {"T9"}
    await plant.ask(RemoveTracker("T2"))
    assert not await changed(plant, known)
    assert list(known) == ["T1", "T3", "T9"]


async def test_a_test_of_the_connection_and_a_doubt_about_the_clock_are_told(plant: Plant) -> None:
    known: dict[str, TrackerDetail] = {}
    await changed(plant, known)
    drive = plant.site.model.tracker("T1").config.drive
    readings = DriveReadings(CheckOutcome.ANSWERED, "It answers.")
    plant.site.model.checks.keep("T1", DriveCheck(drive, plant.clock.now(), "technician", readings))
    assert await changed(plant, known) == {"T1"}
    drift = [timedelta(0)]
    keeper = Timekeeper(plant.clock, ClockSetting("system"), drift=lambda: drift[0])
    plant.site.model.timekeeper = keeper
    plant.site.model.state = replace(plant.site.model.state, clock=ClockSetting("system"))
    await changed(plant, known)
    drift[0] = timedelta(hours=1)
    keeper.watch()
    assert len(await changed(plant, known)) == 3


class FallingSilent(WrappedDrive):
    """Answers no reading while it is told to hang."""

    async def read(self) -> Feedback:
        if self.hangs:
            raise DriveSilent("It is silent.")
        return await self.inner.read()


async def test_a_drive_that_falls_silent_is_told() -> None:
    plant = field_of(2, wrap=FallingSilent)
    await plant.start()
    await plant.commission("T1")
    known: dict[str, TrackerDetail] = {}
    await changed(plant, known)
    wrapped(plant, "T1").hangs = True
    await plant.forward(seconds=0.2)
    try:
        assert await changed(plant, known) == {"T1"}
    finally:
        await plant.close()


async def test_a_field_lets_everything_else_have_its_turn_meanwhile() -> None:
    plant = field_of(3 * MOST_AT_ONCE)
    await plant.start()
    asking, turns = asyncio.create_task(plant.site.detail()), 0
    while not asking.done():
        await asyncio.sleep(0)
        turns += 1
    assert turns > 3
    await plant.close()
