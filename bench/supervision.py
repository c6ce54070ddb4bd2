"""Supervision: what kills and load do to ticks and recordings, on real processes and sockets"""

import asyncio
import tempfile
from collections.abc import Awaitable
from contextlib import suppress
from dataclasses import dataclass
from math import inf
from pathlib import Path

import httpx
import websockets

from app.link.metrics import LATENESS_BOUNDS_MS
from app.store.engine import open_reader
from app.tracker.commands.commands import SelectMode, Track
from app.tracker.memory.recording import RecordingKind
from app.tracker.values.mode import Mode
from bench.table import Row, at_most, must_hold
from tests.machine.service import DriveSimulator, Service
from tests.machine.stories import kill_mid_show, kill_panel

COMMAND = "python -m bench supervision"
LATE_BOUND_MS = 50.0
REST_BOUND_S = 1.5
"""The drive's watchdog after 0.5 s, and a ramp of at most 1 s."""


@dataclass(frozen=True, slots=True)
class Size:
    """How often each process is killed, by how many the panel is stormed, and for how long."""

    panel_kills: int = 20
    controller_kills: int = 40
    viewers: int = 200
    stormers: int = 16
    storm_s: float = 15.0


SMALL = Size(panel_kills=1, controller_kills=1, viewers=4, stormers=1, storm_s=1.0)


def measure(size: Size = Size()) -> list[Row]:
    """Measure panel kills, tick lateness under load, and kills in the middle of shows."""
    with tempfile.TemporaryDirectory() as folder:
        base = Path(folder)
        return [
            *asyncio.run(_tracking_rows(base / "tracking", size)),
            *asyncio.run(_kill_rows(base / "kill", size.controller_kills)),
        ]


async def _tracking_rows(data_dir: Path, size: Size) -> list[Row]:
    """Return what panel kills and load do to a tracker that tracks; no frame may be lost under either."""
    drive, service = await DriveSimulator.start(), await Service.start(data_dir)
    try:
        await _track(service, drive)
        before = await service.link.metrics()
        for _ in range(size.panel_kills):
            await kill_panel(service)
        after = await service.link.metrics()
        quiet = await _lateness(service, asyncio.sleep(size.storm_s))
        loaded = await _lateness(service, _storm(service.port, size))
    finally:
        await service.stop()
        await drive.stop()
    wanted = int((after.uptime_s - before.uptime_s) * 10)
    ticks = after.trackers["T1"].ticks - before.trackers["T1"].ticks
    missed, lost = max(0, wanted - ticks), _gaps(data_dir)
    told = f"{missed} of {wanted} ticks missed, {lost} frames lost"
    name = f"web process killed {size.panel_kills} times while tracking"
    stormed = f"tick lateness, {size.viewers} viewers and a request storm"
    return [
        must_hold(name, told, "none", COMMAND, holds=missed == lost == 0),
        _late_row("tick lateness, without viewers", quiet),
        _late_row(stormed, loaded),
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


async def _lateness(service: Service, meanwhile: Awaitable[None]) -> list[int]:
    before = (await service.link.metrics()).trackers["T1"].lateness_counts
    await meanwhile
    after = (await service.link.metrics()).trackers["T1"].lateness_counts
    return [late - early for early, late in zip(before, after, strict=True)]


def _late_row(name: str, counts: list[int]) -> Row:
    """Return the bounds below which half, 99 % and all of the ticks lie; so few ticks have no p99.9."""
    at_ms = [_below_ms(counts, share) for share in (0.5, 0.99, 1.0)]
    told = "{} ticks: p50 below {:g} ms, p99 below {:g} ms, all below {:g} ms".format(sum(counts), *at_ms)
    return at_most(f"{name}, maximum", at_ms[-1], LATE_BOUND_MS, "ms", COMMAND, ours=told)


def _below_ms(counts: list[int], share: float) -> float:
    left = sum(counts) * share
    for bound_ms, count in zip(LATENESS_BOUNDS_MS, counts[:-1], strict=True):
        left -= count
        if left <= 0:
            return bound_ms
    return inf


async def _storm(port: int, size: Size) -> None:
    """Have many viewers read live values while pages and API are asked without a pause."""
    loop = asyncio.get_running_loop()
    until = loop.time() + size.storm_s
    viewers = [asyncio.create_task(_view(port, until)) for _ in range(size.viewers)]
    stormers = [asyncio.create_task(_ask(port, until)) for _ in range(size.stormers)]
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


async def _kill_rows(data_dir: Path, kills: int) -> list[Row]:
    drive, service = await DriveSimulator.start(), await Service.start(data_dir)
    try:
        await service.commission(drive)
        stopped_s = [await kill_mid_show(service, drive, number) for number in range(kills)]
    finally:
        await service.stop()
        await drive.stop()
    name = f"controller killed {kills} times in a show"
    return [
        must_hold(
            name,
            "nothing committed lost, every restart reported",
            "the same, or the run fails",
            COMMAND,
            holds=True,
        ),
        at_most(f"{name}: axes stopped", max(stopped_s), REST_BOUND_S, "s", COMMAND),
    ]
