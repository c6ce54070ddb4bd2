"""A whole drive behind a proxy: every fault, one after the other, while the axes turn.

A lost reply is noticed after the profile's time-out; from then on the drive is found again as promised.
"""

import asyncio
from dataclasses import dataclass, replace

import pytest

from app.base.clock import VirtualClock
from app.drives.drive import Drive
from app.drives.profile import load_profile
from app.machine.drive_factory import DriveFactory
from app.modbus.errors import DriveError
from app.simulation.sim_plc import SimulatedPlc
from app.simulation.simulated import SimulatedDrive
from app.tracker.values.motion import AxisFeedback, DriveCommand, Feedback, Velocity
from tests.drives.conformance import is_moving
from tests.drives.proxied import BENCHES
from tests.drives.rigs import CONFIG, START, TICK
from tests.drives.test_fault_proxy import RECOVERED_WITHIN_S, faults

UNIT = 9
MOST_TICKS = 12
PROFILE = load_profile("simulated-plc")
CREEPING = DriveCommand(Velocity(0.5), Velocity(-0.5))


@dataclass
class Tracked:
    """A drive that is ticked, and every reading of it held to the machine behind it."""

    drive: Drive
    machine: SimulatedDrive
    clock: VirtualClock

    async def tick(self, command: DriveCommand) -> Feedback | None:
        """Read and command once; None if the drive could not be read or commanded."""
        self.clock.advance(TICK)
        try:
            feedback = await self.drive.read()
            for axis, true in zip(axes(feedback), axes(await self.machine.read()), strict=True):
                assert axis.position_deg == pytest.approx(true.position_deg, abs=1e-6), "an old value"
                assert axis.moving == true.moving
            await self.drive.write(command)
        except DriveError:
            return None
        return feedback

    async def recover(self) -> float:
        """Tick until the drive is read and commanded again, and return how long that took."""
        loop = asyncio.get_running_loop()
        began_s = loop.time()
        for _ in range(MOST_TICKS):
            if await self.tick(CREEPING) is not None:
                return loop.time() - began_s
        raise AssertionError(f"not found again within {MOST_TICKS} ticks")


def axes(seen: Feedback) -> tuple[AxisFeedback, AxisFeedback]:
    return seen.azimuth, seen.elevation


@pytest.mark.parametrize("wire", BENCHES)
async def test_a_turning_drive_is_never_misread_and_is_found_again(wire: str) -> None:
    clock = VirtualClock(START)
    machine = SimulatedDrive(CONFIG, clock)
    others = {UNIT: SimulatedPlc(PROFILE, machine, clock)}
    async with BENCHES[wire](others) as bench:
        drive = DriveFactory(clock).make(replace(CONFIG, drive=replace(bench.config, unit=UNIT)))
        tracked = Tracked(drive, machine, clock)
        await tracked.recover()
        for fault in faults(wire):
            bench.proxy.play(f"{fault} 1")
            asked = bench.proxy.requests
            took_s = [await tracked.recover() for _ in range(2)]
            assert bench.proxy.requests > asked
            assert took_s[0] < PROFILE.timeout_ms / 1000.0 + RECOVERED_WITHIN_S[wire], fault
            assert took_s[1] < RECOVERED_WITHIN_S[wire], fault
        feedback = await tracked.tick(CREEPING)
        assert feedback is not None
        assert is_moving(feedback), "the drive obeys again"
        bench.proxy.play("clear")
        await drive.stop()
        clock.advance(TICK * 20)
        feedback = await tracked.tick(DriveCommand())
        assert feedback is not None
        assert not is_moving(feedback)
        await drive.close()
