"""What a field of trackers meets in its worst minutes, tried on the whole product as real processes."""

import asyncio
import signal
import tempfile
from collections.abc import AsyncIterator, Collection
from contextlib import AsyncExitStack, asynccontextmanager, suppress
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path

import httpx
from websockets.asyncio.client import connect
from websockets.typing import Origin

from app.link.messages import MachineUnreachable, SetLocation, SiteCommand, StopAll
from app.link.metrics import MachineMetrics
from app.link.weather_orders import ReportWeather
from app.sun.position import Location
from app.tracker.commands.commands import CommandRejected, Track
from app.tracker.settings.config import DriveConfig, DriveKind, SerialConfig
from app.tracker.state.snapshot import ActivityName, Event, EventKind, SiteSnapshot, Snapshot
from app.tracker.weather.weather import Weather
from tests.amount import SOAK
from tests.e2e.product import DRIVE_SIM
from tests.machine.field import (
    Line,
    Punctuality,
    dawn_place,
    doing,
    last_of,
    noon_place,
    prepare,
    sheltered,
)
from tests.machine.service import Service
from tests.patience import PATIENCE_S, eventually
from tests.ports import free_port

LIMIT_S = 120.0
STORM = ReportWeather(Weather(wind_mps=28.0))
CALM = ReportWeather(Weather(wind_mps=3.0))
SILENT_S = 3.0
FRESH_S = 1.5
LATEST_MS = 50.0
PAGES = ("/", "/trackers/T1", "/trackers/T2/settings", "/api/v1/trackers")
WAKES = "begins to follow the sun"


@dataclass(frozen=True, slots=True)
class Size:
    """How many trackers, how often each ticks, and how many ticks are looked at."""

    trackers: int
    tick_ms: int
    ticks: int

    def __str__(self) -> str:
        return f"{self.trackers:,} trackers at {1000 / self.tick_ms:g} Hz"

    @property
    def tick_s(self) -> float:
        """Return the period of a tracker."""
        return self.tick_ms / 1000.0

    @property
    def lasts_s(self) -> float:
        """Return how long it takes until there are enough ticks."""
        return self.ticks / self.trackers * self.tick_s


@dataclass(frozen=True, slots=True)
class Trial:
    """What came of it: in words, how long it took, what was shown, and how punctual ticks were."""

    what: str
    took_s: float
    shown: str
    found: Punctuality
    back_s: float = 0.0

    def assert_punctual(self) -> None:
        """Fail if ticks came late; a computer without other work is held to 99.9 % of ten thousand."""
        print(self.what, self.found)
        assert self.found.p99_ms <= LATEST_MS
        assert not SOAK or self.found.p999_ms <= LATEST_MS
        assert not SOAK or self.found.ticks >= 10_000


class Fieldwork:
    """One running field: what is done to it, and what comes of it."""

    def __init__(self, service: Service, size: Size) -> None:
        self.service = service
        self.size = size
        self.events: list[Event] = []

    @property
    def latest(self) -> SiteSnapshot | None:
        """Return what is known of the site."""
        return self.service.link.latest()

    @property
    def names(self) -> list[str]:
        """Return the names of all trackers."""
        return [f"T{number + 1}" for number in range(self.size.trackers)]

    async def note_events(self) -> None:
        """Keep every event, until cancelled."""
        async for update in self.service.link.updates():
            self.events += update.events

    async def all_in(self, activity: ActivityName) -> None:
        """Return once every tracker does this."""
        await eventually(lambda: doing(self.latest, activity) == self.size.trackers, within_s=LIMIT_S)

    async def tracking(self) -> None:
        """Have every tracker track, as an operator does where one lost its drive in a busy start."""
        async with asyncio.timeout(LIMIT_S):
            while self.latest is None or doing(self.latest, ActivityName.TRACKING) < self.size.trackers:
                for one in () if self.latest is None else self.latest.trackers:
                    if one.activity is ActivityName.HOLDING and one.unreachable is None:
                        with suppress(CommandRejected, MachineUnreachable):
                            await self.service.ask(Track(), one.tracker_id)
                await asyncio.sleep(1.0)

    async def said(
        self, kind: EventKind, names: Collection[str], since: datetime, words: str = ""
    ) -> list[Event]:
        """Return what each of these trackers said first of this kind, once all have; in its order."""

        def first() -> dict[str, Event]:
            found: dict[str, Event] = {}
            for event in self.events:
                fits = event.kind is kind and event.at >= since and words in event.message
                if fits and event.tracker_id in names:
                    found.setdefault(str(event.tracker_id), event)
            return found

        await eventually(lambda: len(first()) == len(names), within_s=LIMIT_S)
        return sorted(first().values(), key=lambda event: event.at)

    async def trial(self, what: str, took_s: float, shown: str = "", back_s: float = 0.0) -> Trial:
        """Return what came of it and how punctual ticks were since it began, of enough of them."""
        ticks = 0
        async with asyncio.timeout(LIMIT_S):
            while ticks < self.size.ticks:
                await asyncio.sleep(self.size.lasts_s / 10.0)
                found = Punctuality.between(self.before, await self.metrics())
                ticks = found.ticks
        assert not [death for death in self.service.deaths() if not death.startswith("web")]
        return Trial(what, took_s, shown, found, back_s)

    async def begin(self) -> None:
        """Count ticks from now on."""
        self.before = await self.metrics()

    async def metrics(self) -> MachineMetrics:
        """Return the controller's counters."""
        return await self.service.link.metrics()


