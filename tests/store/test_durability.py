"""What was acknowledged is there afterwards, whatever happens to the process, the disk or the file."""

import multiprocessing
import random
import sqlite3
from collections.abc import Iterator
from contextlib import closing, suppress
from dataclasses import replace
from multiprocessing.connection import Connection
from pathlib import Path

import pytest

from app.store.connections import sqlite_path
from app.store.engine import open_reader, open_writer
from app.store.migrations import upgrade
from app.store.store import JournalFilter, StoreFailed
from app.store.writer import DatabaseWriter
from tests.amount import amount
from tests.fault_result import FaultResult
from tests.patience import PATIENCE_S
from tests.store.samples import SITE, event
from tests.store.tracked_day import day_info, tracked_day

FORK = multiprocessing.get_context("fork")
KILLS = {"sqlite": amount(6, 30), "postgresql": 3}
FRAMES_A_COMMIT = 7
EVERYTHING = JournalFilter(limit=100_000)


def commit_for_ever(url: str, acknowledge: Connection, first: int) -> None:
    writer = open_writer(url)
    for number in range(first, 1_000_000):
        writer.save_site(replace(SITE, location_revision=number), [event(number)])
        writer.append_frames("day-1", tracked_day(FRAMES_A_COMMIT, begin_s=number * FRAMES_A_COMMIT))
        acknowledge.send(number)


def killed_after(url: str, first: int, acknowledgements: int) -> list[int]:
    """Return the numbers that a process acknowledged before it was killed."""
    receive, send = FORK.Pipe(duplex=False)
    child = FORK.Process(target=commit_for_ever, args=(url, send, first))
    child.start()
    send.close()
    acknowledged = []
    with closing(receive), suppress(EOFError):
        while receive.poll(20):
            acknowledged.append(int(receive.recv()))
            if len(acknowledged) == acknowledgements:
                child.kill()
    child.join(PATIENCE_S)
    return acknowledged


