"""Drives whose registers hold what they cannot mean: no word of any register ends the loop or bars a stop."""

from collections.abc import Mapping
from contextlib import suppress

import pytest

from app.base.clock import VirtualClock
from app.drives.dialects.gearing import gearing_of
from app.drives.dialects.plc import PlcDrive
from app.drives.dialects.register_axis import RegisterAxis
from app.drives.dialects.two_axes import TwoAxisDrive
from app.drives.drive import Drive
from app.drives.profile import Profile, load_profile
from app.drives.unit import Unit
from app.modbus.bus import Priority
from app.simulation.devices.shelf import devices
from app.simulation.simulated import SimulatedDrive
from app.site.site import Site, SiteOptions
from app.tracker.commands.commands import CommandRejected, Jog, Stop
from app.tracker.memory.memory import SiteState, TrackerMemory, TrackerState
from app.tracker.settings.axes import Axis, JogSpeed
from app.tracker.settings.config import AxisDrive, TrackerConfig
from tests.amount import amount
from tests.drives.direct_link import DIALECTS, DirectLink
from tests.site.plant import SUMMER_NOON, Plant

GEAR_RATIO = 36.0
SENTINELS = amount(
    (0x0000_0000, 0x8000_0000, 0x7FC0_0000),
    (0x0000_0000, 0x0000_0001, 0x7FFF_FFFF, 0x8000_0000, 0x8000_0001, 0x7FC0_0000, 0xFFFF_FFFF),
)
"""Ends of the integers, and what a float that is no number looks like."""
PROFILES = ("kinco-cia402", "leadshine-rs", "oriental-az", "delta-dvp", "simulated-plc")
REGISTERS = [
    pytest.param(name, register.name, id=f"{name} {register.name}")
    for name in PROFILES
    for register in load_profile(name).registers.values()
]


class SpoiledLink(DirectLink):
    """A way on which some words are read otherwise than the device has them."""

    spoiled: Mapping[int, int] = {}

    def __str__(self) -> str:
        return "10.0.0.8:502 unit 1"

    async def read(
        self, address: int, count: int, *, what: str, priority: Priority = Priority.POLL
    ) -> list[int]:
        words = await super().read(address, count, what=what, priority=priority)
        return [self.spoiled.get(address + place, word) for place, word in enumerate(words)]


def drive_of(config: TrackerConfig, profile: Profile, clock: VirtualClock) -> tuple[Drive, SpoiledLink]:
    """Return a drive, and the link to its azimuth."""
    found = devices(profile, SimulatedDrive(config, clock, watchdog=None), clock, 1, GEAR_RATIO)
    first = SpoiledLink(found[1])
    if not profile.adapter.has_unit_per_axis:
        return PlcDrive(config, profile, clock, first), first  # type: ignore[arg-type]
    axes: dict[Axis, RegisterAxis] = {}
    for axis, link in ((Axis.AZIMUTH, first), (Axis.ELEVATION, SpoiledLink(found[2]))):
        unit, own = Unit(profile, link, str(axis)), config.axis(axis)
        gearing = gearing_of(profile, AxisDrive(gear_ratio=GEAR_RATIO))
        axes[axis] = RegisterAxis(
            DIALECTS[profile.adapter](unit, gearing, own.acceleration_dps2), unit, gearing, own, clock
        )
    return TwoAxisDrive(config, profile, axes, clock, "here"), first


@pytest.mark.parametrize(("name", "register"), REGISTERS)
async def test_no_word_of_any_register_ends_the_loop(name: str, register: str) -> None:
    clock, profile = VirtualClock(SUMMER_NOON), load_profile(name)
    config = TrackerConfig("T1", "Tracker 1")
    drive, link = drive_of(config, profile, clock)
    state = TrackerState(config, TrackerMemory())
    plant = Plant(clock, Site(clock, lambda _: drive, SiteState(), (state,), options=SiteOptions()), {})
    await plant.start()
    loop = plant.site.model.tracker("T1")
    await plant.forward(seconds=0.5)
    assert loop.feedback is not None
    addresses = profile.registers[register].addresses
    every = {(value >> 16, value & 0xFFFF)[: len(addresses)]: value for value in SENTINELS}
    for turn, (words, value) in enumerate(every.items()):
        link.spoiled = dict(zip(addresses, words, strict=True))
        with suppress(CommandRejected):
            await plant.ask(Jog(f"press{turn}", Axis.AZIMUTH, 1, JogSpeed.FAST))
        await plant.forward(seconds=0.3)
        assert plant.site.alive, hex(value)
        assert loop.broken is None, hex(value)
        await plant.ask(Stop())
        assert await loop.stop_drive()
        link.spoiled = {}
        await plant.forward(seconds=0.7)
        assert loop.trouble is None, loop.trouble
        assert loop.broken is None, hex(value)
    await plant.close()
