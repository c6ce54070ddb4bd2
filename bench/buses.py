"""Many drives: 64 on Modbus TCP polled at 10 Hz, and 16 on two lines of 19200 baud at their line rate"""

import asyncio
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Awaitable, Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from math import inf
from pathlib import Path

from pymodbus.client import AsyncModbusSerialClient, AsyncModbusTcpClient
from pymodbus.exceptions import ModbusException

from app.clock import SystemClock
from app.drives.bus import Bus
from app.drives.buses import Buses
from app.drives.drive import DriveError
from app.drives.modbus_tcp import TcpWire
from app.drives.wire import Timing
from app.tracker.config import DriveConfig, DriveKind, SerialConfig
from bench.drives import FIXED_SERVER, REGISTERS
from bench.table import Row

COMMAND = "python -m bench buses"
DRIVES, PERIOD_S, SECONDS = 64, 0.1, 10.0
LINES, ON_A_LINE, BAUD_RATE = 2, 8, 19_200
REQUEST, REPLY = 8, 5 + 2 * REGISTERS
RAW_REQUEST = bytes((0, 1, 0, 0, 0, 6, 1, 3, 0, 0, 0, REGISTERS))

Poll = Callable[[], Awaitable[object]]


@dataclass(frozen=True)
class Load:
    """How long each poll took, and which share of one core they all took together."""

    times_ms: list[float]
    core: float
    seconds: float
    failures: int

    @property
    def p99_ms(self) -> float:
        return statistics.quantiles(self.times_ms, n=100)[98]

    def __str__(self) -> str:
        return (
            f"p50 {statistics.median(self.times_ms):.2f} ms, p99 {self.p99_ms:.2f} ms, "
            f"{self.core:.1%} of one core, {self.failures} of {len(self.times_ms) + self.failures} failed"
        )


async def _timed(poll: Poll, times_ms: list[float]) -> None:
    """Note how long a poll took, and one that failed as endless."""
    begun = time.perf_counter()
    try:
        await poll()
    except (DriveError, ModbusException):
        times_ms.append(inf)
        return
    times_ms.append((time.perf_counter() - begun) * 1e3)


async def _paced(poll: Poll, first_s: float, until_s: float, times_ms: list[float]) -> None:
    due_s = first_s
    while due_s < until_s:
        await asyncio.sleep(max(0.0, due_s - time.perf_counter()))
        await _timed(poll, times_ms)
        due_s += PERIOD_S


async def _back_to_back(poll: Poll, until_s: float, times_ms: list[float]) -> None:
    while time.perf_counter() < until_s:
        await _timed(poll, times_ms)


async def _loaded(tasks: Callable[[float, list[float]], list[Awaitable[None]]]) -> Load:
    times_ms: list[float] = []
    cpu, begun = time.process_time(), time.perf_counter()
    await asyncio.gather(*tasks(begun, times_ms))
    seconds = time.perf_counter() - begun
    good = [one for one in times_ms if one < inf]
    return Load(good, (time.process_time() - cpu) / seconds, seconds, len(times_ms) - len(good))


async def _ten_hertz(polls: list[Poll]) -> Load:
    for poll in polls:
        await poll()
    return await _loaded(
        lambda begun, times_ms: [
            _paced(poll, begun + place * PERIOD_S / len(polls), begun + SECONDS, times_ms)
            for place, poll in enumerate(polls)
        ]
    )


async def _ours_on_tcp(port: int) -> Load:
    links = [Bus("bench", TcpWire("127.0.0.1", port), SystemClock()).unit(1, Timing()) for _ in range(DRIVES)]
    load = await _ten_hertz([lambda link=link: link.read(0, REGISTERS, what="bench") for link in links])  # type: ignore[misc]
    for link in links:
        await link.close()
    return load


async def _pymodbus_on_tcp(port: int) -> Load:
    clients = [AsyncModbusTcpClient("127.0.0.1", port=port, timeout=0.3, retries=0) for _ in range(DRIVES)]
    for client in clients:
        await client.connect()
    load = await _ten_hertz(
        [lambda one=one: one.read_holding_registers(0, count=REGISTERS, device_id=1) for one in clients]  # type: ignore[misc]
    )
    for client in clients:
        client.close()
    return load


