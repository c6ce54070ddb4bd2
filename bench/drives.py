"""Drives: a tick of the simulated drive, and Modbus polls with every check beside plain pymodbus"""

import asyncio
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Awaitable, Callable
from datetime import UTC, datetime, timedelta
from pathlib import Path

from pymodbus.client import AsyncModbusTcpClient

from app.clock import SystemClock, VirtualClock
from app.drives.bus import Bus
from app.drives.factory import DriveFactory
from app.drives.modbus_tcp import TcpWire
from app.drives.simulated import SimulatedDrive
from app.drives.wire import Timing
from app.tracker.config import DriveConfig, DriveKind, TrackerConfig
from app.tracker.motion import DriveCommand, Position
from bench.table import Row

COMMAND = "python -m bench drives"
POLLS = 300
ROUNDS = 10
REGISTERS = 40
SECONDS_A_DAY = 86_400
SERVER = """
import sys
from pathlib import Path
from app.drives.sim_server import Doors, run_drive_sim
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


async def _ticks_us(*, moving: bool) -> float:
    """Return microseconds a tick (read and write) over a day of one-second ticks."""
    clock = VirtualClock(datetime(2026, 6, 21, tzinfo=UTC))
    drive = SimulatedDrive(TrackerConfig("T1", "Bench"), clock, watchdog=None)
    second, command = timedelta(seconds=1), DriveCommand(Position(102.4, 6.0), Position(40.0, 4.0))
    begun = time.perf_counter()
    for tick in range(SECONDS_A_DAY):
        clock.advance(second)
        await drive.read()
        if moving or tick % 120 == 0:
            command = DriveCommand(Position(102.4 + tick * 0.003, 6.0), Position(40.0, 4.0))
        await drive.write(command)
    return (time.perf_counter() - begun) / SECONDS_A_DAY * 1e6


async def _times_us(poll: Poll) -> list[float]:
    times = []
    for _ in range(POLLS):
        begun = time.perf_counter()
        await poll()
        times.append((time.perf_counter() - begun) * 1e6)
    return times


async def _in_turns(ways: dict[str, Poll]) -> dict[str, list[float]]:
    """Return the times of each way to poll, measured in turns so that all see the same machine."""
    times: dict[str, list[float]] = {name: [] for name in ways}
    for _ in range(ROUNDS):
        for name, poll in ways.items():
            times[name] += await _times_us(poll)
    return times


async def _polls(port: int, *, with_drive: bool) -> dict[str, list[float]]:
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
    times = await _in_turns(ways | ({"drive": drive.read} if with_drive else {}))
    plain.close()
    await link.close()
    await drive.close()
    return times


def _against(server: str, *, with_drive: bool) -> dict[str, list[float]]:
    """Run a server in a process of its own and return what polling it takes."""
    with tempfile.TemporaryDirectory() as folder:
        process = subprocess.Popen(
            [sys.executable, "-c", server, str(Path(folder) / "sim.json")], stdout=subprocess.PIPE, text=True
        )
        assert process.stdout is not None
        try:
            port = int(process.stdout.readline().split("127.0.0.1:")[1].split(",")[0])
            return asyncio.run(_polls(port, with_drive=with_drive))
        finally:
            process.terminate()
            process.wait(10)
            process.stdout.close()


def _row(name: str, times: list[float], plain: list[float], target: str) -> Row:
    ours, peer = statistics.median(times), statistics.median(plain)
    slow, slow_peer = (statistics.quantiles(values, n=100)[98] for values in (times, plain))
    return Row(
        name,
        f"p50 {ours:.0f} us, p99 {slow:.0f} us",
        f"plain pymodbus p50 {peer:.0f} us, p99 {slow_peer:.0f} us",
        f"{ours / peer:.2f} (target at most {target})",
        COMMAND,
    )


def measure() -> list[Row]:
    """Return the rows of the report."""
    fixed, sim = _against(FIXED_SERVER, with_drive=False), _against(SERVER, with_drive=True)
    steady, moving = (asyncio.run(_ticks_us(moving=moving)) for moving in (False, True))
    return [
        _row("Modbus TCP master, 40 registers, a fixed reply", fixed["link"], fixed["pymodbus"], "1.25"),
        _row("Modbus TCP master, 40 registers of drive-sim", sim["link"], sim["pymodbus"], "1.25"),
        _row("Modbus drive: a reading, checked and decoded", sim["drive"], sim["pymodbus"], "2"),
        Row(
            "simulated drive, a tick while tracking",
            f"{steady:.1f} us",
            "5 us",
            f"{steady / 5.0:.2f}",
            COMMAND,
        ),
        Row("simulated drive, a tick with a new set-point", f"{moving:.1f} us", "-", "-", COMMAND),
    ]
