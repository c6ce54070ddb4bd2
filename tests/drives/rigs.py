"""Drives on a virtual clock, each with the simulated machine behind it in reach of the test."""

import asyncio
from collections.abc import AsyncIterator, Callable, Mapping
from contextlib import asynccontextmanager
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime, timedelta
from enum import Enum, auto
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from app.base.clock import VirtualClock
from app.drives.drive import Drive
from app.drives.profile import load_profile
from app.machine.drive_factory import DriveFactory
from app.modbus.line import Line
from app.modbus.listening_line import ListeningLine
from app.modbus.pty_line import PtyLine
from app.modbus.rtu_server import RtuServer
from app.modbus.server import Device
from app.simulation.servers.sim_server import serve
from app.simulation.sim_plc import SimulatedPlc
from app.simulation.simulated import SimulatedDrive
from app.tracker.settings.config import DriveConfig, DriveKind, SerialConfig, TrackerConfig
from app.tracker.values.motion import DriveCommand, Feedback

START = datetime(2026, 6, 21, 4, 0, tzinfo=UTC)
TICK = timedelta(milliseconds=50)
STRIDE = timedelta(milliseconds=400)
CONFIG = TrackerConfig("T1", "Tracker 1")


class Trait(Enum):
    """What not every drive has."""

    BOOT_COUNT = auto()
    CLOCK = auto()
    FAULT_RESET = auto()
    SPEED = auto()
    STEPS = auto()
    SWITCHES = auto()
    WATCHDOG = auto()
    ZERO = auto()


FULL = frozenset(Trait) - {Trait.STEPS}


@dataclass
class Rig:
    """A drive as the controller sees it, the machine behind it, and the clock both live on."""

    drive: Drive
    machine: SimulatedDrive
    clock: VirtualClock
    traits: frozenset[Trait] = FULL
    speed_step_dps: float = 1e-6
    devices: Mapping[int, Device] = field(default_factory=dict)

    async def forward(
        self, seconds: float, command: DriveCommand | None = None, tick: timedelta = TICK
    ) -> Feedback:
        """Tick as the control loop does, read then write, and return the last reading."""
        end = self.clock.now() + timedelta(seconds=seconds)
        feedback = await self.drive.read()
        await self.drive.write(command or DriveCommand())
        while self.clock.now() < end:
            self.clock.advance(tick)
            feedback = await self.drive.read()
            await self.drive.write(command or DriveCommand())
        return feedback

    async def until_rest(self, command: DriveCommand | None = None, *, seconds: float = 200.0) -> Feedback:
        """Tick until neither axis moves nor homes."""
        end = self.clock.now() + timedelta(seconds=seconds)
        while self.clock.now() < end:
            feedback = await self.forward(STRIDE.total_seconds(), command, STRIDE)
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
    """The drive behind a real socket: master, TCP, server, registers. One's own profiles lie beside."""
    clock = VirtualClock(START)
    machine = SimulatedDrive(CONFIG, clock)
    factory = DriveFactory(clock, Path(__file__).parent)
    server, port = await serve("127.0.0.1", 0, factory.profiles.load(name), machine, clock)
    config = replace(CONFIG, drive=DriveConfig(DriveKind.MODBUS_TCP, name, port=port))
    drive = factory.make(config)
    try:
        yield Rig(drive, machine, clock)
    finally:
        await drive.close()
        await server.close()
        assert not pending_tasks(), "a closed drive leaves no task behind"


@asynccontextmanager
async def rtu_rig() -> AsyncIterator[Rig]:
    """The drive on a serial line that is a pseudo-terminal, beside another drive on the same line."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "line"
        wiring = DriveConfig(DriveKind.MODBUS_RTU, unit=7, serial=SerialConfig(str(path), 115_200))
        async with framed_rig(PtyLine(path), lambda: wiring) as rig:
            yield rig


@asynccontextmanager
async def gateway_rig() -> AsyncIterator[Rig]:
    """The drive behind a gateway that passes raw RTU frames on."""
    line = ListeningLine("127.0.0.1", 0)
    wiring = DriveConfig(DriveKind.MODBUS_RTU_OVER_TCP, unit=7)
    async with framed_rig(line, lambda: replace(wiring, port=line.port)) as rig:
        yield rig


@asynccontextmanager
async def framed_rig(line: Line, wiring: Callable[[], DriveConfig]) -> AsyncIterator[Rig]:
    """The drive as unit 7 on a line of RTU frames, beside another; the wiring is asked once it is open."""
    clock = VirtualClock(START)
    machine, other = SimulatedDrive(CONFIG, clock), SimulatedDrive(CONFIG, clock)
    profile = load_profile("simulated-plc")
    found = {7: SimulatedPlc(profile, machine, clock), 8: SimulatedPlc(profile, other, clock)}
    server = RtuServer(found, line)
    await server.start()
    drive = DriveFactory(clock).make(replace(CONFIG, drive=wiring()))
    try:
        yield Rig(drive, machine, clock)
    finally:
        await drive.close()
        await server.close()
        assert not pending_tasks(), "a closed drive leaves no task behind"


RIGS = {
    "simulated": simulated_rig,
    "modbus-tcp": modbus_rig,
    "modbus-rtu": rtu_rig,
    "modbus-rtu-over-tcp": gateway_rig,
    "modbus-tcp, another map": partial(modbus_rig, "other-map"),
}
