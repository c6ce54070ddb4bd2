"""Drives on a virtual clock, each with the simulated machine behind it in reach of the test."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from functools import partial
from pathlib import Path

from app.clock import VirtualClock
from app.drives.drive import Drive
from app.drives.factory import DriveFactory
from app.drives.profile import load_profile
from app.drives.sim_server import serve
from app.drives.simulated import SimulatedDrive
from app.tracker.config import DriveConfig, DriveKind, TrackerConfig
from app.tracker.motion import DriveCommand, Feedback

START = datetime(2026, 6, 21, 4, 0, tzinfo=UTC)
TICK = timedelta(milliseconds=50)
CONFIG = TrackerConfig("T1", "Tracker 1")


@dataclass
class Rig:
    """A drive as the controller sees it, the machine behind it, and the clock both live on."""

    drive: Drive
    machine: SimulatedDrive
    clock: VirtualClock

    async def forward(self, seconds: float, command: DriveCommand | None = None) -> Feedback:
        """Tick as the control loop does, read then write, and return the last reading."""
        end = self.clock.now() + timedelta(seconds=seconds)
        feedback = await self.drive.read()
        await self.drive.write(command or DriveCommand())
        while self.clock.now() < end:
            self.clock.advance(TICK)
            feedback = await self.drive.read()
            await self.drive.write(command or DriveCommand())
        return feedback

    async def until_rest(self, command: DriveCommand | None = None, *, seconds: float = 200.0) -> Feedback:
        """Tick until neither axis moves nor homes."""
        end = self.clock.now() + timedelta(seconds=seconds)
        while self.clock.now() < end:
            feedback = await self.forward(TICK.total_seconds(), command)
            if not (feedback.azimuth.moving or feedback.elevation.moving or feedback.homing):
                return feedback
        raise AssertionError(f"the axes did not come to rest within {seconds} s")

    def idle(self, seconds: float) -> None:
        """Let time pass without anybody reading or writing."""
        self.clock.advance(timedelta(seconds=seconds))


def pending_tasks() -> set["asyncio.Task[object]"]:
    """Return the tasks that are still there beside the caller's."""
    return {task for task in asyncio.all_tasks() if task is not asyncio.current_task()}


@asynccontextmanager
async def simulated_rig() -> AsyncIterator[Rig]:
    """The drive in this process."""
    clock = VirtualClock(START)
    machine = SimulatedDrive(CONFIG, clock)
    yield Rig(machine, machine, clock)
    await machine.close()


@asynccontextmanager
async def modbus_rig(name: str = "simulated-plc") -> AsyncIterator[Rig]:
    """The drive behind a real socket: master, TCP, server, registers."""
    clock = VirtualClock(START)
    machine = SimulatedDrive(CONFIG, clock)
    profile = load_profile(name)
    server, port = await serve("127.0.0.1", 0, profile, machine, clock)
    config = replace(CONFIG, drive=DriveConfig(DriveKind.MODBUS_TCP, name, port=port))
    drive = DriveFactory(clock).make(config)
    try:
        yield Rig(drive, machine, clock)
    finally:
        await drive.close()
        await server.close()
        assert not pending_tasks(), "a closed drive leaves no task behind"


RIGS = {
    "simulated": simulated_rig,
    "modbus-tcp": modbus_rig,
    "modbus-tcp, another map": partial(modbus_rig, str(Path(__file__).with_name("other-map.toml"))),
}
