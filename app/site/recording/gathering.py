"""Gathers what is written behind the loop: a storm over a field is a few transactions, not one a tracker."""

import asyncio
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from datetime import timedelta
from typing import Protocol, TypeVar

from app.audit.entry import Entry
from app.base.clock import Clock
from app.store.store import Writer

T = TypeVar("T")
Missed = Callable[[Entry | None], None]

EVERY = timedelta(milliseconds=100)
"""So long what was posted waits for more at most; what comes alone is handed over at once."""
LONGEST_WAY_S, LOOKED_EVERY_S = 0.5, 0.002
"""So long a batch waits at most for a loop that is pressed, and how often it looks."""
MOST_AT_FAULT = 3
"""So many pieces of a batch may fail before it is the disk that does."""


class BackgroundWriter(Protocol):
    """A writer with a thread of its own."""

    async def call(self, work: Callable[[Writer], T]) -> T:
        """Do the work in its turn and return what it returned, or raise what it raised."""

    def post(self, work: Callable[[Writer], object]) -> bool:
        """Do the work in its turn, or return that there is no room; failures go to who watches the writer."""


@dataclass(frozen=True, slots=True, eq=False)
class Waiting:
    """One piece of work, and the audit entry that it takes along."""

    work: Callable[[Writer], object]
    entry: Entry | None


class GiveWay:
    """Has the writer's thread wait between two pieces while the loop has ticks and stops to catch up with.

    Both would else have the interpreter by turns, and a burst over a field would take twice as long.
    """

    def __init__(self, pressed: Callable[[], bool], pause: Callable[[float], object]) -> None:
        self._pressed = pressed
        self._pause = pause

    def __call__(self, batch: Sequence[Waiting]) -> Iterator[Waiting]:
        """Yield the pieces of a batch, each when the loop is not pressed, all of them soon."""
        waited_s = 0.0
        for one in batch:
            while waited_s < LONGEST_WAY_S and self._pressed():
                self._pause(LOOKED_EVERY_S)
                waited_s += LOOKED_EVERY_S
            yield one


class Gathering:
    """Hands work to the writer in the order in which it was given, all that gathered as one transaction.

    `missed` hears of every piece that was not stored, with its entry; on the writer's thread, or here if
    there is no room.
    """

    def __init__(
        self,
        writer: BackgroundWriter,
        clock: Clock,
        missed: Missed,
        paced: Callable[[Sequence[Waiting]], Iterable[Waiting]] = iter,
    ) -> None:
        self._paced = paced
        self._writer = writer
        self._clock = clock
        self._missed = missed
        self._waiting: list[Waiting] = []
        self._due = clock.now()
        self._task: asyncio.Task[None] | None = None

    def add(self, work: Callable[[Writer], object], entry: Entry | None) -> None:
        """Have this stored soon, after everything that was added before."""
        self._waiting.append(Waiting(work, entry))
        if self._task is None:
            self._task = asyncio.create_task(self._hand_over_soon())

    def hand_over(self) -> None:
        """Hand to the writer what has gathered, so that what it is given next comes after it."""
        batch, self._waiting = self._waiting, []
        if batch:
            self._due = self._clock.now() + EVERY
            if not self._writer.post(lambda writer: self._store(writer, batch)):
                self._miss(batch)

    def close(self) -> None:
        """Hand over what has gathered, and gather no more by itself."""
        if self._task is not None:
            self._task.cancel()
        self.hand_over()

    async def _hand_over_soon(self) -> None:
        await self._clock.sleep_until(self._due)
        self._task = None
        self.hand_over()

    def _store(self, writer: Writer, batch: list[Waiting]) -> None:
        """Store all of it, without the pieces that cannot be stored; where more of them fail, nothing."""
        failure: Exception | None = None
        for _ in range(MOST_AT_FAULT):
            doing: list[Waiting] = []
            try:
                _do_together(writer, self._paced(batch), doing)
                break
            except Exception as error:  # noqa: BLE001 - what can be stored is stored first, then it is raised
                failure, at_fault = error, doing[-1:]
                self._miss(at_fault)
                batch = [one for one in batch if one not in at_fault]
        else:
            self._miss(batch)
        if failure is not None:
            raise failure

    def _miss(self, batch: list[Waiting]) -> None:
        for one in batch:
            self._missed(one.entry)


def _do_together(writer: Writer, batch: Iterable[Waiting], doing: list[Waiting]) -> None:
    """Do it in one transaction; what is being done last is noted, nothing while beginning or ending it."""
    with writer.together():
        for one in batch:
            doing.append(one)
            one.work(writer)
        doing.clear()
