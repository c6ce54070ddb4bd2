"""What a tracker measured over hours and days, decimated on the server."""

from datetime import UTC, datetime, timedelta
from typing import Annotated, Literal

import numpy as np
from fastapi import Query
from fastapi.responses import Response, StreamingResponse

from app.base.instants import Instant
from app.base.message import N_
from app.base.permission import Permission
from app.store.decimate import FEWEST_POINTS, decimate
from app.store.exports import measured_csv
from app.store.store import Reader
from app.tracker.memory.recording import COLUMNS, Frames, RecordingInfo, RecordingKind
from app.web.api.base import Output, Responses, api_router
from app.web.features.shows.recordings_api import ACTIVITIES
from app.web.http.attachments import kept_as
from app.web.http.errors import NotAcceptable
from app.web.http.needs import needs
from app.web.shell.deps import ReaderDep

router = api_router(tags=["history"])

LONGEST = timedelta(days=31)
Points = Annotated[int, Query(ge=FEWEST_POINTS, le=100_000, description="At most so many; extremes stay.")]
EMPTY = Frames(np.empty((0, len(COLUMNS))))


class Telemetry(Output):
    """Columns of equal length from `start` on; `elapsed_s` counts from `start`, unknown is null."""

    tracker_id: str
    start: datetime
    end: datetime
    sample_count: int
    activities: list[str]
    columns: dict[str, list[float | None]]


FILE: Responses = {
    200: {
        "description": "As columns in JSON, or as a file.",
        "content": {"text/csv": {"schema": {"type": "string"}}},
    }
}


@router.get(
    "/telemetry", summary="Angles, drive and weather over time", response_model=Telemetry, responses=FILE
)
@needs(Permission.READ)
def read_telemetry(
    reader: ReaderDep,
    tracker_id: Annotated[str, Query(min_length=1, max_length=64)],
    start: Instant,
    end: Instant,
    points: Points = 1000,
    file: Annotated[
        Literal["json", "csv"], Query(alias="format", description="CSV in UTC, for files.")
    ] = "json",
) -> Response:
    """Return what was recorded of a tracker's days in a range of time."""
    if not timedelta() < end - start <= LONGEST:
        raise NotAcceptable(N_("Give an end after the start, and a range of at most 31 days."))
    frames = _between(reader, tracker_id, start, end, points)
    if file == "csv":
        return _csv(tracker_id, start, frames)
    columns = {name: _plain(frames, name) for name in COLUMNS}
    whole = Telemetry(
        tracker_id=tracker_id,
        start=start,
        end=end,
        sample_count=len(frames),
        activities=ACTIVITIES,
        columns=columns,
    )
    return Response(whole.model_dump_json(), media_type="application/json")


def _csv(tracker_id: str, begin: datetime, frames: Frames) -> Response:
    name = f"{tracker_id}-{begin.astimezone(UTC):%Y%m%dT%H%M%SZ}.csv"
    return StreamingResponse(measured_csv(begin, frames), media_type="text/csv", headers=kept_as(name))


def _between(reader: Reader, tracker_id: str, begin: datetime, end: datetime, points: int) -> Frames:
    """Return at most so many frames of the days in a range; each day is thinned out before it is joined."""
    days = reader.recordings(kind=RecordingKind.DAY, tracker_id=tracker_id, limit=1000)
    overlapping = [day for day in reversed(days) if day.began_at < end and (day.ended_at or end) > begin]
    parts = [decimate(_part(reader, day, begin, end), points) for day in overlapping]
    return decimate(Frames(np.concatenate([part.values for part in parts])), points) if parts else EMPTY


def _part(reader: Reader, day: RecordingInfo, begin: datetime, end: datetime) -> Frames:
    since = (begin - day.began_at) / timedelta(seconds=1)
    until = (end - day.began_at) / timedelta(seconds=1)
    values = reader.frames(day.recording_id, begin_s=max(0.0, since), end_s=until).values.copy()
    values[:, COLUMNS.index("elapsed_s")] -= since
    return Frames(values)


def _plain(frames: Frames, name: str) -> list[float | None]:
    return [None if np.isnan(value) else float(value) for value in frames.column(name)]
