"""A field in its worst minutes: how late ticks come, and how soon every tracker is on its way to shelter

The product runs as its users start it (`heliopanel serve`), with trackers that are prepared in its database:
homed, tracking, with simulated drives of its own; those of the line hang on a serial bus over TCP. The
controller asks the system for real-time scheduling, which only root gets: without it other programs of the
computer delay its ticks, and the figures are theirs too.
"""

import asyncio
import os
import signal
import tempfile
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path

import httpx
from websockets.asyncio.client import connect
from websockets.typing import Origin

from app.link.messages import StopAll
from app.link.metrics import MachineMetrics
from app.link.weather_orders import ReportWeather
from app.sun.position import Location
from app.tracker.snapshot import ActivityName, EventKind, SiteSnapshot
from app.tracker.weather import Weather
from bench.table import Row, at_most, must_hold
from tests.e2e.product import DRIVE_SIM
from tests.machine.field import Line, Punctuality, dawn_place, doing, last_of, noon_place, prepare
from tests.machine.service import Service, end, eventually
from tests.ports import free_port

COMMAND = "python -m bench storm"
TICKS = int(os.environ.get("HELIOPANEL_BENCH_STORM_TICKS", "12000"))
LATEST_MS = 50.0
SHELTERED_WITHIN_S = 1.0
READY_WITHIN_S = 20.0
LIMIT_S = 120.0
STORM = ReportWeather(Weather(wind_mps=28.0))
CALM = ReportWeather(Weather(wind_mps=3.0))
VIEWERS = 20
ON_THE_LINE = 64
SILENT_S = 4.0
SUNRISE_IN_S = 30.0


@dataclass(frozen=True, slots=True)
class Size:
    """How many trackers, and how often each ticks."""

    trackers: int
    tick_ms: int

    def __str__(self) -> str:
        return f"{self.trackers:,} trackers at {1000 / self.tick_ms:g} Hz"

    @property
    def lasts_s(self) -> float:
        """Return how long it takes until there are enough ticks for the percentiles."""
        return TICKS / self.trackers * self.tick_ms / 1000.0


class Fieldwork:
    """One running field: what is done to it, and what comes of it."""

    def __init__(self, service: Service, size: Size) -> None:
        self.service = service
        self.size = size
        self.in_time = True

    @property
    def latest(self) -> SiteSnapshot | None:
        return self.service.link.latest()

    async def all_in(self, activity: ActivityName) -> None:
        await eventually(lambda: doing(self.latest, activity) == self.size.trackers, within_s=LIMIT_S)

    async def metrics(self) -> MachineMetrics:
        return await self.service.link.metrics()

    async def through(self, act: Callable[[], Awaitable[str]]) -> tuple[str, Punctuality]:
        """Do something; return what came of it and how punctual ticks were, of enough of them."""
        loop = asyncio.get_running_loop()
        before, until = await self.metrics(), loop.time() + self.size.lasts_s
        what = await act()
        await asyncio.sleep(max(0.0, until - loop.time()))
        found = Punctuality.between(before, await self.metrics())
        assert not self.service.deaths(), self.service.deaths()
        return what, found

    async def storm(self) -> str:
        """Report a storm and return when all trackers were on their way to shelter."""
        took_s = await last_of(
            self.service, EventKind.STOW_STARTED, STORM, self.size.trackers, within_s=LIMIT_S
        )
        self.in_time = took_s <= SHELTERED_WITHIN_S
        return f"all stowing after {took_s:.2f} s"

    async def stop_all(self) -> str:
        took_s = await last_of(
            self.service, EventKind.STOPPED, StopAll(), self.size.trackers, within_s=LIMIT_S
        )
        self.in_time = took_s <= SHELTERED_WITHIN_S
        return f"all stopped after {took_s:.2f} s"

    async def steady(self) -> str:
        return "steady"

    async def sunrise(self) -> str:
        """Wait for the sunrise and return how many trackers the sun has woken."""
        night = doing(self.latest, ActivityName.TRACKING)
        await asyncio.sleep(SUNRISE_IN_S)
        return f"{night} waited for it"


@asynccontextmanager
async def field(
    size: Size, location: Location, line: Line | None = None, *, settled: bool = True
) -> AsyncIterator[tuple[Fieldwork, float]]:
    """Run a field; yield it once every tracker tracks, and after how long panel and controller were ready."""
    with tempfile.TemporaryDirectory() as folder:
        prepare(Path(folder) / "data", size.trackers, location, line)
        begun = asyncio.get_running_loop().time()
        service = await Service.start(Path(folder) / "data", tick_ms=size.tick_ms)
        try:
            work = Fieldwork(service, size)
            await _panel_answers(service.port)
            await eventually(
                lambda: len(getattr(work.latest, "trackers", ())) == size.trackers, within_s=LIMIT_S
            )
            ready_s = asyncio.get_running_loop().time() - begun
            if settled:
                await work.all_in(ActivityName.TRACKING)
                await service.ask(CALM)
                await asyncio.sleep(2.0 + 2.0 * size.tick_ms / 1000.0)
            yield work, ready_s
        finally:
            await service.stop()


