"""The site's book of alarms: fed twice a second and at every event, stored behind the loop, told to all."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from typing import assert_never

from app.alarms import book as pages
from app.alarms.alarm import Alarm
from app.alarms.book import Book, Change, Happened
from app.alarms.conditions import Condition, conditions, in_maintenance
from app.alarms.view import view
from app.link.alarm_orders import AcknowledgeAlarm, AlarmOrder, ShelveAlarm, UnshelveAlarm
from app.site.health import HealthWatch
from app.site.model import SiteModel
from app.store.store import KeptAlarm
from app.tracker.snapshot import Event, EventKind, SiteSnapshot

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
    """Keeps the book of one site. `troubles` are conditions that other parts of the machine tell, by name."""

    model: SiteModel
    health: HealthWatch
    book: Book
    troubles: dict[str, Condition]
    _began_at: datetime
    _looked_at: datetime | None = None

    @classmethod
    def open(
        cls, model: SiteModel, standing: Sequence[Alarm], disk_free: Callable[[], int | None]
    ) -> "AlarmDesk":
        """Return the desk with what stood when the last life of the machine ended."""
        return cls(model, HealthWatch(disk_free), pages.restored(standing), {}, model.clock.now())

    def trouble(self, name: str, condition: Condition | None) -> None:
        """Note a condition of another part of the machine, or with None that it is over."""
        if condition is None:
            self.troubles.pop(name, None)
        else:
            self.troubles[name] = condition

    def look(self, site: SiteSnapshot, *, at_once: bool) -> tuple[Event, ...]:
        """Look at the site if it is time, or at once, and return what became of alarms."""
        now = self.model.clock.now()
        if not at_once and self._looked_at is not None and now - self._looked_at < LOOK_EVERY:
            return ()
        self._looked_at = now
        health = self.health.look(
            now,
            lambda: {name: loop.counter.metrics() for name, loop in self.model.loops.items()},
            store_behind=self.model.ledger.behind,
            troubles=tuple(self.troubles.values()),
        )
        after, changes = pages.step(
            self.book,
            conditions(site, health, self.book.present),
            site.at,
            now,
            maintenance=in_maintenance(site),
            settled=now - self._began_at >= SETTLED_AFTER,
        )
        return self._turn(after, changes, site.at)

    def carry_out(self, command: AlarmOrder, actor: str) -> tuple[Event, ...]:
        """Carry out one order; raise `UnknownAlarm`, or `ValueError` with a sentence."""
        at, now = self.model.now(), self.model.clock.now()
        match command:
            case AcknowledgeAlarm():
                turned = pages.acknowledge(self.book, command.alarm_id, actor, at)
            case ShelveAlarm():
                duration = timedelta(minutes=command.minutes)
                turned = pages.shelve(self.book, command.alarm_id, actor, command.reason, duration, now)
            case UnshelveAlarm():
                turned = pages.unshelve(self.book, command.alarm_id, actor)
            case _:
                assert_never(command)
        return self._turn(*turned, at)

    def shown(self, site: SiteSnapshot) -> SiteSnapshot:
        """Return the snapshot with the alarms that stand."""
        alarms, counts = view(self.book, site.at, self.model.clock.now())
        return replace(site, alarms=alarms, alarm_counts=counts)

    def standing(self) -> tuple[KeptAlarm, ...]:
        """Return the alarms that stand, to be stored anew."""
        return tuple(KeptAlarm(one, None) for one in self.book.alarms.values() if one.stands)

    def _turn(self, after: Book, changes: Sequence[Change], at: datetime) -> tuple[Event, ...]:
        """Take the next book, have it stored and return the events."""
        kept = tuple(KeptAlarm(*one) for one in pages.to_keep(self.book, after, at))
        events = tuple(_event(change, at) for change in changes)
        self.book = after
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
    text = f"{entry.title} at {alarm.where} (priority {entry.priority}) {_became(change)}"
    return Event(at, KINDS[change.what], alarm.tracker_id, text, change.by or "machine", data)


def _became(change: Change) -> str:
    alarm = change.alarm
    match change.what:
        case Happened.RAISED:
            return f"was raised: {alarm.message}"
        case Happened.RETURNED:
            return "has returned to normal."
        case Happened.ACKNOWLEDGED:
            return "was acknowledged."
        case Happened.SHELVED:
            return f"was shelved: {'' if alarm.shelf is None else alarm.shelf.reason}"
        case Happened.UNSHELVED:
            return "was taken back from the shelf." if change.by else "is shelved no more: its time is over."
        case _:
            assert_never(change.what)
