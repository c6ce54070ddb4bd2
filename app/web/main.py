"""The panel's process: what it consists of, and how it is served."""

from pathlib import Path

from fastapi import FastAPI
from starlette.middleware.gzip import GZipMiddleware

from app.clock import Clock, SystemClock
from app.link.messages import Machine
from app.settings import Settings
from app.store.store import Reader
from app.web import errors
from app.web.assets import Assets
from app.web.deps import Panel
from app.web.security import Guard, SecurityHeaders
from app.web.ui.pages import include_pages

STATIC = Path(__file__).resolve().parents[2] / "static"


def create_app(
    settings: Settings, *, machine: Machine, reader: Reader, clock: Clock | None = None
) -> FastAPI:
    """Build the whole panel."""
    app = FastAPI(title="Heliopanel", version="1", docs_url=None, redoc_url=None)
    app.state.panel = Panel(settings, machine, reader, clock or SystemClock(), Assets(STATIC))
    app.mount("/s", app.state.panel.assets, name="static")
    include_pages(app)
    errors.install(app)
    app.add_middleware(GZipMiddleware, minimum_size=600)
    app.add_middleware(Guard)
    app.add_middleware(SecurityHeaders)
    return app
