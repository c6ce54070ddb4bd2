"""The simulated drive as a process of its own, on a real socket and in real time."""

import asyncio
import signal
import sys
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass, replace
from datetime import timedelta
from pathlib import Path

from app.base.clock import SystemClock
from app.drives.dialects.plc import PlcDrive
from app.machine.drive_factory import DriveFactory
from app.tracker.settings.config import DriveConfig, DriveKind
from app.tracker.values.motion import DriveCommand, DriveRequest, Feedback, RequestKind, Velocity
from tests.drives.rigs import CONFIG

PROGRAM = """
import sys
from pathlib import Path
from app.simulation.servers.sim_server import Doors, run_drive_sim
run_drive_sim(Doors("127.0.0.1:0"), "simulated-plc", memory=Path(sys.argv[1]), inject=sys.argv[2:])
"""


@dataclass
class Running:
    process: asyncio.subprocess.Process
    drive: PlcDrive

    async def forward(self, seconds: float, command: DriveCommand) -> Feedback:
        clock = SystemClock()
        end = clock.now() + timedelta(seconds=seconds)
        while clock.now() < end:
            feedback = await self.drive.read()
            await self.drive.write(command)
            await asyncio.sleep(0.05)
        return feedback

    async def end(self, number: signal.Signals) -> int:
        self.process.send_signal(number)
        return await asyncio.wait_for(self.process.wait(), 10.0)


@asynccontextmanager
async def running(memory: Path, *inject: str) -> AsyncIterator[Running]:
    process = await asyncio.create_subprocess_exec(
        sys.executable, "-c", PROGRAM, str(memory), *inject, stdout=asyncio.subprocess.PIPE
    )
    assert process.stdout is not None
    line = (await asyncio.wait_for(process.stdout.readline(), 20.0)).decode()
    port = int(line.split("127.0.0.1:")[1].split(",")[0])
    config = replace(CONFIG, drive=DriveConfig(DriveKind.MODBUS_TCP, port=port))
    drive = DriveFactory(SystemClock()).make(config)
    assert isinstance(drive, PlcDrive)
    try:
        yield Running(process, drive)
    finally:
        await drive.close()
        if process.returncode is None:
            process.kill()
            await process.wait()


async def test_the_watchdog_stops_a_drive_whose_master_is_frozen(tmp_path: Path) -> None:
    async with running(tmp_path / "sim.json") as sim:
        before = await sim.forward(0.6, DriveCommand(azimuth=Velocity(3.0)))
        assert before.azimuth.moving
        await asyncio.sleep(1.2)
        feedback = await sim.drive.read()
        assert feedback.watchdog_tripped
        assert not feedback.azimuth.moving
        way_deg = feedback.azimuth.position_deg - before.azimuth.position_deg
        assert way_deg < 3.0 * (0.5 + 0.3) + 0.75


async def test_an_orderly_end_keeps_the_zero_and_a_kill_in_motion_loses_it(tmp_path: Path) -> None:
    memory = tmp_path / "sim.json"
    async with running(memory) as sim:
        for number, kind in ((1, RequestKind.SET_HOME_AZIMUTH), (2, RequestKind.SET_HOME_ELEVATION)):
            await sim.forward(0.15, DriveCommand(request=DriveRequest(number, kind)))
        await sim.forward(0.4, DriveCommand(azimuth=Velocity(3.0)))
        assert await sim.end(signal.SIGTERM) == 0
    async with running(memory) as sim:
        feedback = await sim.drive.read()
        assert (feedback.boot_count, feedback.azimuth.homed, feedback.elevation.homed) == (1, True, True)
        assert 0.3 < feedback.azimuth.position_deg < 3.0
        await sim.forward(0.4, DriveCommand(azimuth=Velocity(3.0)))
        await sim.end(signal.SIGKILL)
    async with running(memory) as sim:
        feedback = await sim.drive.read()
        assert (feedback.boot_count, feedback.azimuth.homed) == (2, False)


async def test_faults_can_be_given_at_the_start(tmp_path: Path) -> None:
    async with running(tmp_path / "sim.json", "drive_fault::12", "stall:azimuth") as sim:
        assert (await sim.drive.read()).fault_code == 12
