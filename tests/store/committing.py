"""A process that commits and acknowledges: `python -m tests.store.committing URL COMMITS CHECKPOINT SYNC`.

Each commit writes the site and an event, and a batch of samples of two recordings, which are packed now and
then; once the writer's call has returned, the number goes to the file `acknowledged` beside the database, as
the machine would tell the person who asked.
"""

import os
import sys
from dataclasses import replace

from app.store.connections import sqlite_path
from app.store.engine import open_writer
from app.store.store import JournalFilter, Recorded
from app.store.writer import DatabaseWriter
from tests.store.samples import SITE, event
from tests.store.tracked_day import tracked_day

FRAMES_A_COMMIT = 40
RECORDINGS = ("day-1", "day-2")
ACKNOWLEDGED = "acknowledged"
EVERYTHING = JournalFilter(limit=100_000)


def commit(url: str, commits: int, checkpoint_pages: int, synchronous: str) -> None:
    """Commit and acknowledge again and again; the last words are what the store was asked to be."""
    path = sqlite_path(url)
    assert path is not None
    writer = open_writer(url)
    connection = writer._writing.raw_connection()
    connection.execute(f"PRAGMA wal_autocheckpoint = {checkpoint_pages}")
    if synchronous != "as_shipped":
        connection.execute(f"PRAGMA synchronous = {synchronous}")
    connection.close()
    told = os.open(path.with_name(ACKNOWLEDGED), os.O_WRONLY | os.O_CREAT)
    for number in range(1, commits + 1):
        writer.save_site(replace(SITE, location_revision=number), [event(number)])
        samples = tracked_day(FRAMES_A_COMMIT, begin_s=number * FRAMES_A_COMMIT)
        writer.keep_recorded(Recorded(samples=dict.fromkeys(RECORDINGS, samples)))
        os.write(told, f"{number}\n".encode())
    os.close(told)


def check(url: str, acknowledged: int) -> int:
    """Open the store as the machine does and check it; return how many acknowledged commits are missing."""
    writer = open_writer(url)
    try:
        with writer._writing.connect() as connection:
            assert connection.exec_driver_sql("PRAGMA integrity_check").scalars().all() == ["ok"]
        site = writer.site()
        stored = 0 if site is None else site.location_revision
        events = [entry.event.data["number"] for entry in writer.journal(EVERYTHING)]
        assert events == list(range(stored, 0, -1)), "an event and its change belong together"
        batches = _batches(writer, RECORDINGS[0])
        assert batches == _batches(writer, RECORDINGS[1]), "a batch is there for all recordings, or for none"
        assert batches in (stored, stored - 1)
        writer.save_site(replace(SITE, location_revision=stored + 1), [event(stored + 1)])
        return max(0, acknowledged - batches)
    finally:
        writer.close()


def _batches(writer: DatabaseWriter, recording_id: str) -> int:
    """Return how many batches of samples a recording has, whole and in their order."""
    head, frames = writer.recording(recording_id), writer.frames(recording_id)
    assert head is not None
    assert len(frames) == head.sample_count
    found = (frames.column("elapsed_s") // FRAMES_A_COMMIT).astype(int).tolist()
    count = len(found) // FRAMES_A_COMMIT
    assert found == [number for number in range(1, count + 1) for _ in range(FRAMES_A_COMMIT)]
    return count


if __name__ == "__main__":
    commit(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), sys.argv[4])
