"""Many drives: 64 on Modbus TCP polled at 10 Hz, and 16 on two lines of 19200 baud at their line rate"""

import asyncio
import shutil
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

from app.base.clock import SystemClock
from app.drives.connections.buses import Buses
from app.modbus.bus import Bus
from app.modbus.errors import DriveError
from app.modbus.tcp import TcpWire
from app.modbus.wire import Timing
from app.tracker.settings.config import DriveConfig, DriveKind, SerialConfig
from bench.drives import FIXED_SERVER, REGISTERS
from bench.table import NotMeasured, Row, at_most, beside, must_hold, percentile, spread

COMMAND = "python -m bench buses"
POLLER = Path(__file__).with_name("poller.c")
DRIVES, PERIOD_S = 64, 0.1
MOST_OF_PYMODBUS, MOST_OF_C = 2.0, 1.5
"""In times of plain pymodbus's single poll, and of a C loop's share of a core."""
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

    def __str__(self) -> str:
        return (
            f"{spread(self.times_ms)}, "
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


async def _ten_hertz(polls: list[Poll], seconds: float) -> Load:
    for poll in polls:
        await _timed(poll, [])
    return await _loaded(
        lambda begun, times_ms: [
            _paced(poll, begun + place * PERIOD_S / len(polls), begun + seconds, times_ms)
            for place, poll in enumerate(polls)
        ]
    )


async def _ours_on_tcp(port: int, seconds: float) -> Load:
    links = [Bus("bench", TcpWire("127.0.0.1", port), SystemClock()).unit(1, Timing()) for _ in range(DRIVES)]
    load = await _ten_hertz(
        [lambda link=link: link.read(0, REGISTERS, what="bench") for link in links], seconds
    )  # type: ignore[misc]
    for link in links:
        await link.close()
    return load


async def _pymodbus_on_tcp(port: int, seconds: float) -> Load:
    clients = [AsyncModbusTcpClient("127.0.0.1", port=port, timeout=0.3, retries=0) for _ in range(DRIVES)]
    try:
        for client in clients:
            await client.connect()
        return await _ten_hertz(
            [lambda one=one: one.read_holding_registers(0, count=REGISTERS, device_id=1) for one in clients],  # type: ignore[misc]
            seconds,
        )
    finally:
        for client in clients:
            client.close()


async def _raw_on_tcp(port: int, seconds: float) -> Load:
    pairs = [await asyncio.open_connection("127.0.0.1", port) for _ in range(DRIVES)]

    async def poll(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> bytes:
        writer.write(RAW_REQUEST)
        return await reader.readexactly(9 + 2 * REGISTERS)

    load = await _ten_hertz([lambda pair=pair: poll(*pair) for pair in pairs], seconds)  # type: ignore[misc]
    for _, writer in pairs:
        writer.close()
        await writer.wait_closed()
    return load


async def _at_line_rate(polls: list[list[Poll]], seconds: float) -> Load:
    """Poll every device of every line as fast as its line goes; each list is one line."""
    return await _loaded(
        lambda begun, times_ms: [
            _back_to_back(poll, begun + seconds, times_ms) for line in polls for poll in line
        ]
    )


async def _ours_on_lines(ports: list[str], seconds: float) -> Load:
    buses = Buses(SystemClock())
    links = [
        buses.unit(DriveConfig(DriveKind.MODBUS_RTU, serial=SerialConfig(port, BAUD_RATE)), unit, Timing())
        for port in ports
        for unit in range(1, ON_A_LINE + 1)
    ]
    polls: list[Poll] = [lambda link=link: link.read(0, REGISTERS, what="bench") for link in links]  # type: ignore[misc]
    load = await _at_line_rate([polls], seconds)
    for link in links:
        await link.close()
    return load


async def _pymodbus_on_lines(ports: list[str], seconds: float) -> Load:
    clients = [AsyncModbusSerialClient(port, baudrate=BAUD_RATE, retries=0) for port in ports]
    for client in clients:
        await client.connect()
    polls: list[Poll] = [
        lambda one=one, unit=unit: one.read_holding_registers(0, count=REGISTERS, device_id=unit)  # type: ignore[misc]
        for one in clients
        for unit in range(1, ON_A_LINE + 1)
    ]
    load = await _at_line_rate([polls], seconds)
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


def _c_on_tcp(port: int, seconds: float) -> float:
    """Return the share of a core that a C loop takes for the same polls."""
    compiler = shutil.which("cc")
    if compiler is None:
        raise NotMeasured("the peer in C needs a compiler: apt-get install -y gcc")
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "poller"
        subprocess.run([compiler, "-O2", "-o", str(program), str(POLLER)], check=True)
        given = [str(port), str(DRIVES), f"{PERIOD_S * 1000:g}", f"{seconds:g}", str(REGISTERS)]
        told = subprocess.run([str(program), *given], check=True, capture_output=True, text=True).stdout
    core, replies = told.split()
    assert int(replies) > 0
    return float(core)


def _tcp_rows(seconds: float) -> list[Row]:
    with _process("-c", FIXED_SERVER) as line:
        port = int(line.split("127.0.0.1:")[1].split(",")[0])
        ways = (_ours_on_tcp, _pymodbus_on_tcp, _raw_on_tcp)
        ours, plain, raw = (asyncio.run(way(port, seconds)) for way in ways)
        in_c = _c_on_tcp(port, seconds)
    name = f"{DRIVES} drives on Modbus TCP, {REGISTERS} registers each at 10 Hz"
    share, slower = ours.core / in_c, percentile(ours.times_ms, 0.5) / percentile(plain.times_ms, 0.5)
    core = f"{ours.core:.1%} of a core, the loop in C {in_c:.1%}"
    return [
        at_most(f"{name}, a core's share in times of C's", share, MOST_OF_C, "", COMMAND, ours=core),
        at_most(f"{name}, a poll's median in times of pymodbus's", slower, MOST_OF_PYMODBUS, "", COMMAND),
        must_hold(f"{name}: polls answered", str(ours), "all", COMMAND, holds=not ours.failures),
        beside(
            f"{name}, a core's share", str(ours), f"plain pymodbus {plain}", plain.core / ours.core, COMMAND
        ),
        beside(f"{name}, a core's share", str(ours), f"raw asyncio {raw}", raw.core / ours.core, COMMAND),
    ]


def _line_row(seconds: float) -> Row:
    units = [argument for unit in range(1, ON_A_LINE + 1) for argument in ("--unit", str(unit))]
    with tempfile.TemporaryDirectory() as folder:
        ports = [str(Path(folder) / f"line{number}") for number in range(LINES)]
        commands = [("-m", "app.cli", "drive-sim", "--rtu", port, "--paced", *units) for port in ports]
        with _process(*commands[0]), _process(*commands[1]):
            ours, plain = (asyncio.run(way(ports, seconds)) for way in (_ours_on_lines, _pymodbus_on_lines))
    most = LINES * BAUD_RATE / SerialConfig(baud_rate=BAUD_RATE).bits / (REQUEST + REPLY)
    rate, plain_rate = (len(load.times_ms) / load.seconds for load in (ours, plain))
    return beside(
        f"{LINES * ON_A_LINE} drives on {LINES} lines of {BAUD_RATE} baud, {REGISTERS} registers each; "
        f"the bytes alone allow {most:.1f} polls a second",
        f"{rate:.1f} polls a second ({rate / most:.0%} of those), {ours}",
        f"plain pymodbus {plain_rate:.1f} polls a second, {plain}",
        rate / plain_rate,
        COMMAND,
    )


@dataclass(frozen=True, slots=True)
class Size:
    """How long each way polls."""

    seconds: float = 10.0


SMALL = Size(seconds=0.5)


def measure(size: Size = Size()) -> list[Row]:
    """Return the rows of the report."""
    return [*_tcp_rows(size.seconds), _line_row(size.seconds)]
