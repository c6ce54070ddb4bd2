"""Does what came at once one by one, so that everybody else gets a turn in between."""

import asyncio
from collections import deque
from collections.abc import Callable


class Turnstile:
    """Does what came at once one by one; between two of them everybody else gets a turn.

    While it is held, what came waits: something is under way that is more urgent.
    """

    def __init__(self) -> None:
        self._waiting: deque[Callable[[], None]] = deque()
        self._held: asyncio.TimerHandle | None = None
        self._has_turn = False

    def __len__(self) -> int:
        return len(self._waiting)

    def add(self, work: Callable[[], None]) -> None:
        """Do this after what waits already."""
        self._waiting.append(work)
        self._go_on()

    def hold(self, at_most_s: float) -> None:
        """Let everything wait until it is released, at most so long from now."""
        self.release()
        self._held = asyncio.get_running_loop().call_later(at_most_s, self.release)

    def release(self) -> None:
        """Go on with what waits."""
        if self._held is not None:
            self._held.cancel()
            self._held = None
            self._go_on()

    def _go_on(self) -> None:
        if self._waiting and self._held is None and not self._has_turn:
            self._has_turn = True
            asyncio.get_running_loop().call_soon(self._turn)

    def _turn(self) -> None:
        self._has_turn = False
        if self._held is not None:
            return
        try:
            self._waiting[0]()
        finally:
            self._waiting.popleft()
            self._go_on()
