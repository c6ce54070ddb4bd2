"""The writer thread: answers after the commit, reports what fails, drops nothing in silence."""

import asyncio
import threading
from collections.abc import Iterator
from datetime import timedelta

import pytest

from app.base.clock import VirtualClock
from app.store.engine import open_writer
from app.store.migrations import upgrade
from app.store.store import JournalFilter, StoreFailed, Writer
from app.store.writer import DatabaseWriter
from app.store.writer_thread import FLOODED, FULL, WriterThread
from tests.fault_result import BY_ITSELF, VIRTUAL, FaultResult
from tests.store.samples import NOON, SITE, event

PATIENCE_S = 20.0


@pytest.fixture
def stored(sqlite_url: str) -> Iterator[DatabaseWriter]:
    upgrade(sqlite_url)
    writer = open_writer(sqlite_url)
    yield writer
    writer.close()


@pytest.fixture
def reports() -> list[Exception]:
    """The failures that were reported."""
    return []


@pytest.fixture
def clock() -> VirtualClock:
    return VirtualClock(NOON)


@pytest.fixture
def thread(stored: DatabaseWriter, reports: list[Exception], clock: VirtualClock) -> Iterator[WriterThread]:
    started = WriterThread(stored, reports.append, capacity=3, clock=clock)
    yield started
    assert started.close()


class Disk:
    """Work that holds the thread up until it is released, as a slow card would."""

    def __init__(self) -> None:
        self.busy, self.released = threading.Event(), threading.Event()

    def __call__(self, _writer: Writer) -> None:
        self.busy.set()
        assert self.released.wait(PATIENCE_S)

    def hold(self, thread: WriterThread) -> None:
        thread.post(self)
        assert self.busy.wait(PATIENCE_S)


def append(number: int, writer: Writer) -> None:
    writer.append_events([event(number)])


async def test_a_call_answers_after_the_commit(thread: WriterThread, stored: DatabaseWriter) -> None:
    await thread.call(lambda writer: writer.save_site(SITE))
    assert stored.site() == SITE
    assert await thread.call(lambda writer: writer.site()) == SITE


async def test_a_call_raises_what_the_database_says(thread: WriterThread, reports: list[Exception]) -> None:
    with pytest.raises(StoreFailed, match="not open"):
        await thread.call(lambda writer: writer.finish_recording("nowhere", event().at, ""))
    assert reports == []


async def test_a_posted_failure_is_counted_and_reported(
    thread: WriterThread, reports: list[Exception]
) -> None:
    thread.post(lambda writer: writer.finish_recording("nowhere", event().at, ""))
    thread.post(lambda _writer: 1 // 0)
    await thread.call(lambda writer: writer.save_site(SITE))
    assert thread.failed == 2
    assert [type(failure) for failure in reports] == [StoreFailed, ZeroDivisionError]


async def test_a_slow_disk_never_blocks_and_what_is_dropped_is_told(
    thread: WriterThread, reports: list[Exception], stored: DatabaseWriter, clock: VirtualClock
) -> None:
    disk = Disk()
    disk.hold(thread)
    clock.advance(timedelta(seconds=1))
    for number in range(5):
        thread.post(lambda writer, number=number: append(number, writer))  # type: ignore[misc]
    with pytest.raises(StoreFailed, match="disk is too slow: 3 writes are waiting"):
        await thread.call(lambda writer: writer.save_site(SITE))
    assert thread.dropped == 2
    assert [str(failure)[:20] for failure in reports] == ["The disk is too slow"] * 2
    disk.released.set()
    assert thread.close()
    kept = [entry.event.data["number"] for entry in stored.journal(JournalFilter())]
    assert kept == [2, 1, 0], "in the order in which they came"
    assert stored.site() is None


@pytest.mark.fault(87)
async def test_a_flood_of_events_is_not_blamed_on_the_disk(
    thread: WriterThread, reports: list[Exception], clock: VirtualClock, fault: FaultResult
) -> None:
    disk = Disk()
    disk.hold(thread)
    clock.advance(timedelta(milliseconds=99))
    for number in range(4):
        thread.post(lambda writer, number=number: append(number, writer))  # type: ignore[misc]
    assert [str(failure) for failure in reports] == [FLOODED.format(capacity=3)]
    fault.shows("Too many events at once: 3 writes are waiting, although the disk is fast enough.")
    fault.noticed(0.0, VIRTUAL)
    disk.released.set()
    assert thread.close()
    fault.recovers(BY_ITSELF)


async def test_a_disk_that_takes_long_for_every_write_is_too_slow(
    thread: WriterThread, reports: list[Exception], clock: VirtualClock
) -> None:
    await thread.call(lambda _writer: clock.advance(timedelta(milliseconds=200)))
    disk = Disk()
    disk.hold(thread)
    for number in range(4):
        thread.post(lambda writer, number=number: append(number, writer))  # type: ignore[misc]
    assert [str(failure) for failure in reports] == [FULL.format(capacity=3)]
    disk.released.set()


async def test_a_call_that_nobody_awaits_any_more_is_not_begun(
    thread: WriterThread, stored: DatabaseWriter
) -> None:
    disk = Disk()
    disk.hold(thread)
    waiting = asyncio.ensure_future(thread.call(lambda writer: writer.save_site(SITE)))
    await asyncio.sleep(0)
    waiting.cancel()
    with pytest.raises(asyncio.CancelledError):
        await waiting
    disk.released.set()
    assert thread.close()
    assert stored.site() is None


async def test_closing_finishes_what_waits_and_refuses_the_rest(
    thread: WriterThread, stored: DatabaseWriter, reports: list[Exception]
) -> None:
    thread.post(lambda writer: append(1, writer))
    assert thread.close()
    assert len(stored.journal(JournalFilter())) == 1
    with pytest.raises(StoreFailed, match="The store is closed"):
        await thread.call(lambda writer: writer.save_site(SITE))
    thread.post(lambda writer: append(2, writer))
    assert thread.dropped == len(reports) == 1


def test_closing_is_bounded_in_time(stored: DatabaseWriter) -> None:
    thread, disk = WriterThread(stored, print), Disk()
    disk.hold(thread)
    assert not thread.close(seconds=0.05)
    disk.released.set()
    assert thread.close()
