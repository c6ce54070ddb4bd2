"""Each shipped profile on the simulated device of its maker, behind a real socket."""

from collections.abc import AsyncIterator, Mapping
from contextlib import asynccontextmanager
from dataclasses import dataclass, replace
from datetime import timedelta
from pathlib import Path
from tempfile import TemporaryDirectory

from app.base.clock import VirtualClock
from app.drives.drive import Drive
from app.machine.drive_factory import DriveFactory
from app.modbus.pty_line import PtyLine
from app.modbus.rtu_server import RtuServer
from app.modbus.server import Device, ModbusServer
from app.simulation.devices.shelf import devices
from app.simulation.simulated import SimulatedDrive
from app.tracker.settings.config import AxisDrive, DriveConfig, DriveKind, SerialConfig
from tests.drives.rigs import CONFIG, FULL, START, Rig, Trait, pending_tasks

STEPPED = FULL - {Trait.BOOT_COUNT, Trait.CLOCK, Trait.WATCHDOG} | {Trait.STEPS}


@dataclass(frozen=True)
class Bench:
    """A profile, the gear that makes its steps even fractions of a degree, and what the drive has."""

    profile: str
    gear_ratio: float = 1.0
    traits: frozenset[Trait] = STEPPED
    speed_step_dps: float = 1e-6
    inverted: bool = False

    def turned_round(self) -> "Bench":
        return replace(self, inverted=True)

    @property
    def drive(self) -> DriveConfig:
        axis = AxisDrive(gear_ratio=self.gear_ratio, inverted=self.inverted)
        other = replace(axis, unit=2) if self.gear_ratio != 1.0 else axis
        return DriveConfig(DriveKind.MODBUS_TCP, self.profile, azimuth=axis, elevation=other)


BENCHES = {
    "kinco-cia402": Bench("kinco-cia402", 36.0, speed_step_dps=1e-4),
    "leadshine-rs": Bench("leadshine-rs", 36.0, speed_step_dps=0.0834),
    "oriental-az": Bench("oriental-az", 36.0, STEPPED - {Trait.SWITCHES}, speed_step_dps=0.005),
    "delta-dvp": Bench("delta-dvp", traits=FULL),
    "sunspec-601": Bench("sunspec-601", traits=frozenset()),
}


@asynccontextmanager
async def device_rig(bench: Bench, folder: Path | None = None) -> AsyncIterator[Rig]:
    """A drive made by its profile; `folder` is the data folder, for a profile of one's own."""
    clock = VirtualClock(START)
    factory = DriveFactory(clock, folder)
    machine, found = _served(bench, factory, clock)
    server = ModbusServer(found[1], 1, others=found)
    port = await server.start("127.0.0.1", 0)
    drive = factory.make(replace(CONFIG, drive=replace(bench.drive, port=port)))
    async with _ended(drive, server):
        yield Rig(drive, machine, clock, bench.traits, bench.speed_step_dps, found)


@asynccontextmanager
async def serial_device_rig(bench: Bench) -> AsyncIterator[Rig]:
    """The same on a serial line that is a pseudo-terminal."""
    clock = VirtualClock(START)
    factory = DriveFactory(clock)
    machine, found = _served(bench, factory, clock)
    with TemporaryDirectory() as name:
        path = Path(name) / "line"
        server = RtuServer(found, PtyLine(path))
        await server.start()
        wiring = replace(bench.drive, kind=DriveKind.MODBUS_RTU, serial=SerialConfig(str(path), 115_200))
        drive = factory.make(replace(CONFIG, drive=wiring))
        async with _ended(drive, server):
            yield Rig(drive, machine, clock, bench.traits, bench.speed_step_dps, found)


def _served(
    bench: Bench, factory: DriveFactory, clock: VirtualClock
) -> tuple[SimulatedDrive, Mapping[int, Device]]:
    """Return the machine and the devices of its maker in front of it, by unit id."""
    watchdog = timedelta(milliseconds=500) if Trait.WATCHDOG in bench.traits else None
    machine = SimulatedDrive(CONFIG, clock, watchdog=watchdog)
    return machine, devices(factory.profiles.load(bench.profile), machine, clock, 1, bench.gear_ratio)


@asynccontextmanager
async def _ended(drive: Drive, server: ModbusServer | RtuServer) -> AsyncIterator[None]:
    """Close both at the end, and let nothing be left of them."""
    try:
        yield
    finally:
        await drive.close()
        await server.close()
        assert not pending_tasks(), "a closed drive leaves no task behind"
