"""A storm over a field, as real processes: the controller lives, ticks come on time, all go to shelter.

Always for 100 trackers at 10 Hz; under `make soak` for 500 and 1,000 trackers at 1 Hz as well.
"""

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

import httpx
import pytest

from app.link.messages import StopAll
from app.link.weather_orders import ReportWeather
from app.tracker.state.snapshot import ActivityName, EventKind
from app.tracker.weather.weather import Weather
from tests.amount import SOAK
from tests.fault_result import BY_ITSELF, REAL, FaultResult
from tests.machine.field import Punctuality, doing, last_of, noon_place, prepare, sheltered
from tests.machine.service import Service
from tests.patience import eventually

TICKS = 10_000
MARGIN = 1.05
LATEST_MS = 50.0
SHELTERED_WITHIN_S = 1.0
READY_WITHIN_S = 20.0
LONGEST_WAIT_S = 120.0
STORM, CALM = (ReportWeather(Weather(wind_mps=wind_mps)) for wind_mps in (28.0, 3.0))
PAGES = ("/", "/trackers/T1", "/trackers/T2/settings", "/api/v1/trackers")


@dataclass(frozen=True, slots=True)
class Size:
    """How many trackers, and how often each ticks."""

    trackers: int
    tick_ms: int

    @property
    def latest_ms(self) -> float:
        """Return how late one tick in a thousand may be; later than its period, the next one is left out.

        How late in milliseconds depends on the computer: `make soak` and `python -m bench storm` hold it to
        the 50 ms that are promised.
        """
        return LATEST_MS if SOAK else float(self.tick_ms)

    @property
    def watched_s(self) -> float:
        """Return how long it takes until enough of them have ticked."""
        return MARGIN * TICKS / self.trackers * self.tick_ms / 1000.0


USUAL, LARGE, LARGEST = Size(100, 100), Size(500, 1000), Size(1000, 1000)


@dataclass(frozen=True, slots=True)
class Watched:
    """One field that runs, and how long it took until panel and controller were ready."""

    service: Service
    size: Size
    ready_s: float

    async def all_in(self, activity: ActivityName) -> None:
        await eventually(
            lambda: doing(self.service.link.latest(), activity) == self.size.trackers,
            within_s=LONGEST_WAIT_S,
        )

    async def calm(self) -> None:
        """Return once all have tracked for a while in calm weather."""
        await self.all_in(ActivityName.TRACKING)
        await self.service.ask(CALM)
        await asyncio.sleep(2.0)

    async def through(self, act: Callable[[], Awaitable[float]]) -> tuple[float, Punctuality]:
        """Do something; return what it took, and how late ticks came of ten thousand."""
        before = await self.service.link.metrics()
        took_s = await act()
        await asyncio.sleep(self.size.watched_s)
        found = Punctuality.between(before, await self.service.link.metrics())
        print(f"{self.size}: {took_s:.2f} s, {found}")
        assert found.ticks >= TICKS
        assert found.p999_ms <= self.size.latest_ms
        assert not self.service.deaths()
        return took_s, found

    async def storm(self) -> float:
        return await last_of(
            self.service, EventKind.STOW_STARTED, STORM, self.size.trackers, within_s=LONGEST_WAIT_S
        )

    async def stop_all(self) -> float:
        return await last_of(
            self.service, EventKind.STOPPED, StopAll(), self.size.trackers, within_s=LONGEST_WAIT_S
        )

    async def open_pages(self) -> float:
        """Open pages of the whole field and of single trackers; return what the slowest took."""
        loop, slowest_s = asyncio.get_running_loop(), 0.0
        address = f"http://127.0.0.1:{self.service.port}"
        async with httpx.AsyncClient(
            base_url=address, timeout=LONGEST_WAIT_S, follow_redirects=True
        ) as panel:
            for page in PAGES * 3:
                begun = loop.time()
                assert (await panel.get(page)).status_code == httpx.codes.OK
                slowest_s = max(slowest_s, loop.time() - begun)
        return slowest_s


@asynccontextmanager
async def field(size: Size, data_dir: Path) -> AsyncIterator[Watched]:
    """Run a field and yield it once panel and controller are ready."""
    loop = asyncio.get_running_loop()
    prepare(data_dir, size.trackers, noon_place(datetime.now(UTC)))
    begun = loop.time()
    service = await Service.start(data_dir, tick_ms=size.tick_ms)
    try:
        await eventually(
            lambda: len(getattr(service.link.latest(), "trackers", ())) == size.trackers,
            within_s=LONGEST_WAIT_S,
        )
        await answers(service.port)
        yield Watched(service, size, loop.time() - begun)
    finally:
        await service.stop()


async def answers(port: int) -> None:
    """Return once the panel says that it is ready."""
    async with httpx.AsyncClient(timeout=5.0) as panel, asyncio.timeout(LONGEST_WAIT_S):
        while True:
            try:
                if (await panel.get(f"http://127.0.0.1:{port}/ready")).status_code == httpx.codes.OK:
                    return
            except httpx.TransportError:
                pass
            await asyncio.sleep(0.05)


@pytest.mark.fault(73)
async def test_a_field_survives_its_storm(tmp_path: Path, fault: FaultResult) -> None:
    """One report of 28 m/s ended the controller, and 76 of 100 trackers stood in the wind."""
    async with field(USUAL, tmp_path / "data") as watched:
        await watched.calm()
        took_s, _ = await watched.through(watched.storm)
        assert took_s <= SHELTERED_WITHIN_S
        assert sheltered(watched.service.link.latest()) == USUAL.trackers
    fault.noticed(took_s, REAL)
    fault.shows_nothing("every tracker stows, and says so")
    fault.recovers(BY_ITSELF)


@pytest.mark.fault(74)
async def test_stop_all_reaches_a_whole_field_at_once(tmp_path: Path, fault: FaultResult) -> None:
    async with field(USUAL, tmp_path / "data") as watched:
        await watched.calm()
        took_s, _ = await watched.through(watched.stop_all)
        assert took_s <= SHELTERED_WITHIN_S
        assert not doing(watched.service.link.latest(), ActivityName.TRACKING)
    fault.noticed(took_s, REAL)
    fault.shows_nothing("every tracker says that it holds")
    fault.recovers("the operator starts tracking again")


@pytest.mark.skipif(not SOAK, reason="runs for minutes; `make soak` includes it")
@pytest.mark.timeout(600)
@pytest.mark.parametrize("size", [LARGE, LARGEST], ids=lambda size: f"{size.trackers}")
async def test_a_large_field_is_ready_soon_and_survives_storm_pages_and_stop_all(
    tmp_path: Path, size: Size
) -> None:
    """Details of the whole field for one page, and collections of garbage, once made ticks 150 ms late; and
    drives whose watchdog was shorter than a tick stopped on the way to shelter."""
    async with field(size, tmp_path / "data") as watched:
        assert watched.ready_s <= READY_WITHIN_S
        await watched.calm()
        await watched.through(watched.open_pages)
        took_s, _ = await watched.through(watched.storm)
        assert took_s <= SHELTERED_WITHIN_S
        assert sheltered(watched.service.link.latest()) == size.trackers
        if size is LARGEST:
            return
        took_s, _ = await watched.through(watched.stop_all)
        assert took_s <= SHELTERED_WITHIN_S
        await eventually(lambda: doing(watched.service.link.latest(), ActivityName.STOWING) == 0)
