"""Network: ticks, Stop, requests, and memory while one computer attacks every interface

The attacker is a process of its own at nice 19, as if it had a computer of its own, and asks from the same
address as whoever is measured, of which the panel takes 256 connections. Meanwhile one tracker is stopped
again and again, each time over a new connection, and another one tracks: the ticks are that one's.
"""

import asyncio
import contextlib
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from math import inf
from pathlib import Path
from struct import pack

import httpx

from bench.attacks import ATTACKS, Target
from bench.table import ENOUGH_FOR_P999, NotMeasured, Row, alone, at_most, must_hold, spread, worst
from tests.e2e.integrator import Integrator
from tests.e2e.product import Product, end
from tests.ports import free_port

COMMAND = "python -m bench network"
PRESS_EVERY_S = 0.003
PRESSES_A_PAGE = 10
STOP_MS, MEMORY_MB, LATE_MS = 100.0, 120.0, 50.0
ATTACKER = ("nice", "-n", "19", sys.executable, "-m", "bench.attacks")
MOSQUITTO = shutil.which("mosquitto") or "/usr/sbin/mosquitto"
WATCHED = "T2"


@dataclass(frozen=True, slots=True)
class Size:
    """How often Stop is pressed under each attack, how long at most, and how long after it began."""

    presses: int = ENOUGH_FOR_P999
    longest_s: float = 13.0
    begins_s: float = 1.0


SMALL = Size(presses=3, longest_s=0.5, begins_s=0.2)


@dataclass(slots=True)
class Felt:
    """How the attack was felt: stops, pages, the control system's reads, refusals, memory, and ticks."""

    stops_ms: list[float] = field(default_factory=list)
    pages_ms: list[float] = field(default_factory=list)
    scada_ms: list[float] = field(default_factory=list)
    failed: int = 0
    memory_mb: float = 0.0
    ticks: float = 0.0
    late_ms: float = inf
    deaths: int = 0
    tracking: bool = False

    @property
    def asked(self) -> int:
        """Return how often anything was asked."""
        return self.failed + len(self.stops_ms) + len(self.pages_ms) + len(self.scada_ms)


def measure(size: Size = Size()) -> list[Row]:
    """Return what each attack did to a running product."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        with _broker(folder) as mqtt, _attacked(folder, mqtt) as (product, target):
            felt = {attack: asyncio.run(_under(product, target, attack, size)) for attack in ATTACKS}
    return [row for attack, one in felt.items() for row in _rows(attack, one)]


@contextlib.contextmanager
def _broker(folder: Path) -> Iterator[int]:
    """Run a Mosquitto and yield its port."""
    if shutil.which(MOSQUITTO) is None:
        raise NotMeasured("it needs mosquitto; install it with: make system-packages")
    port, settings = free_port(), folder / "mosquitto.conf"
    settings.write_text(f"listener {port} 127.0.0.1\nallow_anonymous true\n")
    process = subprocess.Popen([MOSQUITTO, "-c", str(settings)], stderr=subprocess.DEVNULL)
    try:
        yield port
    finally:
        end(process)


@contextlib.contextmanager
def _attacked(folder: Path, mqtt: int) -> Iterator[tuple[Product, Target]]:
    """Run the product with every way in open and a second tracker that tracks."""
    sunspec = free_port()
    ways_in = {"sunspec_port": str(sunspec), "mqtt_host": "127.0.0.1", "mqtt_port": str(mqtt)}
    ways_in |= {"mqtt_base_topic": "flooded", "mqtt_commands": "true"}
    product = Product.start(folder / "data", **ways_in)
    try:
        yield product, Target(product.port, sunspec, mqtt, _prepare(product))
    finally:
        product.stop()


def _prepare(product: Product) -> str:
    """Let the second tracker track, and return the token of somebody who reads and stops."""
    calling = Integrator(product.url, WATCHED)
    calling.place_and_time()
    calling.call("POST", "/api/v1/trackers", json={"tracker_id": WATCHED, "name": "Watched"})
    calling.zero()
    calling.command("set_mode", mode="dual")
    calling.until_allowed("track")
    calling.command("track")
    wish = {"name": "viewer", "scopes": ["read", "stop"]}
    token = str(calling.call("POST", "/api/v1/tokens", json=wish).json()["token"])
    calling.close()
    return token


async def _under(product: Product, target: Target, attack: str, size: Size) -> Felt:
    felt, before = Felt(), await _lateness(product)
    deaths = len(product.deaths())
    where = (target.panel, target.sunspec, target.mqtt, target.token)
    attacking = await asyncio.create_subprocess_exec(
        *ATTACKER, attack, *map(str, where), "60", stdout=asyncio.subprocess.PIPE
    )
    try:
        assert attacking.stdout is not None
        await attacking.stdout.readline()
        await asyncio.sleep(size.begins_s)
        await _press(product, target, size, felt)
        if attacking.returncode:
            raise RuntimeError(f"The attack ended by itself: {attack}")
    finally:
        with contextlib.suppress(ProcessLookupError):
            attacking.terminate()
        await attacking.wait()
    felt.ticks, felt.late_ms = _latest(before, await _lateness(product))
    felt.deaths = len(product.deaths()) - deaths
    felt.tracking = await asyncio.to_thread(_tracks, product)
    return felt


async def _press(product: Product, target: Target, size: Size, felt: Felt) -> None:
    """Press Stop again and again; ask for a page and read as the control system does in between."""
    until = time.monotonic() + size.longest_s
    pressed = 0
    while pressed < size.presses and time.monotonic() < until:
        _note(felt, felt.stops_ms, await _probe(target.panel, "POST", "/api/v1/trackers/T1/stop"))
        if pressed % PRESSES_A_PAGE == 0:
            _note(felt, felt.pages_ms, await _probe(target.panel, "GET", "/health"))
            _note(felt, felt.scada_ms, await _read(target.sunspec))
            felt.memory_mb = max(felt.memory_mb, _resident_mb(product.starts("web")[-1]))
        pressed += 1
        await asyncio.sleep(PRESS_EVERY_S)


def _note(felt: Felt, times: list[float], took_ms: float | None) -> None:
    if took_ms is None:
        felt.failed += 1
    else:
        times.append(took_ms)


def _tracks(product: Product) -> bool:
    """Return whether the watched tracker still tracks."""
    calling = Integrator(product.url, WATCHED)
    found = calling.snapshot()
    calling.close()
    return bool(found["tracking_on"])


async def _probe(port: int, method: str, path: str) -> float | None:
    """Return how long a request on a new connection took, milliseconds; None if it was not answered."""
    request = f"{method} {path} HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n".encode()
    begun = time.perf_counter()
    answer = await _asked(port, request)
    good = answer.startswith(b"HTTP/1.1 2")
    return (time.perf_counter() - begun) * 1000 if good else None


async def _read(port: int) -> float | None:
    """Return how long the control system's first read on a new connection took; None if it got no answer."""
    begun = time.perf_counter()
    answer = await _asked(port, pack(">HHHBBHH", 1, 0, 6, 1, 3, 40000, 2), 13)
    return (time.perf_counter() - begun) * 1000 if answer.endswith(b"SunS") else None


