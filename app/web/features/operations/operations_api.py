"""Health, metrics and diagnostics."""

from typing import Literal

from fastapi import APIRouter
from fastapi.responses import Response
from pydantic import Field
from starlette.concurrency import run_in_threadpool

from app.base.build import VERSION
from app.base.logs import get_logger
from app.base.permission import Permission
from app.base.startup import late
from app.link.messages import MachineUnreachable
from app.store.store import JournalFilter
from app.web.api.base import Output, Responses, operation_id
from app.web.features.operations.diagnostics import about, live, stored, zipped
from app.web.http.needs import needs
from app.web.services.counting import counted
from app.web.shell.deps import PanelDep

log = get_logger()
router = APIRouter(tags=["operations"], generate_unique_id_function=operation_id)

NO_MACHINE = "The controller service does not answer; the panel shows no live values."
ZIP: Responses = {
    200: {
        "description": "A zip file.",
        "content": {"application/zip": {"schema": {"type": "string", "format": "binary"}}},
    }
}
TEXT: Responses = {200: {"description": "Text.", "content": {"text/plain": {"schema": {"type": "string"}}}}}


class Health(Output):
    """The panel answers."""

    status: Literal["ok"]
    version: str


class Readiness(Output):
    """Machine and database answer too."""

    status: Literal["ready"]
    boot_id: str = Field(description="Changes when the machine restarts.")


@router.get("/health", summary="Does the panel answer?")
@needs(Permission.OPEN)
async def read_health() -> Health:
    """Say that the panel runs, whatever the machine does."""
    return Health(status="ok", version=VERSION)


@router.get("/ready", summary="Do controller and database answer?")
@needs(Permission.OPEN)
def read_ready(panel: PanelDep) -> Readiness:
    """Say that panel, machine and database work together, else answer 503."""
    snapshot = panel.machine.latest()
    if snapshot is None:
        raise MachineUnreachable(NO_MACHINE)
    panel.reader.journal(JournalFilter(limit=1))
    return Readiness(status="ready", boot_id=snapshot.boot_id)


@router.get("/metrics", summary="Metrics for Prometheus", response_class=Response, responses=TEXT)
@needs(Permission.READ)
async def read_metrics(panel: PanelDep) -> Response:
    """Return counters of machine and panel in the text format."""
    machine = await counted(panel.machine)
    text: bytes = late("app.web.services.metrics").exposition(machine, len(panel.hub))
    return Response(text, media_type="text/plain; version=0.0.4")


@router.get("/diagnostics.zip", summary="Everything for support", response_class=Response, responses=ZIP)
@needs(Permission.ADMINISTER, ticketed=True)
async def download_diagnostics(panel: PanelDep) -> Response:
    """Return versions, settings without secrets, state and the newest 1,000 events."""
    parts = about(panel.settings, panel.site_now()) | await live(panel.machine)
    parts |= await run_in_threadpool(stored, panel.reader)
    return _attached(await run_in_threadpool(zipped, parts), "application/zip", "heliopanel-diagnostics.zip")


def _attached(body: bytes, media_type: str, name: str) -> Response:
    headers = {"Content-Disposition": f'attachment; filename="{name}"'}
    return Response(body, media_type=media_type, headers=headers)
