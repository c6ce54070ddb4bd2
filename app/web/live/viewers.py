"""One reader of the live stream: the newest state, everything else in order, all of it bounded."""

import asyncio
from collections import deque
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from datetime import datetime, timedelta

from app.web.languages.known import ENGLISH

MOST_TOLD = 1000


class TooSlow(Exception):
    """A reader does not take what it is sent; it is dropped."""


@dataclass(frozen=True, slots=True)
class Message:
    """JSON text that is ready to be sent; `mark` is the place in the stream of server-sent events.

    `revision` is that of the state in it, None if it has none.
    """

    name: str
    text: str
    mark: str = ""
    revision: int | None = None


@dataclass(frozen=True, slots=True)
class Wanted:
    """What a reader asked for: one tracker or all (None), these kinds or all (empty), its language.

    `trackers` are those that it may see, None where it may see all. One that is `always_whole` gets all
    trackers each time, not those that changed.
    """

    tracker_id: str | None = None
    kinds: frozenset[str] = frozenset()
    language: str = ENGLISH.code
    trackers: frozenset[str] | None = None
    always_whole: bool = False

    def includes(self, kind: str, tracker_id: str | None) -> bool:
        """Return whether something of this kind, about this tracker or the site (None), is wanted."""
        about = self.tracker_id is None or tracker_id is None or tracker_id == self.tracker_id
        allowed = self.trackers is None or tracker_id is None or tracker_id in self.trackers
        return about and allowed and (not self.kinds or kind in self.kinds)


class Viewer:
    """What one reader has not been sent yet."""

    def __init__(self, wanted: Wanted) -> None:
        self.wanted = wanted
        self.since: int | None = None
        """The revision of the state that it took last."""
        self.shown_at: datetime | None = None
        self._state: Message | None = None
        self._told: deque[Message] = deque()
        self._ready = asyncio.Event()

    def show(self, state: Message, at: datetime) -> None:
        """Let the reader have this state next; one that it has not had yet is forgotten."""
        self._state, self.shown_at = state, at
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
        if self._state is not None:
            self.since = self._state.revision
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
