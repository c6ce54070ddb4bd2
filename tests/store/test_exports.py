"""Exports read back as what was recorded."""

import csv
import io
from datetime import datetime, timedelta

import numpy as np
import pyarrow.parquet as pq

from app.store.documents import RECORDING
from app.store.exports import HEAD_KEY, to_csv, to_parquet
from app.tracker.memory.recording import COLUMNS, Frames
from tests.store.tracked_day import MIDNIGHT, day_info, tracked_day


def a_recording() -> Frames:
    frames = tracked_day(12_000)
    assert np.isnan(frames.values[6000]).any()
    return frames


def test_csv_reads_back() -> None:
    frames = a_recording()
    pieces = list(to_csv(day_info(), frames))
    assert len(pieces) == 4
    rows = list(csv.DictReader(io.StringIO(b"".join(pieces).decode())))
    assert list(rows[0]) == ["time_utc", "sun_time_utc", *COLUMNS]
    assert len(rows) == len(frames)
    for name in COLUMNS[:-1]:
        read = np.array([float(row[name] or "nan") for row in rows])
        np.testing.assert_allclose(read, frames.column(name), atol=0.00051, rtol=0.0, equal_nan=True)
    assert {row["activity"] for row in rows} == {"holding", "tracking"}
    first = datetime.fromisoformat(rows[0]["time_utc"])
    assert abs(first - MIDNIGHT) < timedelta(milliseconds=10)
    assert rows[6000]["measured_azimuth_deg"] == ""


def test_what_is_not_known_is_empty() -> None:
    (_, row) = to_csv(day_info(), Frames(np.full((1, len(COLUMNS)), np.nan)))
    assert row == b"," * (len(COLUMNS) + 1) + b"\r\n"


def test_parquet_reads_back_with_its_head() -> None:
    frames = a_recording()
    file = pq.ParquetFile(io.BytesIO(to_parquet(day_info(), frames)))
    table = file.read(use_threads=False)
    assert table.column_names == ["time_utc", "sun_time_utc", *COLUMNS]
    for name in COLUMNS[:-1]:
        np.testing.assert_array_equal(table[name].to_numpy(zero_copy_only=False), frames.column(name))
    assert table["measured_azimuth_deg"].null_count == 60
    assert RECORDING.read(table.schema.metadata[HEAD_KEY].decode()) == day_info()
    assert file.metadata.row_group(0).column(0).compression == "ZSTD"
    noon = table["time_utc"][6000].as_py()
    assert abs(noon - MIDNIGHT - timedelta(seconds=6000)) < timedelta(milliseconds=10)
    assert noon.tzinfo is not None
    assert noon.utcoffset() == timedelta(0)
    assert set(table["activity"].to_pylist()) == {"holding", "tracking"}


def test_parquet_of_unknown_times_has_gaps() -> None:
    values = np.full((2, len(COLUMNS)), np.nan)
    values[0, 0] = 1.0
    table = pq.ParquetFile(io.BytesIO(to_parquet(day_info(), Frames(values)))).read(use_threads=False)
    assert table["time_utc"].null_count == 1
    assert table["sun_time_utc"].null_count == 2
    assert table["activity"].to_pylist() == [None, None]
