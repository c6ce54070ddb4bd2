"""Recorded shows, days and simulations."""

from datetime import UTC, datetime, timedelta
from enum import StrEnum
from typing import Annotated, Any
from uuid import uuid4

import numpy as np
import orjson
from fastapi import Query
from fastapi.responses import Response, StreamingResponse
from pydantic import Field
from starlette.concurrency import run_in_threadpool

from app.base.permission import Permission
from app.link.messages import DeleteRecording, SavePlan, UnknownRecording
from app.store.decimate import FEWEST_POINTS, decimate
from app.store.exports import to_csv, to_parquet
from app.store.store import Reader
from app.sun.position import Algorithm
from app.tracker.commands.commands import GoToStart
from app.tracker.memory.recording import COLUMNS, Frames, RecordingInfo, RecordingKind
from app.tracker.programs.show import ShowPlan
from app.tracker.settings.config import Orientation
from app.tracker.state.snapshot import ActivityName, Snapshot
from app.web.api.base import (
    CURSOR,
    NOT_FOUND,
    REFUSED,
    Input,
    Limit,
    Output,
    Page,
    RecordingId,
    Responses,
    api_router,
)
from app.web.api.orders import SenderDep
from app.web.api.trackers import detail_of
from app.web.features.shows.shows_api import place_of_show
from app.web.http.attachments import kept_as
from app.web.http.errors import NotAcceptable
from app.web.http.needs import needs
from app.web.shell.deps import MachineDep, ReaderDep

router = api_router(prefix="/recordings", tags=["recordings"])

ACTIVITIES = [name.value for name in ActivityName]
Seconds = Annotated[float, Query(ge=0, le=1e9, description="Seconds since the recording began.")]
Points = Annotated[
    int | None,
    Query(ge=FEWEST_POINTS, le=1_000_000, description="At most so many samples; the extremes stay."),
]


EPOCH, MICROSECOND = datetime(1, 1, 1, tzinfo=UTC), timedelta(microseconds=1)
PLACE = r"^[0-2]?[0-9]{1,17}\..{1,64}$"
"""When a recording began, in microseconds, and its id; so many digits end before the calendar does."""


class SamplesFormat(StrEnum):
    """How samples are written."""

    JSON = "json"
    CSV = "csv"
    PARQUET = "parquet"


class SampleColumns(Output):
    """Samples as columns of equal length; what was not known is null. `activity` counts in `activities`."""

    recording_id: str
    sample_count: int = Field(description="Rows here, after range and decimation.")
    activities: list[str] = Field(description="Names of the activities, in the order of their numbers.")
    columns: dict[str, list[float | None]] = Field(description="By name; the unit is in the name.")


class Rerun(Input):
    """On which tracker and in how long to run it again; left out: as it was recorded."""

    tracker_id: str | None = Field(None, min_length=1, max_length=64)
    duration_s: float | None = Field(None, ge=10, le=86400)


FILES: Responses = {
    200: {
        "description": "As columns in JSON, or as a file.",
        "content": {
            "text/csv": {"schema": {"type": "string"}},
            "application/vnd.apache.parquet": {"schema": {"type": "string", "format": "binary"}},
        },
    }
}


@router.get("", summary="All recordings, newest first")
@needs(Permission.READ)
def list_recordings(
    reader: ReaderDep,
    kind: RecordingKind | None = None,
    tracker_id: Annotated[str | None, Query(max_length=64)] = None,
    cursor: Annotated[str | None, Query(pattern=PLACE, description=CURSOR)] = None,
    limit: Limit = 200,
) -> Page[RecordingInfo]:
    """Return the heads of recordings."""
    found = reader.recordings(kind=kind, tracker_id=tracker_id, limit=limit, before=_place(cursor))
    more = _cursor(found[-1]) if len(found) == limit else None
    return Page[RecordingInfo](items=tuple(found), next=more)


def _cursor(last: RecordingInfo) -> str:
    """Return where the page after this recording begins: several may have begun at one instant."""
    return f"{(last.began_at - EPOCH) // MICROSECOND}.{last.recording_id}"


def _place(cursor: str | None) -> tuple[datetime, str] | None:
    if cursor is None:
        return None
    began, _, recording_id = cursor.partition(".")
    return EPOCH + int(began) * MICROSECOND, recording_id