@asynccontextmanager
async def field(
    size: Size,
    location: Location,
    line: Line | None = None,
    *,
    settled: bool = True,
    revision: int = 1,
) -> AsyncIterator[tuple[Fieldwork, float]]:
    """Run a field; yield it once every tracker tracks, and after how long panel and controller were ready."""
    with tempfile.TemporaryDirectory() as folder:
        prepare(Path(folder) / "data", size.trackers, location, line, revision=revision)
        begun = asyncio.get_running_loop().time()
        service = await Service.start(Path(folder) / "data", tick_ms=size.tick_ms)
        work = Fieldwork(service, size)
        noting = asyncio.create_task(work.note_events())
        try:
            await service.until_served()
            await eventually(
                lambda: len(getattr(work.latest, "trackers", ())) == size.trackers, within_s=LIMIT_S
            )
            ready_s = asyncio.get_running_loop().time() - begun
            if settled:
                await work.all_in(ActivityName.TRACKING)
                await service.ask(CALM)
                await asyncio.sleep(2.0 * size.tick_s)
            yield work, ready_s
        finally:
            noting.cancel()
            await asyncio.gather(noting, return_exceptions=True)
            await service.stop()


async def storm(size: Size) -> Trial:
    """Report a wind over the limit."""
    return await _by_all(size, EventKind.STOW_STARTED, STORM, "stowing")


async def stop_all(size: Size) -> Trial:
    """Stop all trackers."""
    return await _by_all(size, EventKind.STOPPED, StopAll(), "stopped")


async def _by_all(size: Size, kind: EventKind, order: SiteCommand, done: str) -> Trial:
    """Give an order; what it took is until the last tracker says that it does it."""
    async with field(size, noon_place(datetime.now(UTC))) as (work, _):
        await work.begin()
        took_s = await last_of(work.service, kind, order, size.trackers, within_s=LIMIT_S)
        await eventually(lambda: not doing(work.latest, ActivityName.TRACKING))
        assert order is not STORM or sheltered(work.latest) == size.trackers
        return await work.trial(f"all {done} after {took_s:.2f} s", took_s)


async def open_pages(size: Size) -> Trial:
    """Open pages of the whole field and of single trackers; what it took is the slowest of them."""
    async with (
        field(size, noon_place(datetime.now(UTC))) as (work, _),
        httpx.AsyncClient(
            base_url=f"http://127.0.0.1:{work.service.port}", timeout=LIMIT_S, follow_redirects=True
        ) as panel,
    ):
        await work.begin()
        took_s = []
        for page in PAGES * 3:
            answer = await panel.get(page)
            assert answer.status_code == httpx.codes.OK
            took_s.append(answer.elapsed.total_seconds())
        return await work.trial(f"the slowest page took {max(took_s):.2f} s", max(took_s))


async def sunrise(size: Size, *, ahead_s: float) -> Trial:
    """Let the sun rise over a field that sleeps; what it took is from the first to wake to the last."""
    begun = datetime.now(UTC)
    place = dawn_place(begun + timedelta(hours=1))
    async with field(size, place, revision=2) as (work, _):
        await work.service.ask(StopAll())
        await work.all_in(ActivityName.HOLDING)
        sunrise_at = datetime.now(UTC) + timedelta(seconds=ahead_s)
        await work.service.ask(SetLocation(dawn_place(sunrise_at), "UTC"))
        for name in work.names:
            await work.service.ask(Track(), name)
        await work.begin()
        assert not [one for one in work.events if WAKES in one.message], "nobody is awake before"
        woken = await work.said(EventKind.MOTION_ANNOUNCED, work.names, begun, WAKES)
        took_s = (woken[-1].at - woken[0].at).total_seconds()
        return await work.trial(f"all awake within {took_s:.2f} s", took_s, woken[0].message)


def gateway(drives: int, folder: Path, kind: DriveKind, *, watchdog_ms: int = 500) -> Line:
    """Return a gateway with so many drives behind it."""
    return Line(DriveConfig(kind, port=free_port()), drives, folder / "drives" / "p.json", watchdog_ms)


def serial_line(drives: int, folder: Path, baud_rate: int) -> Line:
    """Return a serial line with so many drives, at the pace of its baud rate."""
    serial = SerialConfig(str(folder / "line"), baud_rate)
    return Line(DriveConfig(DriveKind.MODBUS_RTU, serial=serial), drives, folder / "drives" / "p.json")


