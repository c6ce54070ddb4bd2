"""From one machine to many readers: what changed is rendered once a language and handed out in batches."""

import asyncio
from collections import deque
from collections.abc import Coroutine, Iterator
from datetime import timedelta
from itertools import islice
from typing import Any
from uuid import uuid4

import orjson

from app.base.clock import Clock, set_or_at
from app.base.lasting import begun
from app.base.logs import get_logger
from app.link.messages import Machine, Update
from app.tracker.state.snapshot import Event
from app.web.languages.catalogue import catalogue_of
from app.web.languages.live_texts import in_language
from app.web.live.hold_to_run import Dead
from app.web.live.states import States
from app.web.live.viewers import Message, Viewer, Wanted

log = get_logger()

SOONEST = timedelta(milliseconds=100)
LATEST = timedelta(milliseconds=500)
RENEW = timedelta(milliseconds=450)
"""After this long a page is told its tracker again though nothing changed: it sees that the link is up."""
RECONNECT = timedelta(milliseconds=50)
FAREWELL = timedelta(seconds=1)
BATCH = 10
MOST_VIEWERS = 1000
EVENTS_KEPT = 2000


class TooManyViewers(Exception):
    """The panel has as many readers as it serves."""


class Hub:
    """Reads the machine's updates once and gives every viewer the newest state and every event."""

    def __init__(self, machine: Machine, clock: Clock, *, patience: timedelta = timedelta(seconds=5)) -> None:
        self.patience = patience
        self.dead = Dead()
        self.closing = asyncio.Event()
        self._machine = machine
        self._clock = clock
        self._run = uuid4().hex[:8]
        self._number = 0
        self._events: deque[tuple[int, Event]] = deque(maxlen=EVENTS_KEPT)
        self._states = States(clock)
        self._watched: frozenset[str] = frozenset()
        self._changed = asyncio.Event()
        self._viewers: set[Viewer] = set()
        self._tasks: set[asyncio.Task[Any]] = set()

    def __len__(self) -> int:
        return len(self._viewers)

    @property
    def mark(self) -> str:
        """Return the present place in the stream of events."""
        return f"{self._run}-{self._number}"

    def spawn(self, work: Coroutine[Any, Any, object]) -> None:
        """Do something beside everything else; it is finished even if who asked for it has gone."""
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    def join(self, wanted: Wanted) -> Viewer:
        """Return a new viewer, which is shown the present state at once."""
        if len(self._viewers) >= MOST_VIEWERS:
            raise TooManyViewers
        viewer = Viewer(wanted)
        viewer.show(self._states.message(wanted, None, self.mark), self._clock.now())
        self._viewers.add(viewer)
        self._watch()
        return viewer

    def leave(self, viewer: Viewer) -> None:
        """Forget a viewer."""
        self._viewers.discard(viewer)
        self._watch()

    def _watch(self) -> None:
        """Have the machine work out what may be asked of the trackers that somebody looks at."""
        looked_at = {viewer.wanted.tracker_id for viewer in self._viewers}
        watched = frozenset(one for one in looked_at if one is not None)
        if watched != self._watched:
            self._watched = watched
            self.spawn(self._machine.watch(watched))

    def missed(self, mark: str, wanted: Wanted) -> list[Message] | None:
        """Return the wanted events since a place in the stream, None where that is not known any more."""
        run, _, number = mark.rpartition("-")
        oldest = self._events[0][0] if self._events else self._number + 1
        if run != self._run or not number.isdigit() or not oldest - 1 <= int(number) <= self._number:
            return None
        return [
            self._message(place, event, wanted.language)
            for place, event in self._events
            if place > int(number) and wanted.includes(event.kind, event.tracker_id)
        ]

    async def run(self) -> None:
        """Follow the machine until cancelled; then let what was asked for last be finished."""
        following = begun("hub_follows", self._follow, self._clock)
        pacing = begun("hub_paces", self._pace, self._clock)
        try:
            await asyncio.gather(following, pacing)
        finally:
            following.cancel()
            pacing.cancel()
            if self._tasks:
                await asyncio.wait(self._tasks, timeout=FAREWELL.total_seconds())

    async def _follow(self) -> None:
        while True:
            try:
                async for update in self._machine.updates():
                    self._hear(update)
            finally:
                self._states.lose()
            await self._hand_out()
            await self._clock.sleep_until(self._clock.now() + RECONNECT)

    def _hear(self, update: Update) -> None:
        self._states.take(update)
        self._changed.set()
        for event in update.events:
            self._number += 1
            self._events.append((self._number, event))
            messages: dict[str, Message] = {}
            for viewer in self._viewers:
                if viewer.wanted.includes(event.kind, event.tracker_id):
                    language = viewer.wanted.language
                    if language not in messages:
                        messages[language] = self._message(self._number, event, language)
                    viewer.tell(messages[language])

    async def _pace(self) -> None:
        """Hand out what changed; with very many viewers less often, so that half of the time is others'."""
        while True:
            await set_or_at(self._changed, self._clock, self._clock.now() + LATEST)
            self._changed.clear()
            begun = self._clock.now()
            await self._hand_out()
            ended = self._clock.now()
            await self._clock.sleep_until(ended + max(SOONEST, ended - begun))

    async def _hand_out(self) -> None:
        for batch in _batches(tuple(self._viewers)):
            now = self._clock.now()
            for viewer in batch:
                rests_since = viewer.shown_at or now
                if self._states.is_news(viewer.wanted, viewer.since) or now - rests_since >= RENEW:
                    viewer.show(self._states.message(viewer.wanted, viewer.since, self.mark), now)
            await self._clock.sleep_until(now)

    def _message(self, number: int, event: Event, language: str) -> Message:
        text = in_language(catalogue_of(language), {"type": "event", **_fields(event)})
        return Message("event", text, f"{self._run}-{number}")


def _fields(event: Event) -> dict[str, Any]:
    fields: dict[str, Any] = orjson.loads(orjson.dumps(event))
    return fields


def _batches(viewers: tuple[Viewer, ...]) -> Iterator[tuple[Viewer, ...]]:
    rest = iter(viewers)
    while batch := tuple(islice(rest, BATCH)):
        yield batch
