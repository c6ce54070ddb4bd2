"""A site with its other doors: the site on a virtual clock, the doors on real sockets and in a hurry."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from datetime import UTC, datetime, timedelta
from pathlib import Path

from app.base.settings import Settings
from app.gateway.gateways import Gateways
from app.link.metrics import GatewayMetrics
from app.store.engine import open_writer
from app.store.migrations import upgrade
from app.store.store import Writer
from app.store.writer_thread import WriterThread
from app.tracker.memory.memory import TrackerMemory, TrackerState
from app.tracker.settings.config import TrackerConfig
from tests.site.plant import Plant, make_plant


class HurriedClock:
    """Real time, ten times as fast: gateways pace themselves by it."""

    def __init__(self) -> None:
        self._loop = asyncio.get_running_loop()
        self._begun_s = self._loop.time()

    def now(self) -> datetime:
        passed_s = self._loop.time() - self._begun_s
        return datetime(2027, 6, 21, 9, 40, tzinfo=UTC) + timedelta(seconds=10.0 * passed_s)

    async def sleep_until(self, at: datetime) -> None:
        await asyncio.sleep(max(0.0, (at - self.now()).total_seconds() / 10.0))


def tracker(tracker_id: str, name: str = "Tracker") -> TrackerState:
    return TrackerState(TrackerConfig(tracker_id, f"{name} {tracker_id}"), TrackerMemory())


async def gateway(gateways: Gateways, name: str) -> GatewayMetrics:
    return next(one for one in (await gateways.metrics()).gateways if one.name.startswith(name))


@asynccontextmanager
async def opened(plant: Plant, settings: Settings, store: Writer) -> AsyncIterator[Gateways]:
    """Open the doors of a running site."""
    gateways = Gateways(plant.site, HurriedClock(), settings, store)
    gateways.start()
    try:
        yield gateways
    finally:
        await gateways.close()


@asynccontextmanager
async def kept_plant(data_dir: Path, *trackers: str) -> AsyncIterator[tuple[Plant, Writer]]:
    """A site that keeps its journal in a database, as the machine does."""
    url = f"sqlite:///{data_dir / 'heliopanel.db'}"
    upgrade(url)
    store = open_writer(url)
    background = WriterThread(store, lambda error: None)
    plant = make_plant(writer=background, trackers=tuple(map(tracker, trackers or ("T1",))))
    await plant.start()
    try:
        yield plant, store
    finally:
        await plant.close()
        background.close()
        store.close()