async def _asked(port: int, request: bytes, count: int = -1) -> bytes:
    """Return what a new connection answers, nothing if that takes longer than 5 s or fails."""
    with contextlib.suppress(OSError, TimeoutError):
        async with asyncio.timeout(5):
            reader, writer = await asyncio.open_connection("127.0.0.1", port)
            writer.write(request)
            answer = await reader.read(count)
            writer.close()
            return answer
    return b""


async def _lateness(product: Product) -> dict[str, float]:
    """Return how many ticks of the watched tracker were at most so late, by the bound in seconds."""
    async with httpx.AsyncClient(timeout=10) as client:
        text = (await client.get(f"{product.url}/metrics")).text
    rows = [line for line in text.splitlines() if "late" in line and "_bucket" in line and WATCHED in line]
    return {line.partition('le="')[2].partition('"')[0]: float(line.rsplit(" ", 1)[1]) for line in rows}


def _latest(before: dict[str, float], after: dict[str, float]) -> tuple[float, float]:
    """Return the ticks since, and the bound in milliseconds that none of them was beyond."""
    grown = {bound: after[bound] - before.get(bound, 0.0) for bound in after}
    total = grown.get("+Inf", 0.0)
    for bound in sorted((one for one in grown if one != "+Inf"), key=float):
        if grown[bound] >= total:
            return total, float(bound) * 1000.0
    return total, inf


def _resident_mb(process_id: int) -> float:
    for line in Path(f"/proc/{process_id}/status").read_text().splitlines():
        if line.startswith("VmRSS"):
            return float(line.split()[1]) / 1000
    return 0.0


def _rows(name: str, felt: Felt) -> list[Row]:
    """Return a row for each bound: a stop, what is answered, the controller, ticks, the panel's memory."""
    stops_ms = felt.stops_ms or [inf]
    which, stop_ms = worst(stops_ms)
    which = f"{which} of {len(felt.stops_ms):,}"
    answered = f"{felt.asked - felt.failed:,} of {felt.asked:,}"
    lives = f"{felt.deaths} died, the tracker {'tracks on' if felt.tracking else 'does not track'}"
    return [
        at_most(f"under {name}: a stop, {which}", stop_ms, STOP_MS, "ms", COMMAND, ours=spread(stops_ms)),
        alone(f"under {name}: a page", spread(felt.pages_ms or [inf]), COMMAND),
        alone(f"under {name}: a read over SunSpec", spread(felt.scada_ms or [inf]), COMMAND),
        must_hold(f"under {name}: requests answered", answered, "all", COMMAND, holds=not felt.failed),
        must_hold(
            f"under {name}: controller and web process", lives, "none dies, it tracks on", COMMAND,
            holds=not felt.deaths and felt.tracking,
        ),
        at_most(f"under {name}: memory of the web process (RSS)", felt.memory_mb, MEMORY_MB, "MB", COMMAND),
        at_most(
            f"under {name}: the latest of {felt.ticks:.0f} ticks", felt.late_ms, LATE_MS, "ms", COMMAND,
            ours=f"at most {felt.late_ms:g} ms",
        ),
    ]  # fmt: skip
