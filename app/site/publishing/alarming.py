"""The site's books of alarms: fed with what is told of each tracker, stored behind the loop, told to all."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from typing import assert_never

from app.alarms import lifecycle as pages
from app.alarms.alarm import Alarm, place_in, place_of
from app.alarms.books import Books, Place
from app.alarms.conditions import Condition, SiteHealth, of_site, of_tracker
from app.alarms.lifecycle import Book, Change, Happened
from app.alarms.urgency import concerns_all
from app.alarms.view import Shown
from app.base.message import N_, Message, say
from app.link.alarm_orders import AcknowledgeAlarm, ShelveAlarm, UnshelveAlarm
from app.site.publishing.health import HealthWatch
from app.site.state.model import SiteModel
from app.store.store import KeptAlarm
from app.tracker.state.snapshot import Event, EventKind, SiteSnapshot, Snapshot
from app.tracker.values.actors import CONTROLLER

LOOK_EVERY = timedelta(milliseconds=450)
SETTLED_AFTER = timedelta(seconds=10)
KINDS = {
    Happened.RAISED: EventKind.ALARM_RAISED,
    Happened.RETURNED: EventKind.ALARM_RETURNED,
    Happened.ACKNOWLEDGED: EventKind.ALARM_ACKNOWLEDGED,
    Happened.SHELVED: EventKind.ALARM_SHELVED,
    Happened.UNSHELVED: EventKind.ALARM_UNSHELVED,
}


@dataclass(slots=True)
class AlarmDesk:
    """Keeps the books of one site. `troubles` are conditions that other parts of the machine tell, by name.

    A tracker is judged whenever it is told; what concerns the site itself, twice a second.
    """

    model: SiteModel
    health: HealthWatch
    books: Books
    troubles: dict[str, Condition]
    _began_at: datetime
    _looked_at: datetime | None = None
    _health: SiteHealth = field(default_factory=SiteHealth)

    @classmethod
    def open(
        cls, model: SiteModel, standing: Sequence[Alarm], disk_free: Callable[[], int | None]
    ) -> "AlarmDesk":
        """Return the desk with what stood when the last life of the machine ended."""
        now = model.clock.now()
        return cls(model, HealthWatch(disk_free), Books(standing, model.now(), now), {}, now)

    def trouble(self, name: str, condition: Condition | None) -> None:
        """Note a condition of another part of the machine, or with None that it is over."""
        if condition is None:
            self.troubles.pop(name, None)
        else:
            self.troubles[name] = condition

    def judge(self, site: SiteSnapshot, trackers: Iterable[Snapshot], *, at_once: bool) -> tuple[Event, ...]:
        """Judge these trackers, and the site if it is time or at once; return what became of alarms."""
        now = self.model.clock.now()
        happened: list[Event] = []
        for tracker in trackers:
            place = tracker.tracker_id
            present = of_tracker(tracker, self._health, self.books.of(place).present)
            happened.extend(self._look(place, present, site.at, in_maintenance=tracker.lock is not None))
        due = self._looked_at is None or now - self._looked_at >= LOOK_EVERY
        if due or at_once or self.books.flood_grew:
            happened.extend(self._judge_site(site, now))
        return tuple(happened)

    def _judge_site(self, site: SiteSnapshot, now: datetime) -> Iterator[Event]:
        """Judge what concerns no tracker that there is."""
        self._looked_at = now
        self._health = self.health.look(
            now,
            lambda: {name: loop.counter.metrics() for name, loop in self.model.loops.items()},
            store_behind=self.model.ledger.behind,
            troubles=tuple(self.troubles.values()),
        )
        for place in self.books.places:
            if place is not None and place not in self.model.loops:
                yield from self._look(place, (), site.at)
        yield from self._look(None, of_site(site, self._health, self.books.of(None).present), site.at)

    def _look(
        self, place: Place, present: tuple[Condition, ...], at: datetime, *, in_maintenance: bool = False
    ) -> tuple[Event, ...]:
        now = self.model.clock.now()
        settled = now - self._began_at >= SETTLED_AFTER
        turned = self.books.look(place, present, at, now, in_maintenance=in_maintenance, settled=settled)
        return self._turn(place, *turned, at)

    async def acknowledge(self, model: SiteModel, command: AcknowledgeAlarm, actor: str) -> tuple[Event, ...]:
        """Note that somebody has seen an alarm, or raise `UnknownAlarm`."""
        place, book, at = self._opened(command.alarm_id)
        return self._turn(place, *pages.acknowledge(book, command.alarm_id, actor, at), at)

    async def shelve(self, model: SiteModel, command: ShelveAlarm, actor: str) -> tuple[Event, ...]:
        """Put an alarm aside, or raise `UnknownAlarm`, or `ValueError` with a sentence."""
        place, book, at = self._opened(command.alarm_id)
        duration, now = timedelta(minutes=command.minutes), model.clock.now()
        turned = pages.shelve(book, command.alarm_id, actor, command.reason, duration, now)
        return self._turn(place, *turned, at)

    async def unshelve(self, model: SiteModel, command: UnshelveAlarm, actor: str) -> tuple[Event, ...]:
        """Take an alarm back from the shelf, or raise `UnknownAlarm`."""
        place, book, at = self._opened(command.alarm_id)
        return self._turn(place, *pages.unshelve(book, command.alarm_id, actor), at)

    def _opened(self, alarm_id: str) -> tuple[Place, Book, datetime]:
        place = place_in(alarm_id)
        return place, self.books.of(place), self.model.now()

    def of(self, tracker_id: str) -> Mapping[str, Alarm]:
        """Return the alarms of a tracker by `alarm_id`."""
        return self.books.of(tracker_id).alarms

    def of_all(self) -> Mapping[str, Alarm]:
        """Return the alarms of the site that concern each tracker, by `alarm_id`."""
        return {name: one for name, one in self.books.of(None).alarms.items() if concerns_all(one)}

    def shown(self, at: datetime) -> Shown:
        """Return the most urgent alarms and how many stand; the same object as before if none changed."""
        return self.books.shown(at, self.model.clock.now())

    def standing(self) -> tuple[KeptAlarm, ...]:
        """Return the alarms that stand, to be stored anew."""
        return tuple(KeptAlarm(one, None) for one in self.books.alarms if one.stands)

    def _turn(self, place: Place, after: Book, changes: Sequence[Change], at: datetime) -> tuple[Event, ...]:
        """Take the next book of a place, have it stored and return the events."""
        before = self.books.of(place)
        if after is before:
            return ()
        kept = tuple(KeptAlarm(*one) for one in pages.to_keep(before, after, at))
        events = tuple(_event(change, at) for change in changes)
        self.books.put(place, after, at, self.model.clock.now())
        if kept or events:
            self.model.ledger.post_alarms(kept, events)
        return events


def _event(change: Change, at: datetime) -> Event:
    alarm, entry = change.alarm, change.alarm.entry
    data = {
        "alarm_id": alarm.alarm_id,
        "code": alarm.code,
        "priority": entry.priority,
        "title": entry.title,
        "where": alarm.where,
        "says": alarm.message,
        "do": entry.do,
        "since": (alarm.raised_at or at).isoformat(),
        "state": alarm.state.value,
    }
    text = say(
        "{title} at {where} (priority {priority}) {change}",
        title=entry.title,
        where=place_of(alarm),
        priority=entry.priority,
        change=_became(change),
    )
    return Event(at, KINDS[change.what], alarm.tracker_id, text, change.by or CONTROLLER, data)


def _became(change: Change) -> Message:
    alarm = change.alarm
    match change.what:
        case Happened.RAISED:
            return say("was raised: {message}", message=alarm.message)
        case Happened.RETURNED:
            return N_("has returned to normal.")
        case Happened.ACKNOWLEDGED:
            return N_("was acknowledged.")
        case Happened.SHELVED:
            return say("was shelved: {value}", value="" if alarm.shelf is None else alarm.shelf.reason)
        case Happened.UNSHELVED:
            return (
                N_("was unshelved.")
                if change.by
                else N_("is no longer shelved: the shelving time has expired.")
            )
        case _:
            assert_never(change.what)
