"""A process that commits and acknowledges: `python -m tests.store.committing URL COMMITS CHECKPOINT SYNC`.

Each commit writes the site, an event and frames; once the writer's call has returned, the number goes to the
file `acknowledged` beside the database, as the machine would tell the person who asked.
"""

import os
import sys
from dataclasses import replace

from app.store.connections import sqlite_path
from app.store.engine import open_writer
from app.store.store import JournalFilter
from tests.store.samples import SITE, event
from tests.store.tracked_day import tracked_day

FRAMES_A_COMMIT = 7
RECORDING = "day-1"
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
        writer.append_frames(RECORDING, tracked_day(FRAMES_A_COMMIT, begin_s=number * FRAMES_A_COMMIT))
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
        head, frames = writer.recording(RECORDING), writer.frames(RECORDING)
        assert head is not None
        assert len(frames) == head.frame_count
        batches = sorted(set((frames.column("elapsed_s") // FRAMES_A_COMMIT).astype(int).tolist()))
        assert batches == list(range(1, len(batches) + 1)), "frames are stored in their order"
        assert len(batches) in (stored, stored - 1)
        writer.save_site(replace(SITE, location_revision=stored + 1), [event(stored + 1)])
        return max(0, acknowledged - len(batches))
    finally:
        writer.close()


if __name__ == "__main__":
    commit(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), sys.argv[4])