async def _raw_on_tcp(port: int) -> Load:
    pairs = [await asyncio.open_connection("127.0.0.1", port) for _ in range(DRIVES)]

    async def poll(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> bytes:
        writer.write(RAW_REQUEST)
        return await reader.readexactly(9 + 2 * REGISTERS)

    load = await _ten_hertz([lambda pair=pair: poll(*pair) for pair in pairs])  # type: ignore[misc]
    for _, writer in pairs:
        writer.close()
        await writer.wait_closed()
    return load


async def _at_line_rate(polls: list[list[Poll]]) -> Load:
    """Poll every device of every line as fast as its line goes; each list is one line."""
    return await _loaded(
        lambda begun, times_ms: [
            _back_to_back(poll, begun + SECONDS, times_ms) for line in polls for poll in line
        ]
    )


async def _ours_on_lines(ports: list[str]) -> Load:
    buses = Buses(SystemClock())
    links = [
        buses.unit(DriveConfig(DriveKind.MODBUS_RTU, serial=SerialConfig(port, BAUD_RATE)), unit, Timing())
        for port in ports
        for unit in range(1, ON_A_LINE + 1)
    ]
    polls: list[Poll] = [lambda link=link: link.read(0, REGISTERS, what="bench") for link in links]  # type: ignore[misc]
    load = await _at_line_rate([polls])
    for link in links:
        await link.close()
    return load


async def _pymodbus_on_lines(ports: list[str]) -> Load:
    clients = [AsyncModbusSerialClient(port, baudrate=BAUD_RATE, retries=0) for port in ports]
    for client in clients:
        await client.connect()
    polls: list[Poll] = [
        lambda one=one, unit=unit: one.read_holding_registers(0, count=REGISTERS, device_id=unit)  # type: ignore[misc]
        for one in clients
        for unit in range(1, ON_A_LINE + 1)
    ]
    load = await _at_line_rate([polls])
    for client in clients:
        client.close()
    return load


@contextmanager
def _process(*arguments: str) -> Iterator[str]:
    """Run a server beside this process; yield the first line that it prints."""
    process = subprocess.Popen([sys.executable, *arguments], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    try:
        yield process.stdout.readline()
    finally:
        process.terminate()
        process.wait(10)
        process.stdout.close()


def _tcp_row() -> Row:
    with _process("-c", FIXED_SERVER) as line:
        port = int(line.split("127.0.0.1:")[1].split(",")[0])
        ours, plain, raw = (asyncio.run(way(port)) for way in (_ours_on_tcp, _pymodbus_on_tcp, _raw_on_tcp))
    return Row(
        f"{DRIVES} drives on Modbus TCP, {REGISTERS} registers each at 10 Hz",
        str(ours),
        f"plain pymodbus {plain}; raw asyncio {raw}",
        f"{ours.core / plain.core:.2f} of pymodbus's core, {ours.core / raw.core:.2f} of raw asyncio's",
        COMMAND,
    )


def _line_row() -> Row:
    units = [argument for unit in range(1, ON_A_LINE + 1) for argument in ("--unit", str(unit))]
    with tempfile.TemporaryDirectory() as folder:
        ports = [str(Path(folder) / f"line{number}") for number in range(LINES)]
        commands = [("-m", "app.cli", "drive-sim", "--rtu", port, "--paced", *units) for port in ports]
        with _process(*commands[0]), _process(*commands[1]):
            ours, plain = (asyncio.run(way(ports)) for way in (_ours_on_lines, _pymodbus_on_lines))
    bits = SerialConfig(baud_rate=BAUD_RATE).bits
    most = LINES * BAUD_RATE / bits / (REQUEST + REPLY)
    rate, plain_rate = (len(load.times_ms) / load.seconds for load in (ours, plain))
    return Row(
        f"{LINES * ON_A_LINE} drives on {LINES} lines of {BAUD_RATE} baud, {REGISTERS} registers each; "
        f"the bytes alone allow {most:.1f} polls a second",
        f"{rate:.1f} polls a second, {ours}",
        f"plain pymodbus {plain_rate:.1f} polls a second, {plain}",
        f"{rate / most:.2f} of what the bytes allow",
        COMMAND,
    )


def measure() -> list[Row]:
    """Return the rows of the report."""
    return [_tcp_row(), _line_row()]
