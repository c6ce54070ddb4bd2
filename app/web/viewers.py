"""One reader of the live stream: the newest state, everything else in order, all of it bounded."""

import asyncio
from collections import deque
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from datetime import timedelta

from app.web.languages.known import ENGLISH

MOST_TOLD = 1000


class TooSlow(Exception):
    """A reader does not take what it is sent; it is dropped."""


@dataclass(frozen=True, slots=True)
class Message:
    """JSON text that is ready to be sent; `mark` is the place in the stream of server-sent events."""

    name: str
    text: str
    mark: str = ""


@dataclass(frozen=True, slots=True)
class Wanted:
    """What a reader asked for: one tracker or all (None), these kinds or all (empty), its language."""

    tracker_id: str | None = None
    kinds: frozenset[str] = frozenset()
    language: str = ENGLISH.code

    def includes(self, kind: str, tracker_id: str | None) -> bool:
        """Return whether something of this kind, about this tracker or the site (None), is wanted."""
        about = self.tracker_id is None or tracker_id is None or tracker_id == self.tracker_id
        return about and (not self.kinds or kind in self.kinds)


class Viewer:
    """What one reader has not been sent yet."""

    def __init__(self, wanted: Wanted) -> None:
        self.wanted = wanted
        self._state: Message | None = None
        self._told: deque[Message] = deque()
        self._ready = asyncio.Event()

    def show(self, state: Message) -> None:
        """Let the reader have this state next; one that it has not had yet is forgotten."""
        self._state = state
        self._ready.set()

    def tell(self, message: Message) -> None:
        """Let the reader have this message, after those that came before it."""
        self._told.append(message)
        self._ready.set()

    async def take(self) -> list[Message]:
        """Wait until there is something to send and return it, messages before state."""
        await self._ready.wait()
        self._ready.clear()
        if len(self._told) > MOST_TOLD:
            raise TooSlow
        messages = [*self._told, *([self._state] if self._state else [])]
        self._told.clear()
        self._state = None
        return messages


async def pump(viewer: Viewer, send: Callable[[Message], Awaitable[None]], patience: timedelta) -> None:
    """Send what comes for a reader, for ever; raise `TooSlow` when one message outlasts `patience`."""
    while True:
        for message in await viewer.take():
            try:
                async with asyncio.timeout(patience.total_seconds()):
                    await send(message)
            except TimeoutError as error:
                raise TooSlow from error
