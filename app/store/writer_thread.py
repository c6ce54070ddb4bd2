"""A thread that writes, so that the control loop never waits for a disk."""

import asyncio
import queue
import threading
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from contextlib import suppress
from datetime import datetime, timedelta
from typing import TypeVar

from app.base.clock import Clock, SystemClock
from app.base.message import N_
from app.store.store import StoreFailed, Writer

T = TypeVar("T")

SLOW = timedelta(milliseconds=100)
"""A disk that takes longer for a write, on average, is too slow."""
STUCK = timedelta(seconds=1)
"""A write that takes longer than this holds up all others."""
LAST = 20

FULL = N_("The disk is too slow: {capacity} writes are waiting. Nothing was stored; check the disk or card.")
FLOODED = N_(
    "Too many events at once: {capacity} writes are waiting, although the disk is fast enough. "
    "Nothing was stored; check the journal for their source."
)
CLOSED = N_("The store is closed: nothing was stored. Start Heliopanel again.")


class WriterThread:
    """Carries out writes one after the other, in the order they were given, on a thread of its own.

    `on_failure` is called on that thread with every failure of a posted write, and on the caller's with
    a write that found no room: nothing is lost in silence.
    """

    def __init__(
        self,
        writer: Writer,
        on_failure: Callable[[Exception], None],
        *,
        capacity: int = 1000,
        clock: Clock | None = None,
    ) -> None:
        self._writer = writer
        self._on_failure = on_failure
        self._capacity = capacity
        self._clock = clock or SystemClock()
        self._took: deque[timedelta] = deque(maxlen=LAST)
        self._begun: datetime | None = None
        self._queue: queue.Queue[Callable[[], None] | None] = queue.Queue(capacity)
        self._closed = False
        self._dropped = 0
        self._failed = 0
        self._thread = threading.Thread(target=self._run, name="store-writer", daemon=True)
        self._thread.start()

    @property
    def pending(self) -> int:
        """Return how many writes wait."""
        return self._queue.qsize()

    @property
    def dropped(self) -> int:
        """Return how many posted writes found no room and were reported."""
        return self._dropped

    @property
    def failed(self) -> int:
        """Return how many posted writes the database refused and were reported."""
        return self._failed

    async def call(self, work: Callable[[Writer], T]) -> T:
        """Return what the work returns, once committed; raise what it raises, `StoreFailed` without room."""
        answer: Future[T] = Future()
        self._put(lambda: self._answer(work, answer))
        return await asyncio.wrap_future(answer)

    def post(self, work: Callable[[Writer], object]) -> bool:
        """Have the work done later, without waiting, and return whether there was room for it.

        A failure or a full queue is counted and reported.
        """
        try:
            self._put(lambda: self._report(work))
        except StoreFailed as failure:
            self._dropped += 1
            self._on_failure(failure)
            return False
        return True

    def close(self, *, seconds: float = 10.0) -> bool:
        """Refuse new writes, finish those that wait within a bound, and return whether all were finished."""
        self._closed = True
        with suppress(queue.Full):
            self._queue.put(None, timeout=seconds)
        self._thread.join(seconds)
        return not self._thread.is_alive()

    def _put(self, work: Callable[[], None]) -> None:
        if self._closed:
            raise StoreFailed(CLOSED)
        try:
            self._queue.put_nowait(work)
        except queue.Full:
            text = FULL if self._is_slow() else FLOODED
            raise StoreFailed(text.format(capacity=self._capacity)) from None

    def _is_slow(self) -> bool:
        """Return whether what waits does so for the disk: by how long it takes for what it was given."""
        begun, took = self._begun, tuple(self._took)
        if begun is not None and self._clock.now() - begun >= STUCK:
            return True
        return bool(took) and sum(took, timedelta()) / len(took) >= SLOW

    def _run(self) -> None:
        while (work := self._queue.get()) is not None:
            begun = self._begun = self._clock.now()
            work()
            self._begun = None
            self._took.append(self._clock.now() - begun)

    def _answer(self, work: Callable[[Writer], T], answer: Future[T]) -> None:
        if not answer.set_running_or_notify_cancel():
            return
        try:
            answer.set_result(work(self._writer))
        except Exception as error:  # noqa: BLE001 - whoever awaits the answer gets it
            answer.set_exception(error)

    def _report(self, work: Callable[[Writer], object]) -> None:
        try:
            work(self._writer)
        except Exception as error:  # noqa: BLE001 - one bad write must not end the thread; it is reported
            self._failed += 1
            self._on_failure(error)
