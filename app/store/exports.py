"""Recordings as files for other programs: CSV and Parquet, with units in the headers and in UTC."""

import csv
import io
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.base.extras import need
from app.base.startup import late
from app.store.documents import RECORDING
from app.tracker.memory.recording import COLUMNS, Frames, RecordingInfo
from app.tracker.state.snapshot import ActivityName

ROWS_A_PIECE = 5000
ACTIVITIES = list(ActivityName)
NUMBERS = COLUMNS[:-1]
MEASURED = COLUMNS[2:]
"""All but the two columns that count seconds."""
HEAD_KEY = b"heliopanel_recording"


def to_csv(info: RecordingInfo, frames: Frames) -> Iterator[bytes]:
    """Yield the recording as CSV in pieces: instants in ISO 8601 UTC, points, empty where unknown."""
    yield _lines([("time_utc", "sun_time_utc", *COLUMNS)])
    for begin in range(0, len(frames), ROWS_A_PIECE):
        yield _lines([_row(info, row) for row in frames.values[begin : begin + ROWS_A_PIECE].tolist()])


def measured_csv(begin: datetime, frames: Frames) -> Iterator[bytes]:
    """Yield frames that count from an instant as CSV: the instant in UTC and everything that was measured."""
    yield _lines([("time_utc", *MEASURED)])
    for first in range(0, len(frames), ROWS_A_PIECE):
        rows = frames.values[first : first + ROWS_A_PIECE].tolist()
        yield _lines([_measured(begin, row) for row in rows])


def to_parquet(info: RecordingInfo, frames: Frames) -> bytes:
    """Return the recording as Parquet (zstd); its head is JSON in the metadata `heliopanel_recording`."""
    need("parquet")
    pa, pq = late("pyarrow"), late("pyarrow.parquet")
    columns: dict[str, Any] = {
        "time_utc": _instants(info.began_at.timestamp(), frames.column("elapsed_s")),
        "sun_time_utc": _instants(info.sun_start.timestamp(), frames.column("sun_time_s")),
    }
    for name in NUMBERS:
        columns[name] = pa.array(frames.column(name), from_pandas=True)
    columns[COLUMNS[-1]] = pa.array([_activity(value) for value in frames.column(COLUMNS[-1]).tolist()])
    head = {HEAD_KEY: RECORDING.write(info).encode()}
    file = io.BytesIO()
    pq.write_table(pa.table(columns).replace_schema_metadata(head), file, compression="zstd")
    return file.getvalue()


def _lines(rows: list[tuple[object, ...]]) -> bytes:
    text = io.StringIO()
    csv.writer(text, lineterminator="\r\n").writerows(rows)
    return text.getvalue().encode()


def _measured(begin: datetime, values: list[float]) -> tuple[object, ...]:
    return (_stamp(begin + timedelta(seconds=values[0])), *_known(values[2:-1]), _activity(values[-1]))


def _known(values: list[float]) -> list[float | None]:
    return [round(value, 3) if isfinite(value) else None for value in values]


def _row(info: RecordingInfo, values: list[float]) -> tuple[object, ...]:
    known = _known(values[:-1])
    times = (_iso(info, known[0], sun=False), _iso(info, known[1], sun=True))
    return (*times, *known, _activity(values[-1]))


def _iso(info: RecordingInfo, seconds: float | None, *, sun: bool) -> str:
    if seconds is None:
        return ""
    begin = info.sun_start if sun else info.began_at
    return _stamp(begin + timedelta(seconds=seconds))


def _stamp(at: datetime) -> str:
    return at.astimezone(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")


def _activity(value: float) -> str | None:
    return str(ACTIVITIES[int(value)]) if 0 <= value < len(ACTIVITIES) else None


def _instants(begin_unix_s: float, seconds: NDArray[np.float64]) -> Any:
    """Return instants as an array of pyarrow, empty where unknown."""
    pa = late("pyarrow")
    unix_ms = np.rint((begin_unix_s + seconds) * 1000.0)
    known = np.isfinite(unix_ms)
    whole = np.where(known, unix_ms, 0).astype(np.int64)
    return pa.array(whole, mask=~known).cast(pa.timestamp("ms", tz="UTC"))
