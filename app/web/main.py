"""The panel's process: what it consists of, and how it is served."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

from fastapi import FastAPI
from starlette.middleware.gzip import GZipMiddleware

from app.clock import Clock, SystemClock
from app.link.messages import Machine
from app.settings import Settings
from app.store.store import Reader
from app.web import errors, live
from app.web.api.router import api_router
from app.web.assets import Assets
from app.web.deps import Panel
from app.web.hub import Hub
from app.web.security import Guard, SecurityHeaders
from app.web.simulations import Simulations
from app.web.ui.pages import include_pages

STATIC = Path(__file__).resolve().parents[2] / "static"


@asynccontextmanager
async def _living(app: FastAPI) -> AsyncIterator[None]:
    """Follow the machine for as long as the panel lives."""
    panel: Panel = app.state.panel
    following = asyncio.create_task(panel.hub.run())
    try:
        yield
    finally:
        panel.hub.closing.set()
        panel.simulations.close()
        following.cancel()
        await asyncio.gather(following, return_exceptions=True)


def create_app(
    settings: Settings, *, machine: Machine, reader: Reader, clock: Clock | None = None
) -> FastAPI:
    """Build the whole panel."""
    clock = clock or SystemClock()
    panel = Panel(settings, machine, reader, clock, Assets(STATIC), Hub(machine, clock), Simulations())
    app = FastAPI(title="Heliopanel", version="1", docs_url=None, redoc_url=None, lifespan=_living)
    app.state.panel = panel
    app.mount("/s", panel.assets, name="static")
    app.include_router(live.router)
    app.include_router(api_router())
    include_pages(app)
    errors.install(app)
    app.add_middleware(GZipMiddleware, minimum_size=600)
    app.add_middleware(Guard)
    app.add_middleware(SecurityHeaders)
    return app
