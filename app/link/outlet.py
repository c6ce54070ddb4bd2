"""Fan-out of updates: of every tracker the newest snapshot, of events every one; everything is bounded."""

import asyncio
from collections.abc import AsyncIterator, Callable, Iterable
from contextlib import closing

from app.link.messages import Update
from app.tracker.state.snapshot import Event, SiteSnapshot, Snapshot

MOST_EVENTS_WAITING = 10_000
MOST_TRACKERS_AT_ONCE = 20


class Listener:
    """What one subscriber has not yet taken: one update as it was told, or what gathered meanwhile."""

    def __init__(self, latest: SiteSnapshot | None, leave: Callable[["Listener"], None]) -> None:
        self.ended = False
        self._leave = leave
        self._latest = latest
        self._taken: int | None = None
        self._single: Update | None = None
        self._changed: dict[str, Snapshot] = {}
        self._events: list[Event] = []
        self._arrivals = False
        self._same_alarms = True
        self._gathers = False
        self._ready = asyncio.Event()
        self.again()

    @property
    def waiting(self) -> int:
        """Return how many events are not yet taken."""
        return len(self._events) if self._single is None else len(self._single.events)

    def again(self) -> None:
        """Have everything told anew, as to a new subscriber; events that wait are told with it."""
        if self._latest is None:
            return
        self._spread()
        self._taken, self._arrivals, self._same_alarms, self._gathers = None, True, False, True
        self._changed = {one.tracker_id: one for one in self._latest.trackers}
        self._ready.set()

    def put(self, update: Update) -> None:
        """Let this be taken next; what was not taken before is gathered with it."""
        self._latest = update.snapshot
        if self._gathers or self._single is not None or len(update.changed) > MOST_TRACKERS_AT_ONCE:
            self._spread()
            self._gather(update)
        else:
            self._single = update
        if self.waiting > MOST_EVENTS_WAITING:
            self.end()
        self._ready.set()

    def take(self) -> Update | None:
        """Return what waits, of very many trackers a handful; None if nothing waits."""
        if self._single is not None:
            update, self._single = self._single, None
        elif self._gathers and self._latest is not None:
            update = self._gathered(self._latest)
        else:
            return None
        self._taken = update.snapshot.sequence
        return update

    async def next(self) -> Update | None:
        """Wait for an update and return it, None when there will be no more."""
        while not self.ended:
            update = self.take()
            if update is not None:
                return update
            self._ready.clear()
            await self._ready.wait()
        return None

    def end(self) -> None:
        """Let nothing be taken any more."""
        self.ended = True
        self._ready.set()

    def close(self) -> None:
        """Leave the outlet."""
        self._leave(self)

    def _spread(self) -> None:
        """Take the one update that waits as the first of those that gather."""
        if self._single is not None:
            self._gather(self._single)
            self._single = None

    def _gather(self, update: Update) -> None:
        self._gathers = True
        for tracker in update.changed:
            self._changed[tracker.tracker_id] = tracker
        self._events.extend(update.events)
        self._same_alarms = self._same_alarms and update.same_alarms
        if update.arrivals:
            self._arrivals = True
            there = {one.tracker_id for one in update.snapshot.trackers}
            self._changed = {name: one for name, one in self._changed.items() if name in there}

    def _gathered(self, latest: SiteSnapshot) -> Update:
        ids = tuple(self._changed)[:MOST_TRACKERS_AT_ONCE]
        changed = tuple(self._changed.pop(tracker_id) for tracker_id in ids)
        events, self._events = tuple(self._events), []
        self._gathers = bool(self._changed)
        update = Update(
            latest,
            events,
            changed,
            after=self._taken,
            arrivals=self._arrivals,
            same_alarms=self._same_alarms,
            more=self._gathers,
        )
        self._arrivals, self._same_alarms = False, True
        return update


class Outlet:
    """Gives every subscriber each event once and the newest state; one that falls far behind is ended."""

    def __init__(self) -> None:
        self._readers: set[Listener] = set()
        self._latest: SiteSnapshot | None = None

    def __len__(self) -> int:
        return len(self._readers)

    @property
    def waiting(self) -> int:
        """Return how many events the slowest subscriber has not yet taken."""
        return max((reader.waiting for reader in self._readers), default=0)

    @property
    def latest(self) -> SiteSnapshot | None:
        """Return the newest snapshot that was published, None before the first and after `end`."""
        return self._latest

    def publish(
        self,
        snapshot: SiteSnapshot,
        events: Iterable[Event] = (),
        changed: tuple[Snapshot, ...] | None = None,
        *,
        arrivals: bool = False,
    ) -> None:
        """Hand a snapshot and the events since the last one to every subscriber.

        `changed` are its trackers that differ from the last snapshot's (None: whichever, all are told);
        `arrivals` says that trackers came or went.
        """
        before, self._latest = self._latest, snapshot
        if before is not None and before.boot_id != snapshot.boot_id:
            before = None
        update = Update(
            snapshot,
            tuple(events),
            snapshot.trackers if changed is None or before is None else changed,
            after=None if before is None else before.sequence,
            arrivals=arrivals or changed is None or before is None,
            same_alarms=before is not None
            and snapshot.alarms is before.alarms
            and snapshot.alarm_counts == before.alarm_counts,
        )
        for reader in self._readers:
            reader.put(update)

    def end(self) -> None:
        """End every subscription; who comes later waits for the next snapshot."""
        self._latest = None
        for reader in self._readers:
            reader.end()

    def listen(self) -> Listener:
        """Return a new subscriber, which is told everything first; whoever listens closes it."""
        reader = Listener(self._latest, self._readers.discard)
        self._readers.add(reader)
        return reader

    async def subscribe(self) -> AsyncIterator[Update]:
        """Yield everything there is at once, then updates until the outlet ends."""
        with closing(self.listen()) as reader:
            while (update := await reader.next()) is not None:
                yield update
