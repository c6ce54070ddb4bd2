"""Lanes for what must never wait and must never pile up: one call a key at a time, none of them lost."""

import asyncio
from collections.abc import Callable, Coroutine, Hashable
from datetime import timedelta
from typing import Any, Generic, TypeVar

from app.base.clock import Clock, set_or_at

T = TypeVar("T")
Work = Callable[[], Coroutine[Any, Any, T]]
PATIENCE = timedelta(milliseconds=250)
"""So long the next call waits for the answer to the one before it: a stop is never later than that."""


class Lanes(Generic[T]):
    """Calls by key. What is asked while one is under way is done by the next one, for all who asked by then.

    So the next call always begins after whoever is answered by it asked: no stop is ever lost.
    """

    def __init__(self, clock: Clock, patience: timedelta = PATIENCE) -> None:
        self._clock = clock
        self._patience = patience
        self._under_way: dict[Hashable, asyncio.Event] = {}
        self._next: dict[Hashable, asyncio.Task[T]] = {}

    def __len__(self) -> int:
        return len(self._under_way) + len(self._next)

    def waits(self, key: Hashable) -> bool:
        """Return whether a next call of this key waits already: one more would change nothing."""
        return key in self._next

    async def ask(self, key: Hashable, work: Work[T]) -> T:
        """Do this at once where nothing of its key is under way, else with the next call of its key."""
        if key not in self._under_way:
            answered = self._under_way[key] = asyncio.Event()
            return await asyncio.shield(_kept(self._call(key, answered, work)))
        if key not in self._next:
            self._next[key] = _kept(self._follow(key, self._under_way[key], work))
        return await asyncio.shield(self._next[key])

    async def _follow(
        self, key: Hashable, before: asyncio.Event, work: Callable[[], Coroutine[Any, Any, T]]
    ) -> T:
        await set_or_at(before, self._clock, self._clock.now() + self._patience)
        del self._next[key]
        answered = self._under_way[key] = asyncio.Event()
        return await self._call(key, answered, work)

    async def _call(
        self, key: Hashable, answered: asyncio.Event, work: Callable[[], Coroutine[Any, Any, T]]
    ) -> T:
        try:
            return await work()
        finally:
            answered.set()
            if self._under_way.get(key) is answered:
                del self._under_way[key]


def _kept(work: Coroutine[Any, Any, T]) -> asyncio.Task[T]:
    """Begin this beside everything else; it is carried to its end though nobody waits any more."""
    task = asyncio.create_task(work)
    task.add_done_callback(_looked_at)
    return task


def _looked_at(task: "asyncio.Task[object]") -> None:
    if not task.cancelled():
        task.exception()
