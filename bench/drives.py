"""Drives: a tick of the simulated drive, and Modbus polls with every check beside plain pymodbus"""

import asyncio
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path

from pymodbus.client import AsyncModbusTcpClient

from app.base.clock import SystemClock, VirtualClock
from app.machine.drive_factory import DriveFactory
from app.modbus.bus import Bus
from app.modbus.tcp import TcpWire
from app.modbus.wire import Timing
from app.simulation.simulated import SimulatedDrive
from app.tracker.settings.config import DriveConfig, DriveKind, TrackerConfig
from app.tracker.values.motion import DriveCommand, Position
from bench.table import Row, alone, at_most, spread

COMMAND = "python -m bench drives"
REGISTERS = 40
TICK_BOUND_US = 5.0
MASTER_BOUND, DRIVE_BOUND = 1.25, 2.0
"""How many times as long as plain pymodbus a checked poll may take, and a reading that is decoded too."""
SERVER = """
import sys
from pathlib import Path
from app.simulation.servers.sim_server import Doors, run_drive_sim
run_drive_sim(Doors("127.0.0.1:0"), "simulated-plc", memory=Path(sys.argv[1]))
"""

FIXED_SERVER = """
import asyncio
import signal

class Fixed(asyncio.Protocol):
    def connection_made(self, transport):
        self.transport = transport
    def data_received(self, data):
        self.transport.write(data[:2] + BODY)

BODY = bytes((0, 0, 0, 83, 1, 3, 80)) + bytes(range(80))

async def main():
    loop = asyncio.get_running_loop()
    server = await loop.create_server(Fixed, "127.0.0.1", 0)
    print(f"on 127.0.0.1:{server.sockets[0].getsockname()[1]},", flush=True)
    ended = asyncio.Event()
    loop.add_signal_handler(signal.SIGTERM, ended.set)
    await ended.wait()

asyncio.run(main())
"""

Poll = Callable[[], Awaitable[object]]


async def _ticks_us(ticks: int, *, moving: bool) -> float:
    """Return microseconds a tick (read and write) over a day of one-second ticks."""
    clock = VirtualClock(datetime(2026, 6, 21, tzinfo=UTC))
    drive = SimulatedDrive(TrackerConfig("T1", "Bench"), clock, watchdog=None)
    second, command = timedelta(seconds=1), DriveCommand(Position(102.4, 6.0), Position(40.0, 4.0))
    begun = time.perf_counter()
    for tick in range(ticks):
        clock.advance(second)
        await drive.read()
        if moving or tick % 120 == 0:
            command = DriveCommand(Position(102.4 + tick * 0.003, 6.0), Position(40.0, 4.0))
        await drive.write(command)
    return (time.perf_counter() - begun) / ticks * 1e6


async def _times_us(poll: Poll, polls: int) -> list[float]:
    times = []
    for _ in range(polls):
        begun = time.perf_counter()
        await poll()
        times.append((time.perf_counter() - begun) * 1e6)
    return times


async def _in_turns(ways: dict[str, Poll], size: "Size") -> dict[str, list[float]]:
    """Return the times of each way to poll, measured in turns so that all see the same machine."""
    times: dict[str, list[float]] = {name: [] for name in ways}
    for _ in range(size.rounds):
        for name, poll in ways.items():
            times[name] += await _times_us(poll, size.polls)
    return times


async def _polls(port: int, size: "Size", *, with_drive: bool) -> dict[str, list[float]]:
    clock = SystemClock()
    plain = AsyncModbusTcpClient("127.0.0.1", port=port, timeout=0.3, retries=0, reconnect_delay=0)
    await plain.connect()
    link = Bus("bench", TcpWire("127.0.0.1", port), clock).unit(1, Timing())
    config = TrackerConfig("T1", "Bench", drive=DriveConfig(DriveKind.MODBUS_TCP, port=port))
    drive = DriveFactory(clock).make(config)
    ways: dict[str, Poll] = {
        "pymodbus": lambda: plain.read_holding_registers(0, count=REGISTERS, device_id=1),
        "link": lambda: link.read(0, REGISTERS, what="bench"),
    }
    times = await _in_turns(ways | ({"drive": drive.read} if with_drive else {}), size)
    plain.close()
    await link.close()
    await drive.close()
    return times


def _against(server: str, size: "Size", *, with_drive: bool) -> dict[str, list[float]]:
    """Run a server in a process of its own and return what polling it takes."""
    with tempfile.TemporaryDirectory() as folder:
        process = subprocess.Popen(
            [sys.executable, "-c", server, str(Path(folder) / "sim.json")], stdout=subprocess.PIPE, text=True
        )
        assert process.stdout is not None
        try:
            port = int(process.stdout.readline().split("127.0.0.1:")[1].split(",")[0])
            return asyncio.run(_polls(port, size, with_drive=with_drive))
        finally:
            process.terminate()
            process.wait(10)
            process.stdout.close()


def _row(name: str, times: list[float], plain: list[float], most: float) -> Row:
    """Return how much longer than plain pymodbus of the same run a poll takes, against its bound."""
    share = statistics.median(times) / statistics.median(plain)
    told = f"{share:.2f} ({spread(times, 'us')}; plain pymodbus {spread(plain, 'us')})"
    return at_most(f"{name}, median, in times of plain pymodbus", share, most, "", COMMAND, ours=told)


@dataclass(frozen=True, slots=True)
class Size:
    """How many polls a round and how many rounds, and how many ticks of the simulated drive."""

    polls: int = 300
    rounds: int = 10
    ticks: int = 86_400


SMALL = Size(polls=3, rounds=1, ticks=120)


def measure(size: Size = Size()) -> list[Row]:
    """Return the rows of the report."""
    fixed, sim = _against(FIXED_SERVER, size, with_drive=False), _against(SERVER, size, with_drive=True)
    steady, moving = (asyncio.run(_ticks_us(size.ticks, moving=moving)) for moving in (False, True))
    return [
        _row(
            "Modbus TCP master, 40 registers, a fixed reply", fixed["link"], fixed["pymodbus"], MASTER_BOUND
        ),
        _row("Modbus TCP master, 40 registers of drive-sim", sim["link"], sim["pymodbus"], MASTER_BOUND),
        _row("Modbus drive: a reading, checked and decoded", sim["drive"], sim["pymodbus"], DRIVE_BOUND),
        at_most("simulated drive, a tick while tracking", steady, TICK_BOUND_US, "us", COMMAND),
        alone("simulated drive, a tick with a new setpoint", f"{moving:.1f} us", COMMAND),
    ]
