"""Fan-out of updates: snapshots are conflated to the newest, events never, and everything is bounded."""

import asyncio
from collections.abc import AsyncIterator

from app.link.messages import Update
from app.tracker.snapshot import Event, SiteSnapshot

MOST_EVENTS_WAITING = 10_000


class _Reader:
    """What one subscriber has not yet taken."""

    def __init__(self) -> None:
        self.snapshot: SiteSnapshot | None = None
        self.events: list[Event] = []
        self.ended = False
        self.ready = asyncio.Event()

    def put(self, snapshot: SiteSnapshot, events: tuple[Event, ...]) -> None:
        self.snapshot = snapshot
        self.events.extend(events)
        if len(self.events) > MOST_EVENTS_WAITING:
            self.ended = True
        self.ready.set()

    def take(self) -> Update | None:
        self.ready.clear()
        if self.snapshot is None:
            return None
        update = Update(self.snapshot, tuple(self.events))
        self.snapshot = None
        self.events.clear()
        return update


class Outlet:
    """Gives every subscriber each event once and the newest snapshot; one that falls far behind is ended."""

    def __init__(self) -> None:
        self._readers: set[_Reader] = set()
        self._latest: SiteSnapshot | None = None

    def __len__(self) -> int:
        return len(self._readers)

    @property
    def waiting(self) -> int:
        """Return how many events the slowest subscriber has not yet taken."""
        return max((len(reader.events) for reader in self._readers), default=0)

    @property
    def latest(self) -> SiteSnapshot | None:
        """Return the newest snapshot that was published, None before the first and after `end`."""
        return self._latest

    def publish(self, snapshot: SiteSnapshot, events: tuple[Event, ...] = ()) -> None:
        """Hand a snapshot and the events since the last one to every subscriber."""
        self._latest = snapshot
        for reader in self._readers:
            reader.put(snapshot, events)

    def end(self) -> None:
        """End every subscription; who comes later waits for the next snapshot."""
        self._latest = None
        for reader in self._readers:
            reader.ended = True
            reader.ready.set()

    async def subscribe(self) -> AsyncIterator[Update]:
        """Yield the newest snapshot at once, then updates until the outlet ends."""
        reader = _Reader()
        if self._latest is not None:
            reader.put(self._latest, ())
        self._readers.add(reader)
        try:
            while not reader.ended:
                await reader.ready.wait()
                update = reader.take()
                if update is not None and not reader.ended:
                    yield update
        finally:
            self._readers.discard(reader)
