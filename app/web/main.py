"""The panel's process: what it consists of, and how it is served."""

import asyncio
import gc
from collections.abc import AsyncIterator, Callable
from contextlib import AsyncExitStack, asynccontextmanager
from functools import cache, partial

import uvicorn
from fastapi import APIRouter, FastAPI
from starlette.middleware.body_limit import RequestBodyLimitMiddleware
from starlette.middleware.gzip import GZipMiddleware
from starlette.routing import BaseRoute

from app.access.opening import open_keeper
from app.access.passwords import Hasher
from app.base.build import VERSION
from app.base.clock import Clock, SystemClock
from app.base.errors import Foreseen
from app.base.lasting import lasting
from app.base.logs import get_logger, set_up_logs
from app.base.own import own_folder
from app.base.permission import Permission
from app.base.settings import Settings, fixed_by_environment
from app.base.startup import settle
from app.base.turnstile import Turnstile
from app.link.client import LinkClient
from app.link.messages import Machine
from app.store.engine import open_reader
from app.store.reader import DatabaseReader
from app.store.store import Reader
from app.web import sockets
from app.web.documented import DocumentedApp
from app.web.features.operations.operations_api import router as operations
from app.web.http import errors, manual
from app.web.http.assets import Assets
from app.web.http.gate import Gate, record_foreign
from app.web.http.head import HeadAsGet
from app.web.http.late_routes import LateRoute
from app.web.http.limits import StreamLimit
from app.web.http.mdns import announced
from app.web.http.needs import Need, need_of, needs
from app.web.http.nesting import NestingLimit
from app.web.http.network import NOT_SERVED, NetworkDesk, Stage
from app.web.http.routes import guarded_routes
from app.web.http.security import LARGEST_BODY, Guard, SecurityHeaders, Uploads, host_names
from app.web.http.served_certificate import ServedCertificate
from app.web.http.server import (
    FAREWELL_S,
    KEEP_ALIVE_S,
    LARGEST_MESSAGE,
    PING_S,
    Connections,
    PanelServer,
    cautious,
    reserve_descriptors,
)
from app.web.languages.choice import Speech
from app.web.live.hub import Hub
from app.web.live.live_protocol import cautious_sockets
from app.web.pages import ROUTERS, error_page
from app.web.router import api_routes
from app.web.services.simulations import Simulations
from app.web.services.studies import Studies
from app.web.shell.asked import AskFirst
from app.web.shell.deps import Panel
from app.web.shell.render import environment

log = get_logger()

SMALLEST_COMPRESSED = 600


def create_app(
    settings: Settings,
    *,
    machine: Machine | None = None,
    reader: Reader | None = None,
    clock: Clock | None = None,
    hasher: Hasher | None = None,
    stage: Stage | None = None,
) -> DocumentedApp:
    """Build the whole panel; without a machine it connects to the one that the settings name.

    `stage` says whether these settings are on trial; without one they are for good.
    """
    clock = clock or SystemClock()
    machine = machine or LinkClient(settings.link_path, clock)
    reader = reader or open_reader(settings.url)
    app = DocumentedApp(
        title="Heliopanel",
        version=VERSION,
        description=DESCRIPTION,
        docs_url=None,
        redoc_url=None,
        openapi_url="/api/v1/openapi.json",
        separate_input_output_schemas=False,
        lifespan=_living,
    )
    hub = Hub(machine, clock)
    studies = Studies(settings.data_dir, clock)
    keeper = open_keeper(settings, clock, hasher)
    network = NetworkDesk(stage or Stage(settings), clock, keeper)
    panel = Panel(settings, machine, reader, clock, _assets(), hub, Simulations(), studies, keeper, network)
    app.state.panel = panel
    app.state.certificate = ServedCertificate(settings, machine, clock)
    app.state.templates, app.state.error_page = environment(), error_page
    app.mount("/s", panel.assets, name="static")
    needs(Permission.READ)(panel.manual)
    app.mount(manual.PATH, panel.manual, name="manual")
    app.router.routes.extend(_doors())
    app.state.routes = guarded_routes(app.routes)
    errors.install(app)
    _wrap(app, panel)
    return app


def _wrap(app: DocumentedApp, panel: Panel) -> None:
    """Put around the routes what every request passes, the innermost first."""
    app.add_middleware(AskFirst)
    app.add_middleware(NestingLimit)
    app.add_middleware(Uploads)
    app.add_middleware(RequestBodyLimitMiddleware, max_body_size=LARGEST_BODY)
    app.add_middleware(GZipMiddleware, minimum_size=SMALLEST_COMPRESSED)
    app.add_middleware(Gate, panel_app=app, keeper=panel.keeper, clock=panel.clock, routes=app.state.routes)
    app.add_middleware(StreamLimit, clock=panel.clock)
    app.add_middleware(
        Guard, hosts=host_names(panel.settings), on_refusal=record_foreign(panel.keeper, panel.clock)
    )
    app.add_middleware(SecurityHeaders)
    app.add_middleware(Speech)
    app.add_middleware(HeadAsGet)


NOWHERE = {"type": "http", "method": "GET", "path": "/-", "root_path": "", "headers": []}
"""A request that no route answers. FastAPI works an included router's routes out at the first request that
comes by; left to the first one in service, that held up a heartbeat of hold-to-run for 250 ms."""