async def _panel_answers(port: int) -> None:
    async with httpx.AsyncClient(timeout=5.0) as panel, asyncio.timeout(LIMIT_S):
        while True:
            with suppress(httpx.TransportError):
                if (await panel.get(f"http://127.0.0.1:{port}/ready")).status_code == httpx.codes.OK:
                    return
            await asyncio.sleep(0.05)


def measure() -> list[Row]:
    """Return a row for every trial of every size."""
    return asyncio.run(_rows())


async def _rows() -> list[Row]:
    rows = []
    for size in (Size(100, 100), Size(500, 1000)):
        rows += [
            await _storm(size),
            await _stop_all(size),
            await _sunrise(size),
            await _line(size),
            await _viewers(size),
        ]
    return [*rows, *await _largest(Size(1000, 1000))]


async def _storm(size: Size) -> Row:
    async with field(size, noon_place(datetime.now(UTC))) as (work, _):
        return _row(f"wind over the limit, {size}", *await work.through(work.storm), in_time=work.in_time)


async def _stop_all(size: Size) -> Row:
    async with field(size, noon_place(datetime.now(UTC))) as (work, _):
        return _row(f"Stop all, {size}", *await work.through(work.stop_all), in_time=work.in_time)


async def _sunrise(size: Size) -> Row:
    at = datetime.now(UTC) + timedelta(seconds=SUNRISE_IN_S)
    async with field(size, dawn_place(at)) as (work, _):
        return _row(f"sunrise, {size}", *await work.through(work.sunrise))


async def _line(size: Size) -> Row:
    with tempfile.TemporaryDirectory() as folder:
        line = Line(free_port(), ON_THE_LINE, Path(folder) / "positions.json")
        location = noon_place(datetime.now(UTC))
        async with field_on_line(size, location, line) as (work, simulator):

            async def lose() -> str:
                simulator.send_signal(signal.SIGSTOP)
                await asyncio.sleep(SILENT_S)
                simulator.send_signal(signal.SIGCONT)
                return f"the line with {ON_THE_LINE} drives was silent for {SILENT_S:g} s"

            return _row(f"loss and return of a line, {size}", *await work.through(lose))


@asynccontextmanager
async def field_on_line(
    size: Size, location: Location, line: Line
) -> AsyncIterator[tuple[Fieldwork, asyncio.subprocess.Process]]:
    """Run a field some of whose drives hang on a line, in a program of its own."""
    line.memory.parent.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        prepare(Path(folder) / "unused", 0, location, line)
    units = [word for unit in range(1, line.drives + 1) for word in ("--unit", str(unit))]
    where = ("--rtu-over-tcp", f"127.0.0.1:{line.port}", "--memory", str(line.memory))
    simulator = await asyncio.create_subprocess_exec(
        *DRIVE_SIM, *where, *units, stdout=asyncio.subprocess.PIPE
    )
    try:
        assert simulator.stdout is not None
        await simulator.stdout.readline()
        async with field(size, location, line, settled=False) as (work, _):
            await eventually(
                lambda: doing(work.latest, ActivityName.TRACKING) >= size.trackers * 0.95, within_s=LIMIT_S
            )
            yield work, simulator
    finally:
        simulator.send_signal(signal.SIGCONT)
        await end(simulator)


async def _viewers(size: Size) -> Row:
    async with field(size, noon_place(datetime.now(UTC))) as (work, _):
        port = work.service.port
        watching = [asyncio.create_task(_watch(port)) for _ in range(VIEWERS)]

        async def restart() -> str:
            await asyncio.sleep(2.0)
            work.service.signal("web", signal.SIGKILL)
            await _panel_answers(port)
            return f"{VIEWERS} viewers came back"

        try:
            before = await work.metrics()
            what = await restart()
            await asyncio.sleep(size.lasts_s)
            found = Punctuality.between(before, await work.metrics())
        finally:
            for task in watching:
                task.cancel()
            await asyncio.gather(*watching, return_exceptions=True)
        return _row(f"restart of the web process, {size}", what, found)


async def _watch(port: int) -> None:
    """Be a page that is open, and that opens its stream again when it is cut."""
    address, origin = f"ws://127.0.0.1:{port}/live", Origin(f"http://127.0.0.1:{port}")
    while True:
        with suppress(OSError, Exception):
            async with connect(address, origin=origin) as page:
                async for _ in page:
                    pass
        await asyncio.sleep(0.3)


async def _largest(size: Size) -> list[Row]:
    async with field(size, noon_place(datetime.now(UTC))) as (work, ready_s):
        ready = at_most(f"start, {size}, panel and controller ready", ready_s, READY_WITHIN_S, "s", COMMAND)
        steady = _row(f"steady, {size}", *await work.through(work.steady))
        return [
            ready,
            steady,
            _row(f"wind over the limit, {size}", *await work.through(work.storm), in_time=work.in_time),
        ]


def _row(name: str, what: str, found: Punctuality, *, in_time: bool = True) -> Row:
    ours = f"{what}; {found}"
    if not in_time:
        return must_hold(name, ours, f"all within {SHELTERED_WITHIN_S:g} s", COMMAND, holds=False)
    return at_most(name, found.p999_ms, LATEST_MS, "ms", COMMAND, ours=ours)
