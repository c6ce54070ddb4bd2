"""Recorded shows, days and simulations."""

from datetime import timedelta
from enum import StrEnum
from typing import Annotated, Any
from uuid import uuid4

import numpy as np
import orjson
from fastapi import Query
from fastapi.responses import Response, StreamingResponse
from pydantic import Field
from starlette.concurrency import run_in_threadpool

from app.link.messages import DeleteRecording, SavePlan, UnknownRecording
from app.store.decimate import FEWEST_POINTS, decimate
from app.store.exports import to_csv, to_parquet
from app.store.store import Reader
from app.sun.position import Algorithm
from app.tracker.commands import GoToStart
from app.tracker.config import Orientation
from app.tracker.programs.show import ShowPlan
from app.tracker.recording import COLUMNS, Frames, RecordingInfo, RecordingKind
from app.tracker.snapshot import ActivityName, Snapshot
from app.web.api.base import NOT_FOUND, REFUSED, Input, Output, RecordingId, Responses, api_router
from app.web.api.orders import SenderDep
from app.web.api.shows import place_of_show
from app.web.api.trackers import detail_of
from app.web.attachments import kept_as
from app.web.deps import MachineDep, ReaderDep
from app.web.errors import NotAcceptable

router = api_router(prefix="/recordings", tags=["recordings"])

ACTIVITIES = [name.value for name in ActivityName]
Seconds = Annotated[float, Query(ge=0, le=1e9, description="Seconds since the recording began.")]
Points = Annotated[
    int | None,
    Query(ge=FEWEST_POINTS, le=1_000_000, description="At most so many frames; the extremes stay."),
]


class FramesFormat(StrEnum):
    """How frames are written."""

    JSON = "json"
    CSV = "csv"
    PARQUET = "parquet"


class FrameColumns(Output):
    """Frames as columns of equal length; what was not known is null. `activity` counts in `activities`."""

    recording_id: str
    frame_count: int = Field(description="Rows here, after range and decimation.")
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
def list_recordings(
    reader: ReaderDep,
    kind: RecordingKind | None = None,
    tracker_id: Annotated[str | None, Query(max_length=64)] = None,
    limit: Annotated[int, Query(ge=1, le=1000)] = 200,
) -> list[RecordingInfo]:
    """Return the heads of recordings."""
    return reader.recordings(kind=kind, tracker_id=tracker_id, limit=limit)


@router.get("/{recording_id}", summary="The head of a recording", responses=NOT_FOUND)
def read_recording(recording_id: RecordingId, reader: ReaderDep) -> RecordingInfo:
    """Return what was recorded, when, where and how it ended."""
    return stored(reader, recording_id)


@router.get(
    "/{recording_id}/frames",
    summary="The frames of a recording",
    response_model=FrameColumns,
    responses=NOT_FOUND | FILES,
)
def read_samples(
    recording_id: RecordingId,
    reader: ReaderDep,
    begin_s: Seconds = 0.0,
    end_s: Annotated[float | None, Query(ge=0, le=1e9, description="Left out: to the end.")] = None,
    points: Points = None,
    format: FramesFormat = FramesFormat.JSON,
) -> Response:
    """Return planned, commanded and measured angles, of a range and decimated when asked."""
    info = stored(reader, recording_id)
    frames = reader.frames(recording_id, begin_s=begin_s, end_s=end_s)
    if points is not None:
        frames = decimate(frames, points)
    match format:
        case FramesFormat.JSON:
            return Response(columns_json(info, frames), media_type="application/json")
        case FramesFormat.CSV:
            return StreamingResponse(to_csv(info, frames), headers=_named(info, "csv"), media_type="text/csv")
        case FramesFormat.PARQUET:
            body, media_type = to_parquet(info, frames), "application/vnd.apache.parquet"
            return Response(body, headers=_named(info, "parquet"), media_type=media_type)


@router.post(
    "/{recording_id}/rerun",
    status_code=202,
    summary="Run a recording again",
    responses=NOT_FOUND | REFUSED,
)
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
        begin_at=info.sun_begin_at,
        end_at=info.sun_end_at,
        duration=timedelta(seconds=duration_s or info.duration_s),
        location=info.location,
        mode=info.mode,
        orientation=Orientation(info.held_azimuth_deg, info.held_elevation_deg),
        algorithm=Algorithm(info.algorithm),
        refraction=refraction,
    )


def columns_json(info: RecordingInfo, frames: Frames) -> bytes:
    """Return frames as the JSON of `FrameColumns`."""
    columns: dict[str, Any] = {name: np.ascontiguousarray(frames.column(name)) for name in COLUMNS}
    whole = {
        "recording_id": info.recording_id,
        "frame_count": len(frames),
        "activities": ACTIVITIES,
        "columns": columns,
    }
    return orjson.dumps(whole, option=orjson.OPT_SERIALIZE_NUMPY)


def _named(info: RecordingInfo, ending: str) -> dict[str, str]:
    return kept_as(f"{info.kind}-{info.recording_id}.{ending}")