DESCRIPTION = """Everything that the browser can do, through the same calls.

Field names carry units. Azimuth is clockwise from true north, elevation above the horizon, longitude positive
east. Instants are ISO 8601 with offset. Errors are `application/problem+json` (RFC 9457); a 409 has `reasons`
with every unmet condition. Motion answers 202 with the snapshot; `activity` and `in_position` tell when it is
done. A repeated request with the same `Idempotency-Key` is done once; one whose `issued_at` is more than 2 s
old, or more than 2 s ahead of the site's clock, is refused. The live socket of the pages is `/live`; for
programs there is `/api/v1/stream`."""


@cache
def _doors() -> tuple[BaseRoute, ...]:
    """Return all ways in, shared by every panel of the process; what stops is worked out beforehand."""
    root = APIRouter()
    root.include_router(operations, include_in_schema=False)
    pages = [route for router in ROUTERS for route in router.routes]
    doors = (*sockets.router.routes, *api_routes(), *root.routes, *pages)
    for door in doors:
        door.matches(NOWHERE)
        if isinstance(door, LateRoute) and need_of(door.endpoint) == Need(Permission.STOP):
            door.work_out()
    return doors


@cache
def _assets() -> Assets:
    """Return the static files; their hash is worked out once."""
    return Assets(own_folder("static"))


@asynccontextmanager
async def _living(app: FastAPI) -> AsyncIterator[None]:
    """Follow the machine for as long as the panel lives."""
    panel: Panel = app.state.panel
    async with AsyncExitStack() as stack:
        if isinstance(panel.machine, LinkClient):
            await stack.enter_async_context(panel.machine)
        if isinstance(panel.reader, DatabaseReader):
            stack.callback(panel.reader.close)
        stack.callback(panel.keeper.close)
        if panel.settings.mdns:
            await stack.enter_async_context(announced(panel.settings))
        following = asyncio.gather(
            lasting("live values", panel.hub.run, panel.clock),
            lasting("access", panel.keeper.run, panel.clock),
            lasting("network", panel.network.run, panel.clock),
            lasting("certificate", app.state.certificate.run, panel.clock),
        )
        try:
            yield
        finally:
            panel.hub.closing.set()
            panel.simulations.close()
            await panel.studies.close()
            following.cancel()
            await asyncio.gather(following, return_exceptions=True)


OnAnswer = Callable[[Settings], None]
"""Told, each time the panel begins to answer, with which settings."""


def run(settings: Settings, clock: Clock | None = None, on_answer: OnAnswer | None = None) -> None:
    """Serve the panel until it is told to end; a change of its network is tried, kept or taken back here."""
    set_up_logs("web", log_format=settings.log_format, log_level=settings.log_level)
    clock = clock or SystemClock()
    stage: Stage | None = Stage(settings, fixed_by_environment())
    while stage is not None:
        serve = _serve if stage.trial is None else _try
        stage = serve(stage, clock, on_answer)
        gc.unfreeze()
        if stage is not None:
            gc.collect()


def _try(stage: Stage, clock: Clock, on_answer: OnAnswer | None) -> Stage | None:
    """Serve settings that are on trial; where that fails, what was in force is next."""
    try:
        return _serve(stage, clock, on_answer)
    except (OSError, SystemExit, Foreseen) as error:
        log.error("network_not_served", reason=str(error))
        return stage.back(NOT_SERVED)


def _serve(stage: Stage, clock: Clock, on_answer: OnAnswer | None) -> Stage | None:
    """Serve one stage and return what to serve next, None if the panel was told to end."""
    settings = stage.settings
    app = create_app(settings, clock=clock, stage=stage)
    panel: Panel = app.state.panel
    told = None if on_answer is None else partial(on_answer, settings)
    config = configured(app, settings)
    app.state.certificate.context = lambda: config.ssl if config.loaded else None
    server = PanelServer(config, panel.hub.closing.set, told)
    panel.network.restart = server.leave
    settle()
    server.run()
    if stage.trial is not None and not server.started:
        return stage.back(NOT_SERVED)
    return panel.network.following


def configured(app: FastAPI, settings: Settings) -> uvicorn.Config:
    """Return how uvicorn serves a panel: its limits, its certificate, the proxies that it believes."""
    certificate = settings.certificate
    turnstile = Turnstile()
    return uvicorn.Config(
        app,
        host=settings.host,
        port=settings.port,
        http=cautious(Connections(reserve_descriptors()), turnstile),
        ws=cautious_sockets(app.state.panel.clock, turnstile),
        ws_max_size=LARGEST_MESSAGE,
        ws_ping_interval=PING_S,
        ws_ping_timeout=PING_S,
        ws_per_message_deflate=False,
        log_config=None,
        access_log=False,
        proxy_headers=bool(settings.trusted_proxies),
        forwarded_allow_ips=",".join(settings.trusted_proxies),
        ssl_certfile=certificate[0] if certificate else None,
        ssl_keyfile=certificate[1] if certificate else None,
        server_header=False,
        timeout_keep_alive=KEEP_ALIVE_S,
        timeout_graceful_shutdown=FAREWELL_S,
    )
