"""Idle: how long a start takes until pages, controller and database answer, and what it then holds in memory

The data folder has been used before, but for the first start, which creates the database. Memory is the
proportional share (PSS): what processes have in common counts once.
"""

import os
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import httpx

from bench.table import NotMeasured, Row, alone, at_most
from tests.e2e.product import Product

COMMAND = "python -m bench idle"
MOST_MB = 170.0
LONGEST_START_S = 2.0
TICK_S = 1.0 / os.sysconf("SC_CLK_TCK")


@dataclass(frozen=True, slots=True)
class Size:
    """How many starts are timed, and how long after the last one memory is looked at."""

    starts: int = 5
    idle_s: float = 60.0


SMALL = Size(starts=1, idle_s=0.0)


@dataclass(frozen=True, slots=True)
class Start:
    """One start: the time until everything answers, and the processor time of all processes until then."""

    ready_s: float
    used_s: float


def measure(size: Size = Size()) -> list[Row]:
    """Return the first start, the later ones, and the memory of each process when nothing happens."""
    if not Path("/proc/self/smaps_rollup").exists():
        raise NotMeasured("this system does not tell what a process shares")
    with tempfile.TemporaryDirectory() as folder:
        data_dir = Path(folder) / "data"
        first = _started(data_dir, 0.0)[0]
        runs = [
            _started(data_dir, size.idle_s if one == size.starts - 1 else 0.0) for one in range(size.starts)
        ]
    return [*_start_rows(first, [start for start, _ in runs]), *_memory_rows(runs[-1][1])]


def _started(data_dir: Path, idle_s: float) -> tuple[Start, dict[str, float]]:
    """Start the product, open its first page once it answers, and return what each process holds later."""
    began = time.monotonic()
    product = Product.start(data_dir)
    try:
        assert httpx.get(product.url).status_code == 200
        ready_s = time.monotonic() - began
        processes = {
            "supervisor": product.process.pid,
            "controller": product.starts("controller")[-1],
            "web process": product.starts("web")[-1],
        }
        start = Start(ready_s, sum(_used_s(process_id) for process_id in processes.values()))
        time.sleep(idle_s)
        return start, {name: _held_mb(process_id) for name, process_id in processes.items()}
    finally:
        product.stop()


def _used_s(process_id: int) -> float:
    """Return the processor time of a process."""
    fields = Path(f"/proc/{process_id}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) * TICK_S


def _held_mb(process_id: int) -> float:
    """Return the proportional share of memory of a process, in MB."""
    lines = Path(f"/proc/{process_id}/smaps_rollup").read_text().splitlines()
    return next(int(line.split()[1]) / 1024.0 for line in lines if line.startswith("Pss:"))


def _start_rows(first: Start, later: list[Start]) -> list[Row]:
    slowest_s, used_s = max(one.ready_s for one in later), max(one.used_s for one in later)
    told = f"{slowest_s:.2f} s, {used_s:.2f} s of a processor"
    return [
        at_most(
            "the first start, which creates the database: until pages, controller and database answer",
            first.ready_s,
            LONGEST_START_S,
            "s",
            COMMAND,
            ours=f"{first.ready_s:.2f} s, {first.used_s:.2f} s of a processor",
        ),
        at_most(f"{len(later)} later starts, maximum", slowest_s, LONGEST_START_S, "s", COMMAND, ours=told),
    ]


def _memory_rows(held_mb: dict[str, float]) -> list[Row]:
    whole = at_most("memory of an idle product, PSS, in all", sum(held_mb.values()), MOST_MB, "MB", COMMAND)
    return [whole, *(alone(f"memory of the {name}", f"{mb:.0f} MB", COMMAND) for name, mb in held_mb.items())]
