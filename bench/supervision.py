"""Supervision: how fast a jog ends, what kills and load do to ticks, on real processes and sockets"""

import asyncio
import os
import random
import sys
import tempfile
from collections.abc import Awaitable, Sequence
from contextlib import suppress
from pathlib import Path

import httpx
import websockets

from app.clock import SystemClock
from app.drives.drive import Drive
from app.drives.factory import make_drive
from app.link.client import LinkClient
from app.link.messages import AddTracker, Order
from app.link.metrics import LATENESS_BOUNDS_MS, MachineMetrics
from app.store.engine import open_reader
from app.tracker.axes import ELEVATION_DEFAULT, Axis
from app.tracker.commands import EndJog, Jog, SelectMode, Track
from app.tracker.config import DriveConfig, DriveKind, TrackerConfig
from app.tracker.mode import Mode
from app.tracker.recording import RecordingKind
from bench.table import Row
from tests.machine.service import DriveSimulator, Service, end, eventually
from tests.machine.stories import kill_mid_show, kill_panel

COMMAND = "python -m bench supervision"
TRACKERS = 4
TRIALS = int(os.environ.get("HELIOPANEL_BENCH_JOGS", "1000"))
PANEL_KILLS = int(os.environ.get("HELIOPANEL_BENCH_PANEL_KILLS", "20"))
MACHINE_KILLS = int(os.environ.get("HELIOPANEL_BENCH_KILLS", "100"))
VIEWERS = 200
STORMERS = 16
STORM_S = 15.0
HEARTBEAT_S = 0.05
LOOK_EVERY_S = 0.003
NOT_BEFORE_S = 0.2
"""Looking at the axes costs the simulated drives time: while the lease still runs nobody looks."""
MOST_LOOKS = 1000
STOP_LIMIT_MS = 300.0
RAMP_S = ELEVATION_DEFAULT.jog_slow_dps / ELEVATION_DEFAULT.acceleration_dps2

FARM = """
import asyncio
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
    ended = asyncio.Event()
    asyncio.get_running_loop().add_signal_handler(signal.SIGTERM, ended.set)
    await ended.wait()
    for server, _ in servers:
        await server.close()

asyncio.run(main())
"""


def measure() -> list[Row]:
    """Measure jog stops, panel kills, tick lateness under load, and kills in the middle of shows."""
    with tempfile.TemporaryDirectory() as folder:
        base = Path(folder)
        return [
            *asyncio.run(_jog_rows(base / "jog")),
            *asyncio.run(_panel_rows(base / "panel")),
            *asyncio.run(_load_rows(base / "load")),
            *asyncio.run(_kill_rows(base / "kill")),
        ]


async def _jog_rows(data_dir: Path) -> list[Row]:
    farm = await asyncio.create_subprocess_exec(
        sys.executable, "-c", FARM, str(TRACKERS), stdout=asyncio.subprocess.PIPE
    )
    assert farm.stdout is not None
    ports = [int(word) for word in (await farm.stdout.readline()).split()]
    service = await Service.start(data_dir)
    try:
        eyes = [await _add(service, number, port) for number, port in enumerate(ports)]
        await eventually(lambda: _all_can_jog(service))
        rows = []
        for name, released in (("key released", True), ("client vanished, from its last heartbeat", False)):
            each = TRIALS // TRACKERS
            ran = await asyncio.gather(
                *(
                    _jogs(service.link, number, drive, each, released=released)
                    for number, drive in enumerate(eyes)
                )
            )
            rows.append(_stop_row(name, [time for times in ran for time in times]))
        return rows
    finally:
        await service.stop()
        await end(farm)


async def _add(service: Service, number: int, port: int) -> Drive:
    config = TrackerConfig(f"B{number}", "Bench", drive=DriveConfig(DriveKind.MODBUS_TCP, port=port))
    await service.link.execute(Order(AddTracker(config), "bench"))
    return make_drive(config, SystemClock(), None)


def _all_can_jog(service: Service) -> bool:
    latest = service.link.latest()
    return latest is not None and not any(tracker.actions["jog"] for tracker in latest.trackers)


async def _jogs(link: LinkClient, number: int, drive: Drive, trials: int, *, released: bool) -> list[float]:
    """Return for each trial after how many milliseconds the axis stood, without its own ramp."""
    loop = asyncio.get_running_loop()
    times = []
    for trial in range(trials):
        press, tracker_id = f"{released}-{number}-{trial}", f"B{number}"
        for sequence in range(random.randint(4, 7)):
            last = loop.time()
            jog = Jog(press, Axis.ELEVATION, 1 if trial % 2 else -1, sequence=sequence)
            await link.execute(Order(jog, "bench", tracker_id))
            await asyncio.sleep(HEARTBEAT_S - (loop.time() - last))
        if released:
            last = loop.time()
            await link.execute(Order(EndJog(press), "bench", tracker_id))
        else:
            await asyncio.sleep(NOT_BEFORE_S - (loop.time() - last))
        await _rest(drive)
        times.append((loop.time() - last - RAMP_S) * 1000.0)
        await asyncio.sleep(random.uniform(0.02, 0.08))
    return times


async def _rest(drive: Drive) -> None:
    for _ in range(MOST_LOOKS):
        if not (await drive.read()).elevation.moving:
            return
        await asyncio.sleep(LOOK_EVERY_S)
    raise AssertionError("The axis did not stop.")


def _stop_row(name: str, times_ms: Sequence[float]) -> Row:
    ordered = sorted(times_ms)
    p999 = ordered[min(len(ordered) - 1, int(len(ordered) * 0.999))]
    return Row(
        f"jog ends, {name}: {len(ordered)} trials, Modbus TCP, {TRACKERS} trackers at once",
        f"p50 {_p50(ordered):.0f} ms, p99.9 {p999:.0f} ms, max {ordered[-1]:.0f} ms, and the axis's own ramp",
        f"{STOP_LIMIT_MS:.0f} ms",
        f"{p999 / STOP_LIMIT_MS:.2f}",
        COMMAND,
    )


def _p50(ordered: Sequence[float]) -> float:
    return ordered[len(ordered) // 2]


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
