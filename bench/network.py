"""Network: what becomes of ticks, requests, Stop and memory while one computer attacks the panel

The attacker is a process of its own at the lowest priority, as if it had a computer of its own. The bounds:
ticks at most 50 ms late, a stop answered within 100 ms (p99), the panel's memory within 120 MB. Whoever asks
has its address, of which the panel takes 256 connections: beside 500 streams only Stop is answered.
"""

import asyncio
import contextlib
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import httpx

from bench.attacks import ATTACKS
from bench.table import Row
from tests.e2e.integrator import Integrator
from tests.e2e.product import Product

COMMAND = "python -m bench network"
LASTS_S = 9.0
PROBE_EVERY_S = 0.05
STOP_MS, MEMORY_MB, LATE_MS = 100.0, 120.0, 50.0
ATTACKER = ("nice", "-n", "19", sys.executable, "-m", "bench.attacks")
BEGINS_S = 1.0


@dataclass(frozen=True, slots=True)
class Felt:
    """How the attack was felt: times of stops and of pages, what was refused, memory, and lateness."""

    stops_ms: list[float]
    pages_ms: list[float]
    failed: int
    memory_mb: float
    late: str


def measure() -> list[Row]:
    """Return what each attack did to a running panel."""
    with tempfile.TemporaryDirectory() as folder:
        product = Product.start(Path(folder) / "data")
        try:
            calling = Integrator(product.url)
            calling.place_and_time()
            calling.close()
            return [_row(name, asyncio.run(_under(product, name))) for name in ATTACKS]
        finally:
            product.stop()


async def _under(product: Product, attack: str) -> Felt:
    before = await _lateness(product)
    attacking = await asyncio.create_subprocess_exec(*ATTACKER, attack, str(product.port), str(LASTS_S))
    await asyncio.sleep(BEGINS_S)
    until = time.monotonic() + LASTS_S
    stops, pages, failed, memory = [], [], 0, 0.0
    while time.monotonic() < until:
        for path, method, times in (("/api/v1/trackers/T1/stop", "POST", stops), ("/health", "GET", pages)):
            took = await _probe(product.port, method, path)
            failed += took is None
            times += [took] if took is not None else []
        memory = max(memory, _resident_mb(product.starts("web")[-1]))
        await asyncio.sleep(PROBE_EVERY_S)
    await attacking.wait()
    after = await _lateness(product)
    return Felt(stops, pages, failed, memory, _latest(before, after))


async def _probe(port: int, method: str, path: str) -> float | None:
    """Return how long a request on a new connection took, milliseconds; None if it was not answered."""
    begun = time.perf_counter()
    with contextlib.suppress(OSError, TimeoutError, IndexError):
        async with asyncio.timeout(5):
            reader, writer = await asyncio.open_connection("127.0.0.1", port)
            writer.write(f"{method} {path} HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n".encode())
            answer = await reader.read()
            writer.close()
            if answer.split(b" ")[1][:1] == b"2":
                return (time.perf_counter() - begun) * 1000
    return None


async def _lateness(product: Product) -> dict[str, float]:
    """Return how many ticks were at most so late, by the bound in seconds."""
    async with httpx.AsyncClient(timeout=10) as client:
        text = (await client.get(f"{product.url}/metrics")).text
    rows = [line for line in text.splitlines() if "late" in line and "_bucket" in line]
    return {line.partition('le="')[2].partition('"')[0]: float(line.rsplit(" ", 1)[1]) for line in rows}


def _latest(before: dict[str, float], after: dict[str, float]) -> str:
    grown = {bound: after[bound] - before.get(bound, 0.0) for bound in after}
    total = grown.get("+Inf", 0.0)
    for bound in sorted((one for one in grown if one != "+Inf"), key=float):
        if grown[bound] >= total:
            return f"all {total:.0f} at most {float(bound) * 1000:.0f} ms late"
    return f"{total:.0f} ticks, some later than the last bound"


def _resident_mb(process_id: int) -> float:
    for line in Path(f"/proc/{process_id}/status").read_text().splitlines():
        if line.startswith("VmRSS"):
            return float(line.split()[1]) / 1000
    return 0.0


def _p99(times: list[float]) -> float:
    return sorted(times)[int(len(times) * 0.99)] if times else float("inf")


def _row(name: str, felt: Felt) -> Row:
    return Row(
        f"under {name}: stop p99, page p99, not answered, panel's memory, ticks",
        f"{_p99(felt.stops_ms):.0f} ms, {_p99(felt.pages_ms):.0f} ms, "
        f"{felt.failed} of {felt.failed + len(felt.stops_ms) + len(felt.pages_ms)}, "
        f"{felt.memory_mb:.0f} MB, {felt.late}",
        f"{STOP_MS:.0f} ms, -, 0, {MEMORY_MB:.0f} MB, {LATE_MS:.0f} ms",
        f"{_p99(felt.stops_ms) / STOP_MS:.2f}",
        COMMAND,
    )
