"""What a tracker measured over hours and days, decimated on the server."""

from datetime import datetime, timedelta
from typing import Annotated

import numpy as np
from fastapi import APIRouter, Query
from fastapi.responses import Response

from app.instants import Instant
from app.store.decimate import decimate
from app.store.store import Reader
from app.tracker.recording import COLUMNS, Frames, RecordingInfo, RecordingKind
from app.web.api.base import Output
from app.web.api.recordings import ACTIVITIES
from app.web.deps import ReaderDep
from app.web.errors import NotAcceptable

router = APIRouter(tags=["history"])

LONGEST = timedelta(days=31)
EMPTY = Frames(np.empty((0, len(COLUMNS))))


class Telemetry(Output):
    """Columns of equal length from `begin` on; `elapsed_s` counts from `begin`, unknown is null."""

    tracker_id: str
    begin: datetime
    end: datetime
    frame_count: int
    activities: list[str]
    columns: dict[str, list[float | None]]


@router.get("/telemetry", summary="Measured angles over time", response_model=Telemetry)
def read_telemetry(
    reader: ReaderDep,
    tracker_id: Annotated[str, Query(min_length=1, max_length=64)],
    begin: Instant,
    end: Instant,
    points: Annotated[int, Query(ge=18, le=100_000, description="At most so many; extremes stay.")] = 1000,
) -> Response:
    """Return what was recorded of a tracker's days in a range of time."""
    if not timedelta() < end - begin <= LONGEST:
        raise NotAcceptable("Give an end after the begin, and a range of at most 31 days.")
    frames = decimate(_between(reader, tracker_id, begin, end), points)
    columns = {name: _plain(frames, name) for name in COLUMNS}
    whole = Telemetry(
        tracker_id=tracker_id,
        begin=begin,
        end=end,
        frame_count=len(frames),
        activities=ACTIVITIES,
        columns=columns,
    )
    return Response(whole.model_dump_json(), media_type="application/json")


def _between(reader: Reader, tracker_id: str, begin: datetime, end: datetime) -> Frames:
    days = reader.recordings(kind=RecordingKind.DAY, tracker_id=tracker_id, limit=1000)
    overlapping = [day for day in reversed(days) if day.began_at < end and (day.ended_at or end) > begin]
    parts = [_part(reader, day, begin, end) for day in overlapping]
    return Frames(np.concatenate([part.values for part in parts])) if parts else EMPTY


def _part(reader: Reader, day: RecordingInfo, begin: datetime, end: datetime) -> Frames:
    since = (begin - day.began_at) / timedelta(seconds=1)
    until = (end - day.began_at) / timedelta(seconds=1)
    values = reader.frames(day.recording_id, begin_s=max(0.0, since), end_s=until).values.copy()
    values[:, COLUMNS.index("elapsed_s")] -= since
    return Frames(values)


def _plain(frames: Frames, name: str) -> list[float | None]:
    return [None if np.isnan(value) else float(value) for value in frames.column(name)]
