"""A loop on which only waiting for nothing takes time: no time-out depends on how busy the computer is.

Its time stands still while something is worked on or on its way, and leaps to the next timer once all is
quiet. Sockets and terminals are the real ones; both ends must be served by this loop.
"""

import asyncio
import selectors
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from typing import Any

QUIET_AFTER_S = 0.02
"""For so long at most, really, it is waited for what may still arrive."""

START = datetime(2026, 6, 21, 4, 0, tzinfo=UTC)


class _Selector(selectors.PollSelector):
    """Asks every file anew: to poll Linux hands on at once what a terminal was sent, to epoll later."""

    leap: Callable[[float], None]
    others_work: Callable[[], bool]

    def select(self, timeout: float | None = None) -> list[tuple[selectors.SelectorKey, int]]:
        if timeout is not None and timeout <= 0.0:
            return super().select(0.0)
        if timeout is None or self.others_work():
            return super().select(None)
        found = super().select(min(timeout, QUIET_AFTER_S))
        if not found:
            self.leap(timeout)
        return found


class PatientLoop(asyncio.SelectorEventLoop):
    """Leaps from timer to timer; a thread that works for it is waited for."""

    def __init__(self) -> None:
        self._passed_s = 0.0
        self._in_threads = 0
        selector = _Selector()
        selector.leap, selector.others_work = self._leap, lambda: self._in_threads > 0
        super().__init__(selector)

    def time(self) -> float:
        """Return how long was waited for nothing, in seconds."""
        return self._passed_s

    def run_in_executor(self, executor: Any, func: Callable[..., Any], *args: Any) -> "asyncio.Future[Any]":
        """Have a thread do something; until it has done so no time passes."""
        self._in_threads += 1
        working = super().run_in_executor(executor, func, *args)
        working.add_done_callback(self._one_less)
        return working

    def _one_less(self, done: "asyncio.Future[Any]") -> None:
        self._in_threads -= 1

    def _leap(self, by_s: float) -> None:
        self._passed_s += by_s


class LoopClock:
    """The site's time as the loop that runs has it."""

    def now(self) -> datetime:
        """Return the present instant."""
        return START + timedelta(seconds=asyncio.get_running_loop().time())

    async def sleep_until(self, at: datetime) -> None:
        """Sleep for what is left until then."""
        await asyncio.sleep(max(0.0, (at - self.now()).total_seconds()))
