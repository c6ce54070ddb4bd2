"""Storage: a tracked day of a sample a second, and commits that survive a power cut"""

import sqlite3
import statistics
import tempfile
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter

import numpy as np

from app.store.chunks import encode_all
from app.store.decimate import decimate
from app.store.engine import open_reader, open_writer
from app.store.migrations import upgrade
from app.store.store import JournalFilter
from app.store.writer import DatabaseWriter
from app.tracker.memory.recording import COLUMNS, Frames
from bench.table import Row, at_most, beside, must_hold
from tests.store.samples import event
from tests.store.test_durability import killed_after
from tests.store.tracked_day import MIDNIGHT, day_info, tracked_day

COMMAND = "python -m bench store"
POINTS = 1000
MOST_BYTES_A_VALUE = 2.0
WHOLE = replace(day_info("whole"), ended_at=MIDNIGHT)
INSERT = f"INSERT INTO frames VALUES ({', '.join('?' * (len(COLUMNS) + 1))})"  # noqa: S608 - our own columns


@dataclass(frozen=True, slots=True)
class Size:
    """How many samples the day has, how many commits are timed, how often the writer is killed."""

    samples: int = 86_400
    commits: int = 300
    kills: int = 100


SMALL = Size(samples=2000, commits=10, kills=2)


def measure(size: Size = Size()) -> list[Row]:
    """Return what storage costs, beside rows in plain SQLite through the bare driver."""
    frames = tracked_day(size.samples)
    with tempfile.TemporaryDirectory() as folder:
        url = f"sqlite:///{Path(folder) / 'heliopanel.db'}"
        upgrade(url)
        with _rows(Path(folder)) as rows, _opened(url) as writer:
            measured = [*_day(writer, rows, frames), *_commits(writer, rows, size.commits)]
        return [*measured, _kills(url, size.kills)]


@contextmanager
def _rows(folder: Path) -> Iterator[sqlite3.Connection]:
    """Yield the peer: one row a frame, key (recording, elapsed), the same durability."""
    with closing(sqlite3.connect(folder / "rows.db", isolation_level=None)) as rows:
        rows.execute("PRAGMA journal_mode = WAL")
        rows.execute("PRAGMA synchronous = FULL")
        rows.execute(f"CREATE TABLE frames (recording TEXT, {', '.join(COLUMNS)})")
        rows.execute("CREATE INDEX by_time ON frames (recording, elapsed_s)")
        rows.execute("CREATE TABLE events (number INTEGER PRIMARY KEY, message TEXT)")
        yield rows


@contextmanager
def _opened(url: str) -> Iterator[DatabaseWriter]:
    writer = open_writer(url)
    yield writer
    writer.close()


def _day(writer: DatabaseWriter, rows: sqlite3.Connection, frames: Frames) -> list[Row]:
    chunks = encode_all(frames)
    size = sum(map(len, chunks)) / frames.values.size
    ours_write = _seconds(lambda: writer.save_recording(WHOLE, encode_all(frames)), times=1)
    peer_write = _seconds(lambda: _insert(rows, frames), times=1)
    ours_read = _seconds(lambda: writer.frames("whole"))
    peer_read = _seconds(lambda: _select(rows), times=3)
    trend = _seconds(lambda: decimate(writer.frames("whole"), POINTS))
    pages, page = (rows.execute(f"PRAGMA {name}").fetchone()[0] for name in ("page_count", "page_size"))
    return [
        at_most("bytes a value", size, MOST_BYTES_A_VALUE, "B", COMMAND),
        _row("bytes a value, beside rows with an index", size, pages * page / frames.values.size, "B"),
        _row("store a whole day, beside rows", ours_write * 1e3, peer_write * 1e3, "ms"),
        _row("read a whole day, beside rows", ours_read * 1e3, peer_read * 1e3, "ms"),
        _row(f"read a day and keep {POINTS} points, beside reading rows", trend * 1e3, peer_read * 1e3, "ms"),
    ]


def _commits(writer: DatabaseWriter, rows: sqlite3.Connection, commits: int) -> list[Row]:
    writer.begin_recording(day_info())
    batch = iter([Frames(part) for part in np.array_split(tracked_day(commits * 3).values, commits)])
    ours = [_seconds(lambda: writer.append_events([event()]), times=1) for _ in range(commits)]
    peer = [_seconds(lambda: _append(rows), times=1) for _ in range(commits)]
    grow = [_seconds(lambda: writer.append_frames("day-1", next(batch)), times=1) for _ in range(commits)]
    return [
        _row("commit one event, median, beside the bare driver", _median_ms(ours), _median_ms(peer), "ms"),
        _row("commit one event, p99, beside the bare driver", _p99_ms(ours), _p99_ms(peer), "ms"),
        _row(
            "add 3 samples to a recording, median, beside one bare row",
            _median_ms(grow),
            _median_ms(peer),
            "ms",
        ),
    ]


def _kills(url: str, kills: int) -> Row:
    """Return how many acknowledged commits were lost when the writing process was killed again and again."""
    acknowledged: set[int] = set()
    for number in range(kills):
        acknowledged.update(killed_after(url, max(acknowledged, default=0) + 10, number % 5 + 1))
    reader = open_reader(url)
    stored = {entry.event.data["number"] for entry in reader.journal(JournalFilter(limit=1_000_000))}
    reader.close()
    lost = len(acknowledged - stored)
    return must_hold(
        f"commits lost of {len(acknowledged)} acknowledged, in {kills} kills",
        str(lost),
        "0",
        COMMAND,
        holds=lost == 0,
    )


def _insert(rows: sqlite3.Connection, frames: Frames) -> None:
    rows.execute("BEGIN IMMEDIATE")
    rows.executemany(INSERT, [("whole", *row) for row in frames.values.tolist()])
    rows.execute("COMMIT")


def _select(rows: sqlite3.Connection) -> Frames:
    found = rows.execute("SELECT * FROM frames WHERE recording = 'whole' ORDER BY elapsed_s").fetchall()
    return Frames(np.array([row[1:] for row in found], dtype=np.float64))


def _append(rows: sqlite3.Connection) -> None:
    rows.execute("BEGIN IMMEDIATE")
    rows.execute("INSERT INTO events (message) VALUES ('Event 0.')")
    rows.execute("COMMIT")


def _seconds(work: Callable[[], object], *, times: int = 7) -> float:
    """Return the shortest of several runs."""
    shortest = float("inf")
    for _ in range(times):
        begin = perf_counter()
        work()
        shortest = min(shortest, perf_counter() - begin)
    return shortest


def _median_ms(seconds: list[float]) -> float:
    return statistics.median(seconds) * 1e3


def _p99_ms(seconds: list[float]) -> float:
    return statistics.quantiles(seconds, n=100)[98] * 1e3


def _row(name: str, ours: float, peer: float, unit: str) -> Row:
    return beside(name, f"{ours:.3g} {unit}", f"{peer:.3g} {unit}", peer / ours, COMMAND)
