"""Recordings: opened, grown, closed, found, cut out, pruned; on both databases."""

from dataclasses import replace
from datetime import timedelta

import numpy as np
import pytest
from sqlalchemy import select

from app.store import tables
from app.store.chunks import encode_all
from app.store.connections import transaction, writing_engine
from app.store.reader import DatabaseReader
from app.store.store import StoreFailed
from app.store.writer import DatabaseWriter
from app.tracker.memory.recording import COLUMNS, Frames, RecordingInfo, RecordingKind
from tests.store.samples import execute
from tests.store.tracked_day import MIDNIGHT, day_info, tracked_day

RESOLUTION = 0.00051


def finished(
    recording_id: str, *, days: float, kind: RecordingKind = RecordingKind.SHOW, tracker_id: str = "T1"
) -> RecordingInfo:
    began_at = MIDNIGHT + timedelta(days=days)
    info = replace(day_info(recording_id, kind=kind), began_at=began_at, tracker_id=tracker_id)
    return replace(info, ended_at=began_at + timedelta(hours=1), outcome="complete")


def test_what_grew_in_pieces_is_stored_like_what_came_at_once(url: str, writer: DatabaseWriter) -> None:
    frames = tracked_day(1900)
    writer.begin_recording(day_info())
    assert writer.recording("day-1") == day_info()
    for begin in range(0, 1900, 77):
        writer.append_frames("day-1", Frames(frames.values[begin : begin + 77]))
    writer.append_frames("day-1", Frames(frames.values[:0]))
    writer.finish_recording("day-1", MIDNIGHT, "complete")
    ended = replace(day_info(), ended_at=MIDNIGHT, outcome="complete", sample_count=1900)
    assert writer.recording("day-1") == ended
    assert len(writer.frames("day-1")) == 1900
    engine = writing_engine(url)
    with transaction(engine) as connection:
        stored = connection.execute(
            select(tables.chunks.c.frames).order_by(tables.chunks.c.position)
        ).scalars()
        assert list(stored) == encode_all(frames)
    engine.dispose()


@pytest.mark.parametrize(
    ("begin_s", "end_s", "first", "last", "count"),
    [
        (899.5, 900.5, 900.0, 900.0, 1),
        (850.0, 950.0, 850.0, 950.0, 101),
        (990.0, None, 990.0, 999.0, 10),
        (0.0, 0.0, 0.0, 0.0, 1),
    ],
)
def test_a_range_of_time_is_cut_out(
    writer: DatabaseWriter, begin_s: float, end_s: float | None, first: float, last: float, count: int
) -> None:
    values = np.zeros((1000, len(COLUMNS)))
    values[:, 0] = np.arange(1000)
    writer.save_recording(finished("show-1", days=0), encode_all(Frames(values)))
    elapsed_s = writer.frames("show-1", begin_s=begin_s, end_s=end_s).column("elapsed_s")
    assert (elapsed_s[0], elapsed_s[-1], len(elapsed_s)) == (first, last, count)


def test_a_whole_recording_is_stored_all_or_nothing(writer: DatabaseWriter, reader: DatabaseReader) -> None:
    chunks = encode_all(tracked_day(1000))
    with pytest.raises(StoreFailed, match="was not stored: A chunk of"):
        writer.save_recording(finished("show-1", days=0), [chunks[0], chunks[1][:-9]])
    assert reader.recording("show-1") is None
    writer.save_recording(finished("show-1", days=0), chunks)
    with pytest.raises(StoreFailed, match="rejected"):
        writer.save_recording(finished("show-1", days=0), chunks[:1])
    stored = reader.recording("show-1")
    assert stored is not None
    assert stored.sample_count == len(reader.frames("show-1")) == 1000


def test_only_an_open_recording_grows(writer: DatabaseWriter) -> None:
    with pytest.raises(StoreFailed, match="'nowhere' is not open"):
        writer.append_frames("nowhere", tracked_day(3))
    writer.begin_recording(day_info())
    writer.finish_recording("day-1", MIDNIGHT, "stopped")
    with pytest.raises(StoreFailed, match="'day-1' is not open"):
        writer.append_frames("day-1", tracked_day(3))
    with pytest.raises(StoreFailed, match="cannot be closed"):
        writer.finish_recording("day-1", MIDNIGHT, "stopped")


def test_recordings_are_found_newest_first(writer: DatabaseWriter, reader: DatabaseReader) -> None:
    writer.save_recording(finished("a", days=1), [])
    writer.save_recording(finished("c", days=3, kind=RecordingKind.SIMULATION), [])
    writer.save_recording(finished("b", days=2, tracker_id="T2"), [])
    assert [info.recording_id for info in reader.recordings()] == ["c", "b", "a"]
    assert [info.recording_id for info in reader.recordings(limit=1)] == ["c"]
    assert [info.recording_id for info in reader.recordings(kind=RecordingKind.SHOW)] == ["b", "a"]
    assert [info.recording_id for info in reader.recordings(tracker_id="T2")] == ["b"]


def test_what_a_crash_left_open_ends_at_its_last_frame(
    writer: DatabaseWriter, reader: DatabaseReader
) -> None:
    writer.save_recording(finished("whole", days=0), [])
    writer.begin_recording(day_info("with frames"))
    writer.append_frames("with frames", tracked_day(1000))
    writer.begin_recording(day_info("without"))
    restart = MIDNIGHT + timedelta(days=3)
    closed = {info.recording_id: info for info in writer.close_open_recordings(restart, "cut off")}
    assert set(closed) == {"with frames", "without"}
    last_frame = closed["with frames"].ended_at
    assert last_frame is not None
    assert abs(last_frame - MIDNIGHT - timedelta(seconds=999)) < timedelta(milliseconds=10)
    assert closed["without"].ended_at == restart
    assert {info.outcome for info in closed.values()} == {"cut off"}
    assert reader.recording("with frames") == closed["with frames"]
    assert writer.close_open_recordings(restart, "cut off") == []


def test_a_deleted_recording_takes_its_frames_with_it(url: str, writer: DatabaseWriter) -> None:
    writer.save_recording(finished("a", days=0), encode_all(tracked_day(1000)))
    writer.delete_recording("a")
    assert execute(url, "SELECT count(*) FROM chunks") == 0
    assert writer.recording("a") is None


def test_retention_keeps_young_days_and_the_newest_others(
    writer: DatabaseWriter, reader: DatabaseReader
) -> None:
    for days in range(5):
        writer.save_recording(finished(f"day-{days}", days=days, kind=RecordingKind.DAY), [])
        writer.save_recording(finished(f"show-{days}", days=days), [])
    writer.begin_recording(replace(day_info("running day"), began_at=MIDNIGHT - timedelta(days=9)))
    running = replace(
        day_info("running show", kind=RecordingKind.SHOW), began_at=MIDNIGHT - timedelta(days=9)
    )
    writer.begin_recording(running)
    assert writer.prune(days_before=MIDNIGHT + timedelta(days=3), keep=2) == 6
    left = {info.recording_id for info in reader.recordings()}
    assert left == {"day-3", "day-4", "show-3", "show-4", "running day", "running show"}


def test_damaged_frames_are_told_by_the_name_of_the_recording(url: str, writer: DatabaseWriter) -> None:
    writer.save_recording(finished("show-1", days=0), encode_all(tracked_day(100)))
    engine = writing_engine(url)
    with transaction(engine) as connection:
        connection.execute(tables.chunks.update().values(frames=b"\x01rubbish"))
    engine.dispose()
    with pytest.raises(StoreFailed, match="recording 'show-1' are damaged"):
        writer.frames("show-1")
