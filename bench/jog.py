"""Hold-to-run: from the last sign of a held key to velocity command 0 at a Modbus drive, the whole way"""

import asyncio
import gc
import os
import random
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from contextlib import suppress
from math import ceil
from pathlib import Path
from struct import pack, unpack_from

import httpx
import orjson
from websockets.asyncio.client import ClientConnection, connect
from websockets.typing import Origin

from app.drives.profile import load_profile
from bench.table import Row
from tests.e2e.integrator import Integrator
from tests.e2e.product import Product, end

COMMAND = "python -m bench jog"
FARM = """
import asyncio
import gc
import signal
import sys
from datetime import timedelta
from app.clock import SystemClock
from app.drives.profile import load_profile
from app.drives.sim_server import serve
from app.drives.simulated import SimulatedDrive
from app.tracker.config import TrackerConfig

async def main():
    clock, profile, servers = SystemClock(), load_profile("simulated-plc"), []
    for number in range(int(sys.argv[1])):
        drive = SimulatedDrive(TrackerConfig(f"T{number}", "Bench"), clock)
        servers.append(await serve("127.0.0.1", 0, profile, drive, clock))
    print(*(port for _, port in servers), flush=True)
    gc.freeze()
    ended = asyncio.Event()
    asyncio.get_running_loop().add_signal_handler(signal.SIGTERM, ended.set)
    await ended.wait()
    for server, _ in servers:
        await server.close()

asyncio.run(main())
"""

TRIALS = int(os.environ.get("HELIOPANEL_BENCH_JOGS", "1000"))
TRACKERS = 8
BEAT_S = 0.05
LOOK_EVERY_S = 0.004
LIMIT_MS = 300.0
STILL_TURNS_AFTER_S = 2.0
PRESSES = 5
FIFO_PRIORITY = 5
REGISTERS = load_profile("simulated-plc").registers
MOTION = REGISTERS["azimuth_motion"].address
HALT, VELOCITY = 0, 1


class Drive:
    """What one simulated drive is told to do, read over a connection of its own."""

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._reader, self._writer = reader, writer

    @classmethod
    async def at(cls, port: int) -> "Drive":
        return cls(*await asyncio.open_connection("127.0.0.1", port))

    async def turns(self) -> bool:
        """Return whether the azimuth axis is commanded to turn."""
        self._writer.write(pack(">HHHBBHH", 1, 0, 6, 1, 3, MOTION, 3))
        reply = await self._reader.readexactly(15)
        motion, setpoint = unpack_from(">Hi", reply, 9)
        return bool(motion != HALT and not (motion == VELOCITY and setpoint == 0))

    async def until_told(self) -> float:
        """Return when the command was first seen to be velocity 0."""
        loop = asyncio.get_running_loop()
        give_up = loop.time() + STILL_TURNS_AFTER_S
        while await self.turns():
            assert loop.time() < give_up, "the axis was not told to stop"
            await asyncio.sleep(LOOK_EVERY_S)
        return loop.time()

    async def close(self) -> None:
        self._writer.close()
        await self._writer.wait_closed()


class Page:
    """One page's WebSocket, and the key that is held on it."""

    def __init__(self, socket: ClientConnection, tracker_id: str) -> None:
        self._socket, self._tracker_id = socket, tracker_id

    async def listen(self) -> None:
        """Take what the panel tells, as a page does."""
        async for _ in self._socket:
            pass

    async def beat(self, press_id: str, direction: int, sequence: int) -> float:
        """Say that the key is still held, and return when."""
        now_s = asyncio.get_running_loop().time()
        await self._send(
            type="jog", press_id=press_id, axis="azimuth", direction=direction, speed="slow",
            sequence=sequence, tc=now_s * 1000.0, rtt_ms=1.0,
        )  # fmt: skip
        return now_s

    async def let_go(self, press_id: str) -> float:
        """Say that the key was let go, and return when."""
        now_s = asyncio.get_running_loop().time()
        await self._send(type="end_jog", press_id=press_id)
        return now_s

    async def _send(self, **message: object) -> None:
        await self._socket.send(orjson.dumps({"tracker_id": self._tracker_id, **message}).decode())


