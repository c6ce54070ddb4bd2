"""A PLC that acknowledges a command and does not take it: what it holds is read back, and told."""

from collections.abc import Callable
from contextlib import suppress

import pytest

from app.base.clock import VirtualClock
from app.drives.dialects.plc import PlcDrive
from app.drives.drive import Drive
from app.drives.profile import load_profile
from app.modbus.bus import Bus, BusUnit, Priority
from app.modbus.wire import Ask, Timing
from app.simulation.faults import Fault, FaultKind
from app.simulation.sim_plc import SimulatedPlc
from app.simulation.simulated import SimulatedDrive
from app.site.site import Site
from app.tracker.commands.commands import CommandRejected, Jog
from app.tracker.memory.memory import SiteState
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import TrackerConfig
from app.tracker.state.snapshot import ActivityName, EventKind
from tests.fault_result import BY_ITSELF, VIRTUAL, FaultResult
from tests.site.plant import FIRST, SUMMER_NOON, Plant

PROFILE = load_profile("simulated-plc")
NOTICED_WITHIN_S = 0.3
BEAT_S = 0.05
NOT_TAKEN = "acknowledged a command but did not carry it out"


def no_bus() -> Bus:
    raise AssertionError("nothing goes over a bus")


class AtOnce(BusUnit):
    """The way to a PLC without a wire between: every request is answered at once."""

    def __init__(self, plc: SimulatedPlc) -> None:
        super().__init__("bench", 1, Timing(), no_bus)
        self._plc = plc

    async def _submit(self, priority: Priority, ask: Ask, ticket: int | None, what: str) -> list[int]:
        if ask.words:
            self._plc.write_registers(ask.address, ask.words)
            return []
        return list(self._plc.read_registers(3, ask.address, ask.count))


def plant_with_plc() -> tuple[Plant, SimulatedDrive]:
    clock = VirtualClock(SUMMER_NOON)
    machine = SimulatedDrive(FIRST.config, clock)

    def make_drive(config: TrackerConfig) -> Drive:
        return PlcDrive(config, PROFILE, clock, AtOnce(SimulatedPlc(PROFILE, machine, clock)))

    return Plant(clock, Site(clock, make_drive, SiteState(), (FIRST,)), {}), machine


def not_taken(plant: Plant) -> list[str]:
    """Return what a user is shown of a command that was not taken."""
    return [notice.message for notice in plant.tracker().notices if NOT_TAKEN in notice.message]


async def held_until(plant: Plant, reached: Callable[[], bool], *, within_s: float) -> float:
    """Hold a jog until something is so, and return after how long it was."""
    begun, sequence = plant.clock.now(), 1
    while not reached():
        assert (plant.clock.now() - begun).total_seconds() < within_s, "not in time"
        await plant.forward(seconds=BEAT_S)
        sequence += 1
        with suppress(CommandRejected):
            await plant.ask(Jog("p1", Axis.AZIMUTH, 1, sequence=sequence))
    return (plant.clock.now() - begun).total_seconds()


@pytest.mark.fault(7)
async def test_a_command_that_is_acknowledged_and_not_taken_ends_the_jog(fault: FaultResult) -> None:
    plant, machine = plant_with_plc()
    await plant.start()
    await plant.forward(seconds=1)
    await plant.ask(Jog("p1", Axis.AZIMUTH, 1))
    await held_until(plant, lambda: plant.site.model.tracker("T1").moving, within_s=0.5)
    assert not not_taken(plant)

    machine.inject(Fault(FaultKind.IGNORED_WRITES))
    noticed_s = await held_until(plant, lambda: bool(not_taken(plant)), within_s=NOTICED_WITHIN_S)
    fault.noticed(noticed_s, VIRTUAL)
    fault.shows(not_taken(plant)[0])
    await held_until(plant, lambda: bool(plant.happened(EventKind.JOG_ENDED)), within_s=NOTICED_WITHIN_S)
    assert plant.tracker().activity is not ActivityName.JOGGING

    machine.end_injected_faults()
    await plant.forward(seconds=1)
    fault.recovers(BY_ITSELF)
    assert not not_taken(plant)
    await plant.ask(Jog("p2", Axis.AZIMUTH, 1))
    await plant.close()
