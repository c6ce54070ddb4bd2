"""A client of the whole panel with the real site behind it, on a virtual clock and a database in a folder."""

import asyncio
from contextlib import AsyncExitStack
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import httpx

from app.base.settings import Settings
from app.store.engine import open_reader, open_writer
from app.store.migrations import upgrade
from app.web.main import create_app
from tests.fakes import serving
from tests.patience import PATIENCE_S
from tests.site.direct_writer import DirectWriter
from tests.site.plant import make_plant


class Desk:
    """Asks the API and lets virtual time pass."""

    def __init__(self, folder: Path) -> None:
        self.settings = Settings(data_dir=folder)
        upgrade(self.settings.url)
        self._writer = open_writer(self.settings.url)
        self.plant = make_plant(writer=DirectWriter(self._writer))
        reader = open_reader(self.settings.url)
        self.app = create_app(self.settings, machine=self.plant.site, reader=reader, clock=self.plant.clock)
        self._stack = AsyncExitStack()

    async def __aenter__(self) -> Self:
        await self.plant.start()
        self._client = await self._stack.enter_async_context(serving(self.app))
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self._stack.aclose()
        await self.plant.close()
        self._writer.close()

    async def ask(self, method: str, path: str, **more: Any) -> httpx.Response:
        """Return the answer; the machine's clock stands still meanwhile."""
        return await asyncio.wait_for(self._client.request(method, path, **more), PATIENCE_S)

    async def forward(self, seconds: float) -> None:
        """Let the machine live for a while."""
        await self.plant.forward(seconds=seconds)
