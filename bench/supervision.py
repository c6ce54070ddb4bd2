"""Supervision: what kills and load do to ticks and recordings, on real processes and sockets"""

import asyncio
import os
import tempfile
from collections.abc import Awaitable
from contextlib import suppress
from pathlib import Path

import httpx
import websockets

from app.link.metrics import LATENESS_BOUNDS_MS, MachineMetrics
from app.store.engine import open_reader
from app.tracker.commands import SelectMode, Track
from app.tracker.mode import Mode
from app.tracker.recording import RecordingKind
from bench.table import Row
from tests.machine.service import DriveSimulator, Service
from tests.machine.stories import kill_mid_show, kill_panel

COMMAND = "python -m bench supervision"
PANEL_KILLS = int(os.environ.get("HELIOPANEL_BENCH_PANEL_KILLS", "20"))
MACHINE_KILLS = int(os.environ.get("HELIOPANEL_BENCH_KILLS", "100"))
VIEWERS = 200
STORMERS = 16
STORM_S = 15.0


def measure() -> list[Row]:
    """Measure panel kills, tick lateness under load, and kills in the middle of shows."""
    with tempfile.TemporaryDirectory() as folder:
        base = Path(folder)
        return [
            *asyncio.run(_panel_rows(base / "panel")),
            *asyncio.run(_load_rows(base / "load")),
            *asyncio.run(_kill_rows(base / "kill")),
        ]


async def _panel_rows(data_dir: Path) -> list[Row]:
    drive, service = await DriveSimulator.start(), await Service.start(data_dir)
    try:
        await _track(service, drive)
        before = await service.link.metrics()
        for _ in range(PANEL_KILLS):
            await kill_panel(service)
        after = await service.link.metrics()
    finally:
        await service.stop()
        await drive.stop()
    wanted = int((after.uptime_s - before.uptime_s) * 10)
    ticks = after.trackers["T1"].ticks - before.trackers["T1"].ticks
    return [
        Row(
            f"panel killed {PANEL_KILLS} times while tracking",
            f"{max(0, wanted - ticks)} of {wanted} ticks missed, {_gaps(data_dir)} frames lost",
            "0",
            "",
            COMMAND,
        )
    ]


async def _track(service: Service, drive: DriveSimulator) -> None:
    await service.commission(drive)
    await service.ask(SelectMode(Mode.DUAL))
    await service.ask(Track())


def _gaps(data_dir: Path) -> int:
    """Return how many of the frames that one a second makes are not in the recorded day."""
    reader = open_reader(f"sqlite:///{data_dir / 'heliopanel.db'}")
    missing = 0
    for day in reader.recordings(kind=RecordingKind.DAY):
        elapsed_s = reader.frames(day.recording_id).column("elapsed_s")
        missing += sum(round(step) - 1 for step in (elapsed_s[1:] - elapsed_s[:-1]).tolist() if step > 1.5)
    reader.close()
    return missing


async def _load_rows(data_dir: Path) -> list[Row]:
    drive, service = await DriveSimulator.start(), await Service.start(data_dir)
    try:
        await _track(service, drive)
        quiet = await _lateness(service, asyncio.sleep(STORM_S))
        loaded = await _lateness(service, _storm(service.port))
    finally:
        await service.stop()
        await drive.stop()
    return [
        Row("tick lateness, nobody looks", quiet, "50 ms at most", "", COMMAND),
        Row(f"tick lateness, {VIEWERS} viewers and a request storm", loaded, "50 ms at most", "", COMMAND),
    ]


async def _lateness(service: Service, meanwhile: Awaitable[None]) -> str:
    before = await service.link.metrics()
    await meanwhile
    return _histogram(before, await service.link.metrics())


def _histogram(before: MachineMetrics, after: MachineMetrics) -> str:
    """Return the bounds below which half and 99.9 % of the ticks between two looks lie."""
    old, new = before.trackers["T1"].lateness_counts, after.trackers["T1"].lateness_counts
    counts = [late - early for early, late in zip(old, new, strict=True)]
    bounds = [*(f"below {bound:.0f} ms" for bound in LATENESS_BOUNDS_MS), "above 1 s"]

    def at(share: float) -> str:
        left = sum(counts) * share
        for bound, count in zip(bounds, counts, strict=True):
            left -= count
            if left <= 0:
                return bound
        return bounds[-1]

    return f"{sum(counts)} ticks: p50 {at(0.5)}, p99.9 {at(0.999)}, all {at(1.0)}"


async def _storm(port: int) -> None:
    """Have many viewers read live values while pages and API are asked without a pause."""
    loop = asyncio.get_running_loop()
    until = loop.time() + STORM_S
    viewers = [asyncio.create_task(_view(port, until)) for _ in range(VIEWERS)]
    stormers = [asyncio.create_task(_ask(port, until)) for _ in range(STORMERS)]
    await asyncio.gather(*viewers, *stormers)


async def _view(port: int, until: float) -> None:
    loop = asyncio.get_running_loop()
    with suppress(OSError, websockets.WebSocketException, TimeoutError):
        async with websockets.connect(
            f"ws://127.0.0.1:{port}/live", origin=websockets.Origin(f"http://127.0.0.1:{port}")
        ) as socket:
            while loop.time() < until:
                async with asyncio.timeout(2):
                    await socket.recv()


async def _ask(port: int, until: float) -> None:
    loop = asyncio.get_running_loop()
    async with httpx.AsyncClient(base_url=f"http://127.0.0.1:{port}") as client:
        while loop.time() < until:
            with suppress(httpx.HTTPError):
                await client.get("/api/v1/site")


async def _kill_rows(data_dir: Path) -> list[Row]:
    drive, service = await DriveSimulator.start(), await Service.start(data_dir)
    try:
        await service.commission(drive)
        stopped_s = [await kill_mid_show(service, drive, number) for number in range(MACHINE_KILLS)]
    finally:
        await service.stop()
        await drive.stop()
    return [
        Row(
            f"machine killed {MACHINE_KILLS} times in a show",
            f"nothing committed lost, every restart told; axes at rest after at most {max(stopped_s):.2f} s",
            "watchdog 0.5 s and ramp",
            "",
            COMMAND,
        )
    ]
