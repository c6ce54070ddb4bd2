"""Backups in the data folder: create one, download it, and restore one while the database is damaged."""

from datetime import UTC, datetime
from typing import Annotated

from fastapi import Path, Response
from fastapi.responses import FileResponse
from pydantic import Field
from starlette.concurrency import run_in_threadpool

from app.base.message import say
from app.base.permission import Permission
from app.store.backup.backup import backup
from app.web.api.base import NOT_FOUND, REFUSED, ROOT, Output, Page, Responses, api_router, whole
from app.web.features.operations.restoring import choice, restore
from app.web.http.errors import NotFound
from app.web.http.needs import needs
from app.web.shell.deps import PanelDep

MEDIA_TYPE = "application/vnd.sqlite3"
FILE: Responses = {
    200: {
        "description": "The backup file.",
        "content": {MEDIA_TYPE: {"schema": {"type": "string", "format": "binary"}}},
    }
}

BackupName = Annotated[
    str, Path(min_length=1, max_length=200, description="Its name, as `GET /backups` tells it.")
]

router = api_router(tags=["operations"], prefix="/backups")


class Backup(Output):
    """A backup that was created."""

    file: str = Field(description="Its name in the folder `backups` of the data folder.")
    size_bytes: int
    site_name: str
    trackers: int
    events: int
    recordings: int
    audit_head: str = Field(
        description="The last entry of the audit, SEQ:HASH; `heliopanel audit verify --head` finds it again."
    )


class BackupOnDisk(Output):
    """A backup in the folder `backups` of the data folder; it is checked when it is restored."""

    file: str
    size_bytes: int
    written_at: datetime


class RestoreBegun(Output):
    """The backup that the controller service restores now, as it starts again."""

    site_name: str
    trackers: int
    events: int
    recordings: int


@router.get("", summary="The backups in the data folder")
@needs(Permission.ADMINISTER)
def list_backups(built: PanelDep) -> Page[BackupOnDisk]:
    """Return the backups, the newest first."""
    return whole(
        BackupOnDisk(file=one.path.name, size_bytes=one.size_bytes, written_at=one.written_at)
        for one in choice(built).backups
    )


@router.post("", status_code=201, summary="Create a backup")
@needs(Permission.ADMINISTER, proven=True)
def create_backup(built: PanelDep, response: Response) -> Backup:
    """Write a checked backup of the whole store into the data folder while everything runs."""
    name = f"heliopanel-{built.clock.system_time().astimezone(UTC):%Y%m%d-%H%M%S-%f}.backup"
    path = built.settings.data_dir / "backups" / name
    info = backup(built.settings.url, path)
    response.headers["Location"] = f"{ROOT}/backups/{name}"
    return Backup(
        file=name,
        size_bytes=info.size_bytes,
        site_name=info.site_name,
        trackers=info.trackers,
        events=info.events,
        recordings=info.recordings,
        audit_head=info.audit_head,
    )


@router.get("/{name}", summary="Download a backup", response_class=FileResponse, responses=FILE | NOT_FOUND)
@needs(Permission.ADMINISTER)
def download_backup(name: BackupName, built: PanelDep) -> FileResponse:
    """Send a backup of the data folder."""
    found = next((one for one in choice(built).backups if one.path.name == name), None)
    if found is None:
        raise NotFound(say("There is no backup {name} in the folder backups of the data folder.", name=name))
    return FileResponse(found.path, media_type=MEDIA_TYPE, filename=name)


@router.post("/{name}/restore", status_code=202, summary="Restore a backup", responses=NOT_FOUND | REFUSED)
@needs(Permission.ADMINISTER, proven=True)
async def restore_backup(name: BackupName, built: PanelDep) -> RestoreBegun:
    """Bring a backup back; only while the database is damaged, when the service runs in safe mode."""
    found = await run_in_threadpool(restore, built, name, built.site_now())
    return RestoreBegun(
        site_name=found.site_name, trackers=found.trackers, events=found.events, recordings=found.recordings
    )