def measure() -> list[Row]:
    """Return how long a jog outlives its key, released and vanished."""
    with tempfile.TemporaryDirectory() as folder:
        farm = subprocess.Popen([sys.executable, "-c", FARM, str(TRACKERS)], stdout=subprocess.PIPE)
        assert farm.stdout is not None
        product = Product.start(Path(folder) / "data")
        try:
            _keep_punctual(farm.pid)
            _keep_punctual(0)
            gc.freeze()
            ports = [int(word) for word in farm.stdout.readline().split()]
            for number, port in enumerate(ports):
                _add(product.url, f"B{number}", port)
            return asyncio.run(_rows(product.port, ports))
        finally:
            product.stop()
            end(farm)
            farm.stdout.close()


def _keep_punctual(process_id: int) -> None:
    """Let other programs not delay the drives and the watch: only the product is measured."""
    with suppress(OSError):
        policy = os.SCHED_FIFO | os.SCHED_RESET_ON_FORK
        os.sched_setscheduler(process_id, policy, os.sched_param(FIFO_PRIORITY))


def _add(url: str, tracker_id: str, port: int) -> None:
    calling = Integrator(url, tracker_id)
    drive = {"kind": "modbus-tcp", "profile": "simulated-plc", "host": "127.0.0.1", "port": port}
    added = calling.http.post(
        "/api/v1/trackers", json={"tracker_id": tracker_id, "name": tracker_id, "drive": drive}
    )
    assert added.status_code == httpx.codes.CREATED, added.text
    calling.until_allowed("jog")
    calling.close()


async def _rows(panel_port: int, ports: Sequence[int]) -> list[Row]:
    rows = []
    for name, released in (("key released", True), ("page vanished, from its last heartbeat", False)):
        ran = await asyncio.gather(
            *(_holds(panel_port, f"B{number}", port, released=released) for number, port in enumerate(ports))
        )
        rows.append(_row(name, sorted(time_ms for times in ran for time_ms in times)))
    return rows


async def _holds(panel_port: int, tracker_id: str, port: int, *, released: bool) -> list[float]:
    """Hold and let go again and again; return the milliseconds from each end to velocity command 0."""
    drive = await Drive.at(port)
    address = f"ws://127.0.0.1:{panel_port}/live?tracker={tracker_id}"
    async with connect(address, origin=Origin(f"http://127.0.0.1:{panel_port}")) as socket:
        page = Page(socket, tracker_id)
        listening = asyncio.create_task(page.listen())
        times = [
            await _hold(page, drive, f"{tracker_id}-{released}-{trial}", 1 - trial % 2 * 2, released=released)
            for trial in range(max(1, TRIALS // TRACKERS))
        ]
        listening.cancel()
        await asyncio.gather(listening, return_exceptions=True)
    await drive.close()
    return times


async def _hold(page: Page, drive: Drive, name: str, direction: int, *, released: bool) -> float:
    """Press until a press is not refused, hold, end; return the milliseconds until velocity command 0."""
    for press in range(PRESSES):
        press_id = f"{name}-{press}"
        last_s = await _held(page, press_id, direction)
        if not await drive.turns():
            await asyncio.sleep(1.0)
            continue
        if released:
            last_s = await page.let_go(press_id)
        took_s = await drive.until_told() - last_s
        await asyncio.sleep(random.uniform(0.15, 0.25))
        return took_s * 1000.0
    raise AssertionError(f"{PRESSES} presses in a row did not move the axis")


async def _held(page: Page, press_id: str, direction: int) -> float:
    """Say some times that the key is held, and return when for the last time, just before the next is due."""
    loop = asyncio.get_running_loop()
    last_s = loop.time()
    for sequence in range(random.randint(5, 8)):
        last_s = await page.beat(press_id, direction, sequence)
        await asyncio.sleep(max(0.0, last_s + BEAT_S - loop.time()))
    return last_s


def _row(name: str, times_ms: Sequence[float]) -> Row:
    p50, p99, p999 = (times_ms[ceil(len(times_ms) * share) - 1] for share in (0.5, 0.99, 0.999))
    return Row(
        f"{name}: {len(times_ms)} holds through WebSocket, panel, machine and Modbus TCP, "
        f"{TRACKERS} trackers at once",
        f"p50 {p50:.0f} ms, p99 {p99:.0f} ms, p99.9 {p999:.0f} ms, max {times_ms[-1]:.0f} ms",
        f"{LIMIT_MS:.0f} ms",
        f"{p999 / LIMIT_MS:.2f}",
        COMMAND,
    )