@router.get("/{recording_id}", summary="The head of a recording", responses=NOT_FOUND)
@needs(Permission.READ)
def read_recording(recording_id: RecordingId, reader: ReaderDep) -> RecordingInfo:
    """Return what was recorded, when, where and how it ended."""
    return stored(reader, recording_id)


@router.get(
    "/{recording_id}/samples",
    summary="The samples of a recording",
    response_model=SampleColumns,
    responses=NOT_FOUND | FILES,
)
@needs(Permission.READ, ticketed=True)
def read_samples(
    recording_id: RecordingId,
    reader: ReaderDep,
    start_s: Seconds = 0.0,
    end_s: Annotated[float | None, Query(ge=0, le=1e9, description="Left out: to the end.")] = None,
    points: Points = None,
    format: SamplesFormat = SamplesFormat.JSON,
) -> Response:
    """Return planned, commanded and measured angles, of a range and decimated when asked."""
    info = stored(reader, recording_id)
    frames = reader.frames(recording_id, begin_s=start_s, end_s=end_s)
    if points is not None:
        frames = decimate(frames, points)
    match format:
        case SamplesFormat.JSON:
            return Response(columns_json(info, frames), media_type="application/json")
        case SamplesFormat.CSV:
            return StreamingResponse(to_csv(info, frames), headers=_named(info, "csv"), media_type="text/csv")
        case SamplesFormat.PARQUET:
            body, media_type = to_parquet(info, frames), "application/vnd.apache.parquet"
            return Response(body, headers=_named(info, "parquet"), media_type=media_type)


@router.post(
    "/{recording_id}/rerun",
    status_code=202,
    summary="Run a recording again",
    responses=NOT_FOUND | REFUSED,
)
@needs(Permission.SIMULATE)
async def rerun_recording(
    recording_id: RecordingId,
    sender: SenderDep,
    machine: MachineDep,
    reader: ReaderDep,
    response: Response,
    request: Rerun | None = None,
) -> Snapshot:
    """Plan the same stretch as a show and go to its start; `Location` is the show, to be run from there."""
    info = await run_in_threadpool(stored, reader, recording_id)
    wanted = request or Rerun()
    tracker_id = wanted.tracker_id or info.tracker_id
    config = (await detail_of(machine, tracker_id)).state.config
    plan = again(info, wanted.duration_s, refraction=config.refraction)
    await sender.send(SavePlan(tracker_id, plan))
    response.headers["Location"] = place_of_show(tracker_id, plan)
    return await sender.command(tracker_id, GoToStart(plan))


@router.delete(
    "/{recording_id}", status_code=204, summary="Delete a recording", responses=NOT_FOUND | REFUSED
)
@needs(Permission.CONFIGURE)
async def delete_recording(recording_id: RecordingId, sender: SenderDep) -> None:
    """Delete a recording that is not running."""
    await sender.send(DeleteRecording(recording_id))


def stored(reader: Reader, recording_id: str) -> RecordingInfo:
    """Return the head of a recording, or raise `UnknownRecording`."""
    info = reader.recording(recording_id)
    if info is None:
        raise UnknownRecording(recording_id)
    return info


def again(info: RecordingInfo, duration_s: float | None, *, refraction: bool) -> ShowPlan:
    """Return the plan of a show over the same stretch of sun time as a recording."""
    if duration_s is None and info.kind is not RecordingKind.SHOW:
        raise NotAcceptable("duration_s is missing: give the duration in seconds.")
    return ShowPlan(
        show_id=uuid4().hex[:12],
        begin_at=info.sun_start,
        end_at=info.sun_end,
        duration=timedelta(seconds=duration_s or info.duration_s),
        location=info.location,
        mode=info.mode,
        orientation=Orientation(info.held_azimuth_deg, info.held_elevation_deg),
        algorithm=Algorithm(info.algorithm),
        refraction=refraction,
    )


def columns_json(info: RecordingInfo, frames: Frames) -> bytes:
    """Return samples as the JSON of `SampleColumns`."""
    columns: dict[str, Any] = {name: np.ascontiguousarray(frames.column(name)) for name in COLUMNS}
    whole = {
        "recording_id": info.recording_id,
        "sample_count": len(frames),
        "activities": ACTIVITIES,
        "columns": columns,
    }
    return orjson.dumps(whole, option=orjson.OPT_SERIALIZE_NUMPY)


def _named(info: RecordingInfo, ending: str) -> dict[str, str]:
    return kept_as(f"{info.kind}-{info.recording_id}.{ending}")
