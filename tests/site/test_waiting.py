"""A drive that never answers: what is set for the site waits for none of it."""

import asyncio
from dataclasses import replace
from datetime import datetime

import pytest

from app.base.clock import VirtualClock
from app.drives.dialects.plc import PlcDrive
from app.drives.profile import load_profile
from app.link.messages import (
    ConfigureTracker,
    EndInjectedFaults,
    InjectFault,
    Order,
    RemoveTracker,
    RenameSite,
    SetClock,
    SiteCommand,
)
from app.link.weather_orders import SetMetStation
from app.modbus.bus import Bus
from app.modbus.wire import Ask, Timing, Unanswered
from app.tracker.commands.commands import CommandRejected
from app.tracker.memory.memory import MetStation
from app.tracker.settings.config import AxisDrive, TrackerConfig
from app.tracker.values.motion import DriveCapabilities, DriveCommand, Feedback
from tests.site.plant import SUMMER_NOON, Plant, make_plant, settle

WELL_BELOW_S = 2.5
"""The panel gives an order 5 s; another one in front of it takes at most half of that."""


class Mute:
    """A drive that answers nothing at all, for ever."""

    capabilities = DriveCapabilities(True, None, True, True, "", True)

    async def read(self) -> Feedback:
        return await asyncio.Event().wait()  # type: ignore[return-value]

    async def write(self, command: DriveCommand) -> None:
        await asyncio.Event().wait()

    async def stop(self) -> None:
        await asyncio.Event().wait()

    async def set_clock(self, at: datetime) -> None:
        await asyncio.Event().wait()

    async def close(self) -> None:
        await asyncio.Event().wait()


class MuteWire:
    """A line on which nothing answers; like pymodbus on Python 3.11 it may swallow one cancellation."""

    connected, advice = True, "Check the cable."

    def __init__(self, swallows: int = 0) -> None:
        self.swallows = swallows
        self.asked = 0

    def epoch(self, unit: int) -> int:
        return 1

    async def connect(self) -> bool:
        return True

    async def exchange(self, ask: Ask, timing: Timing, *, urgent: bool) -> list[int]:
        self.asked += 1
        try:
            await asyncio.sleep(0.05)
        except asyncio.CancelledError:
            if not self.swallows:
                raise
            self.swallows -= 1
        raise Unanswered

    def hurry(self) -> None:
        pass

    def close(self) -> None:
        pass


def order(command: SiteCommand) -> Order:
    return Order(command, "technician")


async def named(plant: Plant, name: str) -> None:
    async with asyncio.timeout(WELL_BELOW_S):
        await plant.site.execute(order(RenameSite(name)))
    assert plant.site.model.state.name == name


def another_drive(config: TrackerConfig) -> TrackerConfig:
    return replace(config, drive=replace(config.drive, azimuth=AxisDrive(gear_ratio=2.0)))


def waiting_orders(config: TrackerConfig) -> dict[str, SiteCommand]:
    return {
        "another drive": ConfigureTracker(another_drive(config)),
        "no tracker": RemoveTracker("T1"),
        "the clock": SetClock("system"),
        "a station": SetMetStation(MetStation("127.0.0.1", 9)),
    }


@pytest.mark.parametrize("name", waiting_orders(TrackerConfig("T1", "")))
async def test_an_order_that_needs_a_mute_drive_keeps_no_other_waiting(name: str) -> None:
    plant = make_plant(wrap=lambda drive: Mute())
    await plant.site.start()
    config = plant.site.model.tracker("T1").config
    waiting = asyncio.create_task(plant.site.execute(order(waiting_orders(config)[name])))
    await settle()
    await named(plant, "Field")
    async with asyncio.timeout(WELL_BELOW_S):
        await waiting
    await plant.site.close()


@pytest.mark.parametrize("command", [InjectFault("T1", "silence"), EndInjectedFaults("T1")])
async def test_a_fault_that_is_played_on_a_simulator_which_does_not_answer_keeps_no_order_waiting(
    command: SiteCommand,
) -> None:
    plant = make_plant()
    await plant.site.start()
    loop = plant.site.model.tracker("T1")
    bus = Bus("bench", MuteWire(), plant.clock)
    loop.drive = PlcDrive(loop.config, load_profile("simulated-plc"), plant.clock, bus.unit(1, Timing()))
    playing = asyncio.create_task(plant.site.execute(order(command)))
    await asyncio.sleep(0.2)
    await named(plant, "Field")
    assert not playing.done(), "it is tried for a while"
    for _ in range(20):
        await plant.forward(seconds=0.25)
        await asyncio.sleep(0.06)
    with pytest.raises(CommandRejected, match="refused this request"):
        await asyncio.wait_for(playing, WELL_BELOW_S)
    await plant.site.close()


@pytest.mark.parametrize("swallows", [0, 1])
async def test_a_bus_closes_although_a_cancellation_was_swallowed(swallows: int) -> None:
    wire = MuteWire(swallows)
    unit = Bus("bench", wire, VirtualClock(SUMMER_NOON)).unit(1, Timing())
    reading = asyncio.create_task(unit.read(0, 1, what="a word"))
    await asyncio.sleep(0.01)
    async with asyncio.timeout(1.0):
        await unit.close()
    assert wire.asked == 1
    assert wire.swallows == 0
    await asyncio.gather(reading, return_exceptions=True)
