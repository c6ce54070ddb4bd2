"""A site with its other doors: the site on a virtual clock, the doors on real sockets and in a hurry."""

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from datetime import UTC, datetime, timedelta
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from app.base.clock import VirtualClock
from app.base.settings import Settings
from app.gateway.gateways import Gateways
from app.link.metrics import GatewayMetrics
from app.store.engine import open_writer
from app.store.migrations import upgrade
from app.store.store import Writer
from app.store.writer_thread import WriterThread
from app.tracker.memory.memory import TrackerMemory, TrackerState
from app.tracker.settings.config import TrackerConfig
from tests.patience import LOOK_EVERY_S, PATIENCE_S, pause
from tests.site.plant import Plant, make_plant


class HurriedClock(VirtualClock):
    """Ten times as fast as this loop turns: what holds the loop up holds its time up as well."""

    def __init__(self) -> None:
        super().__init__(datetime(2027, 6, 21, 9, 40, tzinfo=UTC))
        self._passing = asyncio.create_task(self._pass())

    async def _pass(self) -> None:
        while True:
            await pause()
            self.advance(timedelta(seconds=10.0 * LOOK_EVERY_S))


def tracker(tracker_id: str, name: str = "Tracker") -> TrackerState:
    return TrackerState(TrackerConfig(tracker_id, f"{name} {tracker_id}"), TrackerMemory())


async def gateway(gateways: Gateways, name: str) -> GatewayMetrics:
    return next(one for one in (await gateways.metrics()).gateways if one.name.startswith(name))


async def until(
    gateways: Gateways, found: Callable[[GatewayMetrics], bool], name: str = "MQTT"
) -> GatewayMetrics:
    """Return what a door tells of itself once it is so."""
    async with asyncio.timeout(PATIENCE_S):
        while not found(seen := await gateway(gateways, name)):
            await pause()
    return seen


def mqtt_settings(data_dir: Path, port: int, **more: Any) -> Settings:
    return Settings(data_dir=data_dir, mqtt_host="127.0.0.1", mqtt_port=port, mqtt_base_topic="plant", **more)


@cache
def empty_database() -> bytes:
    """Return a database of this version, made once."""
    with TemporaryDirectory() as folder:
        upgrade(f"sqlite:///{folder}/heliopanel.db")
        return (Path(folder) / "heliopanel.db").read_bytes()


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
    (data_dir / "heliopanel.db").write_bytes(empty_database())
    store = open_writer(f"sqlite:///{data_dir / 'heliopanel.db'}")
    background = WriterThread(store, lambda error: None)
    plant = make_plant(writer=background, trackers=tuple(map(tracker, trackers or ("T1",))))
    await plant.start()
    try:
        yield plant, store
    finally:
        await plant.close()
        background.close()
        store.close()
