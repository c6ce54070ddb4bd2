"""Tells everyone what is: of the trackers those that changed, ten times a second at most, or at once.

It costs what changed: a tracker is marked when it has ticked, and one publication takes all that are marked.
"""

import asyncio
import itertools
from collections.abc import Collection, Iterable
from dataclasses import replace
from datetime import datetime, timedelta
from typing import Any

from app.alarms.urgency import newest, site_messages, with_messages
from app.base.clock import set_or_at
from app.base.logs import get_logger
from app.link.messages import Order, StopAll
from app.link.outlet import Outlet
from app.site.loop.loop import TrackerLoop
from app.site.publishing.alarming import KINDS, AlarmDesk
from app.site.state.model import SiteModel
from app.sun.position import Algorithm
from app.tracker.state.snapshot import Event, EventKind, SiteSnapshot, Snapshot
from app.tracker.values.reason import Reason

EVERY = timedelta(milliseconds=100)
SLOWLY = timedelta(seconds=1)
WHILE_MOVING = timedelta(milliseconds=95)
AT_REST = timedelta(milliseconds=495)
UNHEARD = timedelta(milliseconds=1200)
MOST_AT_ONCE = 20
URGENT = {
    EventKind.STOPPED,
    EventKind.FAULT_RAISED,
    EventKind.NOT_STOWED,
    EventKind.DRIVE_LOST,
    EventKind.LIMIT_REACHED,
    EventKind.STOPPING_DISTANCE_EXCEEDED,
}
"""What is told at once: a stop, and what raises an alarm."""

log = get_logger()


