"""Backups that lie in the data folder, and bringing one back while the database is damaged."""

from datetime import datetime

from pydantic import Field
from starlette.concurrency import run_in_threadpool

from app.web.api.base import NOT_FOUND, REFUSED, Input, Output, api_router
from app.web.deps import PanelDep
from app.web.restoring import choice, restore

router = api_router(tags=["operations"])


class BackupOnDisk(Output):
    """A backup in the folder `backups` of the data folder; it is checked when it is restored."""

    file: str
    size_bytes: int
    written_at: datetime


class RestoreRequest(Input):
    """Which backup to bring back."""

    file: str = Field(min_length=1, max_length=200, description="Its name, as `GET /backups` tells it.")


class RestoreBegun(Output):
    """The backup that the controller service restores now, as it starts again."""

    site_name: str
    trackers: int
    events: int
    recordings: int


@router.get("/backups", summary="The backups in the data folder")
def list_backups(built: PanelDep) -> list[BackupOnDisk]:
    """Return the backups, the newest first."""
    return [
        BackupOnDisk(file=one.path.name, size_bytes=one.size_bytes, written_at=one.written_at)
        for one in choice(built).backups
    ]


@router.post("/restore", status_code=202, summary="Restore a backup", responses=NOT_FOUND | REFUSED)
async def restore_backup(asked: RestoreRequest, built: PanelDep) -> RestoreBegun:
    """Bring a backup back; only while the database is damaged, when the service runs in safe mode."""
    found = await run_in_threadpool(restore, built, asked.file, built.clock.now())
    return RestoreBegun(
        site_name=found.site_name, trackers=found.trackers, events=found.events, recordings=found.recordings
    )
