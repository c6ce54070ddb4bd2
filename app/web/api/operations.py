"""Health, metrics, diagnostics and backups."""

import tempfile
from datetime import UTC, datetime
from pathlib import Path
from typing import Literal

from fastapi import APIRouter
from fastapi.responses import FileResponse, Response
from pydantic import Field
from starlette.background import BackgroundTask
from starlette.concurrency import run_in_threadpool

from app.build import VERSION
from app.link.messages import MachineUnreachable
from app.logs import get_logger
from app.store.backup import backup
from app.store.store import JournalFilter
from app.web.api.base import Output, Responses
from app.web.deps import PanelDep
from app.web.diagnostics import about, live, stored, zipped
from app.web.metrics import counted, exposition

log = get_logger()
router = APIRouter(tags=["operations"])

NO_MACHINE = "The controller service does not answer; the panel shows no live values."
ZIP: Responses = {
    200: {
        "description": "A zip file.",
        "content": {"application/zip": {"schema": {"type": "string", "format": "binary"}}},
    }
}
FILE: Responses = {
    200: {
        "description": "The backup file.",
        "content": {"application/vnd.sqlite3": {"schema": {"type": "string", "format": "binary"}}},
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


class Backup(Output):
    """A backup that was written."""

    file: str = Field(description="Its name in the folder `backups` of the data folder.")
    size_bytes: int
    site_name: str
    trackers: int
    events: int
    recordings: int
    audit_head: str = Field(
        description="The last entry of the audit, SEQ:HASH; `heliopanel audit verify --head` finds it again."
    )


@router.get("/health", summary="Does the panel answer?")
async def health() -> Health:
    """Say that the panel runs, whatever the machine does."""
    return Health(status="ok", version=VERSION)


@router.get("/ready", summary="Do machine and database answer?")
def ready(panel: PanelDep) -> Readiness:
    """Say that panel, machine and database work together, else answer 503."""
    snapshot = panel.machine.latest()
    if snapshot is None:
        raise MachineUnreachable(NO_MACHINE)
    panel.reader.journal(JournalFilter(limit=1))
    return Readiness(status="ready", boot_id=snapshot.boot_id)


@router.get("/metrics", summary="Metrics for Prometheus", response_class=Response, responses=TEXT)
async def metrics(panel: PanelDep) -> Response:
    """Return counters of machine and panel in the text format."""
    text = exposition(await counted(panel.machine), len(panel.hub))
    return Response(text, media_type="text/plain; version=0.0.4")


@router.get("/diagnostics.zip", summary="Everything for support", response_class=Response, responses=ZIP)
async def diagnostics(panel: PanelDep) -> Response:
    """Return versions, settings without secrets, state and the newest 1,000 events."""
    parts = about(panel.settings, panel.clock.now()) | await live(panel.machine)
    parts |= await run_in_threadpool(stored, panel.reader)
    return _attached(await run_in_threadpool(zipped, parts), "application/zip", "heliopanel-diagnostics.zip")


@router.get("/backup", summary="Download a backup", response_class=FileResponse, responses=FILE)
def download_backup(panel: PanelDep) -> FileResponse:
    """Write a checked backup of the whole store while everything runs, and send it."""
    folder = tempfile.TemporaryDirectory(prefix="heliopanel-backup-")
    path = Path(folder.name) / _backup_name(panel.clock.now())
    info = backup(panel.settings.url, path)
    remove = BackgroundTask(folder.cleanup)
    headers = {"Audit-Head": info.audit_head} if info.audit_head else None
    return FileResponse(
        path, headers=headers, media_type="application/vnd.sqlite3", filename=path.name, background=remove
    )


@router.post("/backup", status_code=201, summary="Write a backup")
def write_backup(panel: PanelDep) -> Backup:
    """Write a checked backup into the data folder while everything runs."""
    path = panel.settings.data_dir / "backups" / _backup_name(panel.clock.now())
    info = backup(panel.settings.url, path)
    return Backup(
        file=path.name,
        size_bytes=info.size_bytes,
        site_name=info.site_name,
        trackers=info.trackers,
        events=info.events,
        recordings=info.recordings,
        audit_head=info.audit_head,
    )


def _backup_name(now: datetime) -> str:
    return f"heliopanel-{now.astimezone(UTC):%Y%m%d-%H%M%S-%f}.backup"


def _attached(body: bytes, media_type: str, name: str) -> Response:
    headers = {"Content-Disposition": f'attachment; filename="{name}"'}
    return Response(body, media_type=media_type, headers=headers)