def test_no_acknowledged_commit_is_lost_when_the_process_is_killed(url: str) -> None:
    chance = random.Random(7)
    writer = open_writer(url)
    writer.begin_recording(day_info())
    writer.close()
    acknowledged: set[int] = set()
    stored = 0
    for _ in range(KILLS[url.partition("+")[0].partition(":")[0]]):
        acknowledged.update(killed_after(url, stored + 1, chance.randint(1, 6)))
        reader = open_writer(url)
        events = [entry.event.data["number"] for entry in reader.journal(EVERYTHING)]
        site, frames, head = reader.site(), reader.frames("day-1"), reader.recording("day-1")
        reader.close()
        assert site is not None
        assert head is not None
        stored = site.location_revision
        assert stored >= max(acknowledged)
        assert events == list(range(stored, 0, -1)), "an event and its change belong together"
        assert len(frames) == head.sample_count
        in_frames = set((frames.column("elapsed_s") // FRAMES_A_COMMIT).astype(int).tolist())
        assert acknowledged <= in_frames


def ask(writer: DatabaseWriter, pragma: str) -> object:
    """Set or read a pragma on the connection that the writer keeps."""
    with writer._writing.connect() as connection:
        return connection.exec_driver_sql(f"PRAGMA {pragma}").scalar()


@pytest.fixture
def on_sqlite(sqlite_url: str) -> Iterator[DatabaseWriter]:
    upgrade(sqlite_url)
    writer = open_writer(sqlite_url)
    yield writer
    writer.close()


@pytest.mark.fault(49)
def test_a_full_disk_is_told_and_nothing_is_half_written(
    on_sqlite: DatabaseWriter, fault: FaultResult
) -> None:
    on_sqlite.save_site(SITE, [event(1)])
    on_sqlite.begin_recording(day_info())
    ask(on_sqlite, "max_page_count = 1")
    large = replace(SITE, name="x" * 100_000)
    with pytest.raises(StoreFailed, match=r"The disk is full: nothing was stored\. Free some space") as told:
        on_sqlite.save_site(large, [event(2)])
    fault.shows(str(told.value))
    with pytest.raises(StoreFailed, match="The disk is full"):
        on_sqlite.append_frames("day-1", tracked_day(8_000))
    assert on_sqlite.site() == SITE
    assert [entry.event for entry in on_sqlite.journal(EVERYTHING)] == [event(1)]
    assert len(on_sqlite.frames("day-1")) == 0
    ask(on_sqlite, "max_page_count = 1000000")
    on_sqlite.save_site(large, [event(2)])
    assert on_sqlite.site() == large
    fault.recovers("automatic: what waited is stored once there is room")


@pytest.mark.fault(48)
def test_a_locked_database_is_told_and_works_again(
    sqlite_url: str, on_sqlite: DatabaseWriter, fault: FaultResult
) -> None:
    ask(on_sqlite, "busy_timeout = 20")
    with closing(sqlite3.connect(str(sqlite_path(sqlite_url)), isolation_level=None)) as other:
        other.execute("BEGIN IMMEDIATE")
        with pytest.raises(StoreFailed, match="locked by another program: nothing was stored") as told:
            on_sqlite.save_site(SITE)
        fault.shows(str(told.value))
        assert on_sqlite.site() is None, "reading goes on meanwhile"
        other.execute("ROLLBACK")
        on_sqlite.save_site(SITE)
    assert on_sqlite.site() == SITE
    fault.recovers("automatic: what waited is stored once the lock is gone")


def overwrite(path: Path) -> None:
    """Put rubbish over every page but the first."""
    size = path.stat().st_size
    with path.open("r+b") as file:
        file.seek(4096)
        file.write(b"\xa5" * (size - 4096))


@pytest.mark.fault(51)
def test_a_damaged_file_is_told_at_the_start(
    sqlite_url: str, on_sqlite: DatabaseWriter, fault: FaultResult
) -> None:
    on_sqlite.save_site(SITE)
    on_sqlite.close()
    overwrite(Path(str(sqlite_path(sqlite_url))))
    for opening in (open_writer, upgrade):
        with pytest.raises(
            StoreFailed, match=r"damaged.*Restore a backup with: heliopanel restore FILE"
        ) as told:
            opening(sqlite_url)
    fault.prevented("noticed at the start, before anything moves")
    fault.shows(str(told.value))


def test_a_damaged_table_is_named_at_the_start(sqlite_url: str, on_sqlite: DatabaseWriter) -> None:
    on_sqlite.append_events([event(1), event(2)])
    on_sqlite.close()
    path = Path(str(sqlite_path(sqlite_url)))
    with closing(sqlite3.connect(path)) as connection:
        (page,) = connection.execute("SELECT rootpage FROM sqlite_master WHERE name = 'events'").fetchone()
    with path.open("r+b") as file:
        file.seek((page - 1) * 4096 + 8)
        places = file.read(4)
        file.seek(-4, 1)
        file.write(places[2:] + places[:2])
    with pytest.raises(StoreFailed, match=r"is damaged \(table events\)\. Restore a backup"):
        open_writer(sqlite_url)


def test_a_file_that_is_no_database_is_told_at_the_start(sqlite_url: str) -> None:
    Path(str(sqlite_path(sqlite_url))).write_bytes(b"This is not a database at all. " * 400)
    for opening in (open_writer, upgrade):
        with pytest.raises(StoreFailed, match=r"The file is not a database\. Restore a backup"):
            opening(sqlite_url)


def test_after_damage_nothing_more_is_written(sqlite_url: str, on_sqlite: DatabaseWriter) -> None:
    on_sqlite.save_site(SITE)
    on_sqlite.close()
    on_sqlite = DatabaseWriter(on_sqlite._reading, on_sqlite._writing)
    on_sqlite.close()
    overwrite(Path(str(sqlite_path(sqlite_url))))
    with pytest.raises(StoreFailed, match="damaged"):
        on_sqlite.save_site(SITE)
    with pytest.raises(StoreFailed, match="damaged"):
        on_sqlite.append_events([])


def test_the_writer_is_set_up_for_power_cuts(on_sqlite: DatabaseWriter) -> None:
    wanted = {"journal_mode": "wal", "synchronous": 2, "foreign_keys": 1, "busy_timeout": 3000}
    assert {pragma: ask(on_sqlite, pragma) for pragma in wanted} == wanted


def test_a_reader_cannot_write(sqlite_url: str, on_sqlite: DatabaseWriter) -> None:
    reader = open_reader(sqlite_url)
    with reader._reading.connect() as connection, pytest.raises(Exception, match="readonly database"):
        connection.exec_driver_sql("INSERT INTO site VALUES (9, '{}')")
    reader.close()
