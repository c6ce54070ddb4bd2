"""Viewers: the load of a thousand viewing pages on the web process, and their delay

The pages are read by processes of their own at nice 10, on this computer, whose share is all that the panel
serves: a thousand. Only the panel's processor time is counted. How late: from the instant that the controller
stamped the state with.
"""

import asyncio
import os
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import orjson

from bench.table import Row, at_most, must_hold, spread, worst
from tests.e2e.integrator import Integrator
from tests.e2e.product import Product

COMMAND = "python -m bench viewers"
CORE_BOUND, LATE_BOUND_MS = 0.05, 30.0
A_READER = 250
JOINED_IN_S = 0.02
READER = Path(__file__).with_name("viewer.py")


@dataclass(frozen=True, slots=True)
class Size:
    """How many look on, one run after the other, and how long."""

    viewers: tuple[int, ...] = (1000, 5000)
    lasts_s: float = 15.0


SMALL = Size(viewers=(4,), lasts_s=1.0)


@dataclass(frozen=True, slots=True)
class Seen:
    """What the pages saw: how late each state came, how many pages were not served, and the panel's work."""

    late_ms: list[float]
    refused: int
    core: float


def measure(size: Size = Size()) -> list[Row]:
    """Return what so many viewers cost, and how late they are told."""
    with tempfile.TemporaryDirectory() as folder:
        product = Product.start(Path(folder) / "data")
        try:
            calling = Integrator(product.url)
            calling.call("PUT", "/api/v1/site/clock", json={"source": "system"})
            calling.close()
            seen = {viewers: asyncio.run(_seen(product, viewers, size.lasts_s)) for viewers in size.viewers}
        finally:
            product.stop()
    return [row for viewers, one in seen.items() for row in _rows(viewers, one)]


async def _seen(product: Product, viewers: int, lasts_s: float) -> Seen:
    joined_s = viewers * JOINED_IN_S / 2 + 1.0
    readers = [
        await asyncio.create_subprocess_exec(
            "nice", "-n", "10", sys.executable, str(READER), str(product.port), str(min(A_READER, left)),
            str(joined_s), str(lasts_s), stdout=asyncio.subprocess.PIPE,
        )
        for left in range(viewers, 0, -A_READER)
    ]  # fmt: skip
    await asyncio.sleep(joined_s)
    panel = product.starts("web")[-1]
    before_s = _worked_s(panel)
    await asyncio.sleep(lasts_s)
    core = (_worked_s(panel) - before_s) / lasts_s
    told = [orjson.loads((await reader.communicate())[0]) for reader in readers]
    late_ms = [late_ms for one in told for late_ms in one["late_ms"]]
    return Seen(late_ms, viewers - sum(one["served"] for one in told), core)


def _worked_s(process_id: int) -> float:
    """Return the processor time of a process so far."""
    fields = Path(f"/proc/{process_id}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _rows(viewers: int, seen: Seen) -> list[Row]:
    who = f"{viewers:,} viewers of one tracker at standstill, two states a second"
    served = f"{viewers - seen.refused:,} of {viewers:,}"
    rows = [must_hold(f"{who}: served", served, "all", COMMAND, holds=not seen.refused)]
    if seen.late_ms:
        name, _ = worst(seen.late_ms)
        told = f"{spread(seen.late_ms)} ({len(seen.late_ms):,} states, to the {name})"
        rows.append(at_most(f"{who}: late, p99", _p99(seen.late_ms), LATE_BOUND_MS, "ms", COMMAND, ours=told))
    rows.append(at_most(f"{who}: web process, share of a core", seen.core, CORE_BOUND, "of a core", COMMAND))
    return rows


def _p99(values: list[float]) -> float:
    return sorted(values)[int(len(values) * 0.99)]