class Publisher:
    """Tells what changed. `every` is the shortest time between two publications, `urgent_every` if urgent."""

    every: timedelta = EVERY
    urgent_every: timedelta = timedelta(0)

    def __init__(self, model: SiteModel, alarms: AlarmDesk, outlet: Outlet, boot_id: str) -> None:
        self._model = model
        self._alarms = alarms
        self._outlet = outlet
        self._boot_id = boot_id
        self._sequence = itertools.count(1)
        self._marked: dict[str, None] = {}
        self._events: list[Event] = []
        self._told: dict[str, datetime] = {}
        self._trackers: dict[str, Snapshot | None] = {}
        self._troubles: dict[str, Reason | None] = {}
        self._last: dict[str, Event | None] = {}
        self._watchers: dict[object, frozenset[str]] = {}
        self._watched: frozenset[str] = frozenset()
        self._arrivals = -1
        self._begun_at = self._published_at = model.clock.now()
        self.newest = self._site(model.now())
        self._wanted = asyncio.Event()
        self._urgent = asyncio.Event()

    def ticked(self, loop: TrackerLoop, events: tuple[Event, ...]) -> None:
        """Mark a tracker after its tick if something is new, or if it is time to tell it again."""
        tracker_id = loop.config.tracker_id
        told_at = self._told.get(tracker_id)
        after = WHILE_MOVING if loop.moving else AT_REST
        is_new = bool(events) or loop.trouble != self._troubles.get(tracker_id)
        self._troubles[tracker_id] = loop.trouble
        if is_new or told_at is None or self._model.clock.now() - told_at >= after:
            self.mark((tracker_id,), events)

    def mark(
        self, tracker_ids: Iterable[str], events: Iterable[Event] = (), *, at_once: bool = False
    ) -> None:
        """Have these trackers and events told soon; what is urgent, in the next turn of the event loop."""
        self._marked.update(dict.fromkeys(tracker_ids))
        for event in events:
            self._events.append(event)
            at_once = at_once or event.kind in URGENT
        self._wanted.set()
        if at_once:
            self._urgent.set()

    def slow(self, *, slow: bool) -> None:
        """Tell once a second, and what is urgent ten times, during an overload, or as usual."""
        self.every = SLOWLY if slow else EVERY
        self.urgent_every = EVERY if slow else timedelta(0)

    def watch(self, tracker_ids: frozenset[str], who: object) -> None:
        """Tell these trackers with what is allowed now, at once and as long as somebody watches them."""
        self._watchers[who] = tracker_ids
        if not tracker_ids:
            del self._watchers[who]
        before, self._watched = self._watched, frozenset().union(*self._watchers.values())
        self.mark(self._watched - before, at_once=True)

    def beat(self) -> None:
        """Twice a second: mark what has long not been told, a drive that holds up its tracker among it."""
        now = self._model.clock.now()
        for tracker_id, told_at in self._told.items():
            if now - told_at < UNHEARD:
                break
            self._marked[tracker_id] = None
        if self._marked or now - self._published_at >= AT_REST:
            self._wanted.set()

    async def run(self) -> None:
        """Tell what is marked, until cancelled."""
        while True:
            await self._wanted.wait()
            due = self._begun_at + self.every
            if due > self._model.clock.now() and not self._urgent.is_set():
                await set_or_at(self._urgent, self._model.clock, due)
            if self.urgent_every:
                await self._model.clock.sleep_until(self._begun_at + self.urgent_every)
            self._wanted.clear()
            self._urgent.clear()
            self._begun_at = self._model.clock.now()
            await self.tell(self._marked)
            await self._model.clock.sleep_until(self._model.clock.now())

    async def tell(self, tracker_ids: Iterable[str], events: Iterable[Event] = ()) -> None:
        """Tell these trackers and events now; of very many a handful at once, and then everything else."""
        waiting = tuple(tracker_ids)
        self.publish(waiting[:MOST_AT_ONCE], events)
        for first in range(MOST_AT_ONCE, len(waiting), MOST_AT_ONCE):
            await self._model.clock.sleep_until(self._model.clock.now())
            self.publish(waiting[first : first + MOST_AT_ONCE])

    def publish(self, tracker_ids: Iterable[str] = (), events: Iterable[Event] = ()) -> None:
        """Tell these trackers now, with every event that waits before these events."""
        arrived = self._arrived()
        at = self._model.now()
        happened = (*self._events, *events)
        self._events.clear()
        changed = tuple(self._snapshots(dict.fromkeys((*tracker_ids, *(arrived or ()))), at))
        self._published_at = self._model.clock.now()
        site = self._site(at)
        happened += self._alarms.judge(site, changed, at_once=bool(happened))
        self._remember(happened)
        changed = tuple(map(self.told, (*changed, *self._alarmed(happened, changed))))
        self._trackers |= {one.tracker_id: one for one in changed}
        alarms, counts = self._alarms.shown(at)
        trackers = tuple(filter(None, self._trackers.values()))
        site = replace(
            site,
            trackers=trackers,
            alarms=alarms,
            alarm_counts=counts,
            messages=site_messages(trackers, alarms),
        )
        self.newest = site
        self._outlet.publish(site, happened, changed, arrivals=arrived is not None)

    def _snapshots(self, tracker_ids: Iterable[str], at: datetime) -> Iterable[Snapshot]:
        now = self._model.clock.now()
        for tracker_id in tracker_ids:
            self._marked.pop(tracker_id, None)
            loop = self._model.loops.get(tracker_id)
            if loop is not None:
                self._told.pop(tracker_id, None)
                self._told[tracker_id] = now
                yield self._model.snapshot(loop, at, asked=tracker_id in self._watched)

    def _alarmed(self, events: Iterable[Event], told: Iterable[Snapshot]) -> Iterable[Snapshot]:
        """Yield the trackers that are not told now and whose alarms changed: their messages have, too."""
        known = {snapshot.tracker_id for snapshot in told}
        named = (event.tracker_id for event in events if event.kind in KINDS.values())
        for tracker_id in dict.fromkeys(named):
            snapshot = None if tracker_id in known else self._trackers.get(tracker_id or "")
            if snapshot is not None:
                yield snapshot

    def _remember(self, events: Iterable[Event]) -> None:
        """Note the last thing that happened to each tracker."""
        for event in events:
            if event.tracker_id is not None:
                self._last[event.tracker_id] = newest(self._last.get(event.tracker_id), event)

    def told(self, snapshot: Snapshot) -> Snapshot:
        """Return a tracker with its state in a word and with what to know about it."""
        place = snapshot.tracker_id
        alarms = {**self._alarms.of_all(), **self._alarms.of(place)}
        return with_messages(snapshot, alarms, self._last.get(place))

    def _arrived(self) -> tuple[str, ...] | None:
        """Follow the site's trackers, in their order, and return those that came; None: none came or went."""
        if self._arrivals == self._model.arrivals:
            return None
        self._arrivals = self._model.arrivals
        came = tuple(name for name in self._model.loops if name not in self._trackers)
        self._trackers = {name: self._trackers.get(name) for name in self._model.loops}
        for tracker_id in self._told.keys() - self._trackers.keys():
            del self._told[tracker_id]
        self._troubles = {name: one for name, one in self._troubles.items() if name in self._trackers}
        self._last = {name: one for name, one in self._last.items() if name in self._trackers}
        return came

    def _site(self, at: datetime) -> SiteSnapshot:
        """Return the site without its trackers and alarms."""
        model, state = self._model, self._model.state
        first = next(iter(model.loops.values()), None)
        algorithm = Algorithm.PSA if first is None else first.config.algorithm
        sun = model.sky.sun(state.location, algorithm, at)
        return SiteSnapshot(
            boot_id=self._boot_id,
            sequence=next(self._sequence),
            at=at,
            site_name=state.name,
            location=state.location,
            time_zone=state.time_zone,
            clock=model.timekeeper.state(),
            sun=sun,
            trackers=(),
            weather=model.weather.now(model.clock.now()),
            sun_behind_horizon=sun is not None
            and state.horizon.hides(sun.azimuth_deg, sun.apparent_elevation_deg),
        )


def concerned(order: Order, all_trackers: Collection[str]) -> tuple[str, ...]:
    """Return the trackers that an order is about."""
    command: Any = order.command
    if isinstance(command, StopAll):
        return tuple(all_trackers)
    if hasattr(command, "tracker_ids"):
        return tuple(command.tracker_ids)
    named = order.tracker_id or getattr(getattr(command, "config", command), "tracker_id", None)
    return () if named is None else (named,)
