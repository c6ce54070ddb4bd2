"""Changing a tracker while its disk is slow: what happens meanwhile is neither lost nor overwritten."""

import asyncio
from collections.abc import AsyncIterator, Callable
from dataclasses import replace
from datetime import timedelta
from pathlib import Path
from typing import TypeVar

import pytest

from app.link.messages import ConfigureTracker, ConfirmStep, Order, RemoveTracker, RenameSite, SetClock
from app.link.weather_orders import ReportWeather
from app.simulation.faults import Fault, FaultKind
from app.simulation.simulated import SimulatedDrive
from app.site.startup import begin
from app.store.engine import open_writer
from app.store.migrations import upgrade
from app.store.store import StoreFailed, Writer
from app.tracker.commands.commands import CommandRejected, SelectMode
from app.tracker.memory.memory import StepName, TrackerMemory, TrackerState
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.settings.transmission import LinearActuator, Point
from app.tracker.values.mode import Mode
from app.tracker.weather.weather import Weather
from tests.site.plant import FIRST, SUMMER_NOON, Begun, Plant, make_plant, settle
from tests.site.wrapped_drive import WrappedDrive, wrapped

T = TypeVar("T")


class SlowWriter:
    """Writes in order; `hold` keeps the answers back although the write is done, as a slow disk may."""

    def __init__(self, writer: Writer) -> None:
        self.writer = writer
        self.goes_on = asyncio.Event()
        self.goes_on.set()
        self.full = False

    async def call(self, work: Callable[[Writer], T]) -> T:
        if self.full:
            raise StoreFailed("The disk is full.")
        done = work(self.writer)
        await self.goes_on.wait()
        return done

    def post(self, work: Callable[[Writer], object]) -> bool:
        work(self.writer)
        return True


@pytest.fixture
async def slow(tmp_path: Path) -> AsyncIterator[tuple[Plant, SlowWriter]]:
    url = f"sqlite:///{tmp_path / 'heliopanel.db'}"
    upgrade(url)
    store = open_writer(url)
    writer = SlowWriter(store)
    beginning = begin(store, SUMMER_NOON, unclean_since=None)
    plant = make_plant(writer=writer, state=beginning.site, trackers=beginning.trackers)
    await plant.start()
    await plant.commission()
    yield plant, writer
    await plant.close()
    store.close()


def faster(config: TrackerConfig) -> TrackerConfig:
    return replace(config, azimuth=replace(config.azimuth, maximum_deg=350.0))


@pytest.mark.parametrize("change", [lambda config: replace(config, name="New"), faster])
async def test_a_latch_that_falls_while_the_configuration_is_stored_stays_fallen(
    slow: tuple[Plant, SlowWriter], change: Callable[[TrackerConfig], TrackerConfig]
) -> None:
    plant, writer = slow
    config = change(plant.site.model.tracker("T1").config)
    writer.goes_on.clear()
    changing = asyncio.create_task(plant.ask(ConfigureTracker(config)))
    await settle()
    drive = plant.drives["T1"]
    assert isinstance(drive, SimulatedDrive)
    drive.inject(Fault(FaultKind.ENCODER_JUMP, Axis.AZIMUTH, 12.0))
    await plant.forward(seconds=0.5)
    assert plant.site.model.tracker("T1").memory.home is None
    writer.goes_on.set()
    await changing

    (stored,) = writer.writer.trackers()
    assert stored.memory.home is None
    assert stored.config == config
    assert plant.site.model.tracker("T1").memory.home is None


async def test_a_tracker_that_was_removed_does_not_come_back(slow: tuple[Plant, SlowWriter]) -> None:
    plant, writer = slow
    writer.goes_on.clear()
    removing = asyncio.create_task(plant.ask(RemoveTracker("T1")))
    await settle()
    selecting = asyncio.create_task(plant.ask(SelectMode(Mode.FIXED, Orientation(10.0, 10.0))))
    await settle()
    writer.goes_on.set()
    await asyncio.gather(removing, selecting, return_exceptions=True)

    assert writer.writer.trackers() == []


async def test_wind_is_heard_while_a_setting_waits_for_the_disk(slow: tuple[Plant, SlowWriter]) -> None:
    plant, writer = slow
    writer.goes_on.clear()
    naming = asyncio.create_task(plant.site.execute(Order(RenameSite("Roof"), "technician")))
    await settle()
    await plant.ask(ReportWeather(Weather(wind_mps=28.0)), None)
    await plant.forward(seconds=0.2)
    assert not naming.done()
    assert plant.tracker().protection is not None
    writer.goes_on.set()
    await naming


async def test_an_orientation_where_the_panel_never_was_cannot_be_confirmed(
    slow: tuple[Plant, SlowWriter],
) -> None:
    plant, _ = slow
    await plant.ask(SelectMode(Mode.FIXED, Orientation(200.0, 50.0)))

    with pytest.raises(CommandRejected, match="not done"):
        await plant.ask(ConfirmStep("T1", StepName.MODE))


async def test_a_drive_that_hangs_keeps_no_other_from_its_clock(begun: Begun) -> None:
    second = TrackerState(TrackerConfig("T2", "Two"), TrackerMemory())
    plant = await begun(trackers=(FIRST, second), wrap=WrappedDrive)
    wrapped(plant, "T1").hangs = True
    shown = SUMMER_NOON + timedelta(hours=1)
    setting = asyncio.create_task(plant.site.execute(Order(SetClock("manual", shown), "technician")))
    await settle()

    drive = wrapped(plant, "T2").inner
    assert isinstance(drive, SimulatedDrive)
    assert drive.wall_clock == shown
    setting.cancel()
    await asyncio.gather(setting, return_exceptions=True)


async def test_another_actuator_is_another_zero(plant: Plant) -> None:
    await plant.commission()
    config = plant.site.model.tracker("T1").config
    lift = LinearActuator(Point(900.0, 0.0, 15.0), Point(132.5, 200.1), 0.0, 745.0, 385.0, 25.0)
    elevation = replace(config.elevation, actuator=lift)
    await plant.ask(ConfigureTracker(replace(config, elevation=elevation)))
    memory = plant.site.model.tracker("T1").memory
    assert (memory.home, memory.home_lost) == (None, "another actuator was configured.")
    assert memory.former_drive is None, "the drive is still the same"