async def loss_of_a_line(size: Size, line: Line) -> Trial:
    """Silence a line for a while: how long until all its trackers say so, and until all are back."""
    names = [f"T{unit + 1}" for unit in range(line.drives)]
    async with _on_a_line(size, line) as (work, simulator):
        await work.begin()
        lost_at = datetime.now(UTC)
        simulator.send_signal(signal.SIGSTOP)
        lost = await work.said(EventKind.DRIVE_LOST, names, lost_at)
        took_s = (lost[-1].at - lost_at).total_seconds()
        await asyncio.sleep(max(0.0, SILENT_S - took_s))
        held = [one for one in _on(work, names) if one.activity is ActivityName.HOLDING]
        assert len(held) == line.drives, "a tracker without contact holds"
        back_at = datetime.now(UTC)
        simulator.send_signal(signal.SIGCONT)
        back = await work.said(EventKind.DRIVE_FOUND, names, back_at)
        back_s = (back[-1].at - back_at).total_seconds()
        await eventually(lambda: all((one.position_age_s or 0.0) < FRESH_S for one in _on(work, names)))
        what = f"all {line.drives} say so after {took_s:.2f} s and are back after {back_s:.2f} s"
        return await work.trial(what, took_s, lost[-1].message, back_s)


def _on(work: Fieldwork, names: Collection[str]) -> list[Snapshot]:
    assert work.latest is not None
    return [one for one in work.latest.trackers if one.tracker_id in names]


@asynccontextmanager
async def _on_a_line(size: Size, line: Line) -> AsyncIterator[tuple[Fieldwork, asyncio.subprocess.Process]]:
    """Run a field some of whose drives hang on a line, in a program of its own."""
    line.memory.parent.mkdir(exist_ok=True)
    location = noon_place(datetime.now(UTC))
    with tempfile.TemporaryDirectory() as folder:
        prepare(Path(folder) / "unused", 0, location, line)
    simulator = await asyncio.create_subprocess_exec(*DRIVE_SIM, *line.doors, stdout=asyncio.subprocess.PIPE)
    try:
        assert simulator.stdout is not None
        async with asyncio.timeout(PATIENCE_S):
            await simulator.stdout.readline()
        async with field(size, location, line, settled=False) as (work, _):
            await work.tracking()
            yield work, simulator
    finally:
        simulator.send_signal(signal.SIGCONT)
        simulator.terminate()
        await simulator.wait()


async def web_restart(size: Size, *, viewers: int) -> Trial:
    """Kill the web process in a storm while pages are open: how long until each of them is told again."""
    async with field(size, noon_place(datetime.now(UTC))) as (work, _), AsyncExitStack() as pages:
        watching = [Viewer(work.service.port) for _ in range(viewers)]
        for one in watching:
            await pages.enter_async_context(one.open())
        await eventually(lambda: all(one.told for one in watching), within_s=LIMIT_S)
        await work.begin()
        stowing = asyncio.create_task(
            last_of(work.service, EventKind.STOW_STARTED, STORM, size.trackers, within_s=LIMIT_S)
        )
        loop = asyncio.get_running_loop()
        killed_s = loop.time()
        lives = [one.lives for one in watching]
        work.service.signal("web", signal.SIGKILL)
        took_s = await stowing
        await eventually(
            lambda: all(one.lives > was and one.told for one, was in zip(watching, lives, strict=True)),
            within_s=LIMIT_S,
        )
        back_s = loop.time() - killed_s
        assert sheltered(work.latest) == size.trackers
        what = f"all stowing after {took_s:.2f} s, {viewers} viewers back after {back_s:.1f} s"
        return await work.trial(what, took_s, back_s=back_s)


class Viewer:
    """A page that opens its stream again when it is cut; like a browser it takes a frame of any size."""

    def __init__(self, port: int) -> None:
        self._port = port
        self.lives = 0
        self.told = False

    @asynccontextmanager
    async def open(self) -> AsyncIterator[None]:
        """Watch until the end."""
        task = asyncio.create_task(self._watch())
        try:
            yield
        finally:
            task.cancel()
            await asyncio.gather(task, return_exceptions=True)

    async def _watch(self) -> None:
        address, origin = f"ws://127.0.0.1:{self._port}/live", Origin(f"http://127.0.0.1:{self._port}")
        while True:
            with suppress(Exception):
                async with connect(address, origin=origin, max_size=None) as page:
                    self.lives, self.told = self.lives + 1, False
                    async for _ in page:
                        self.told = True
            await asyncio.sleep(0.3)


async def start(size: Size) -> tuple[Trial, float]:
    """Start a field; return how it ticks, and after how long panel and controller were ready."""
    async with field(size, noon_place(datetime.now(UTC))) as (work, ready_s):
        await work.begin()
        return await work.trial("steady", ready_s), ready_s
