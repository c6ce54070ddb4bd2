"""The book of alarms: one step takes what is present now and returns the next book and what changed.

Time comes in twice: `at` is the site's clock, for what people read; `now` the steady clock, for delays.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from datetime import datetime, timedelta
from enum import StrEnum

from app.alarms.alarm import Alarm, Shelf
from app.alarms.catalogue import FLOOD
from app.alarms.conditions import SITE, Condition
from app.base.message import N_, NOTHING, say
from app.base.names import clean
from app.tracker.values.alarm_words import AlarmState

LONGEST_SHELF = timedelta(hours=24)
SHORTEST_SHELF = timedelta(minutes=1)
FLOOD_WINDOW = timedelta(minutes=10)
FLOOD_ABOVE = 10
FLOOD_OVER_BELOW = 5
ALWAYS_ANNOUNCED = 1


class UnknownAlarm(Exception):
    """No alarm of this name stands."""


class Happened(StrEnum):
    """What can become of an alarm."""

    RAISED = "raised"
    RETURNED = "returned"
    ACKNOWLEDGED = "acknowledged"
    SHELVED = "shelved"
    UNSHELVED = "unshelved"


@dataclass(frozen=True, slots=True)
class Change:
    """What became of one alarm, and by whom (empty: by itself)."""

    what: Happened
    alarm: Alarm
    by: str = ""


@dataclass(frozen=True, slots=True)
class Book:
    """All alarms by name, when the last ones were raised (steady clock), and whether that is a flood."""

    alarms: dict[str, Alarm] = field(default_factory=dict)
    raised: tuple[datetime, ...] = ()
    flood: bool = False

    @property
    def present(self) -> frozenset[str]:
        """Return the names of the alarms whose condition was present."""
        return frozenset(name for name, alarm in self.alarms.items() if alarm.active or alarm.seen_since)


def restored(alarms: Iterable[Alarm]) -> Book:
    """Return the book with which a life of the machine begins: what stood when the last one ended."""
    return Book({one.alarm_id: replace(one, seen_since=None, gone_since=None) for one in alarms})


def step(
    book: Book,
    present: Iterable[Condition],
    at: datetime,
    now: datetime,
    *,
    maintenance: frozenset[str] = frozenset(),
    settled: bool = True,
    raised_elsewhere: Iterable[datetime] = (),
) -> tuple[Book, tuple[Change, ...]]:
    """Return the book after one look, and what changed.

    `maintenance` are trackers whose alarms are out of service, priority 1 aside. As long as the machine has
    not `settled` after its start nothing returns: a condition not seen yet may still be there.
    `raised_elsewhere` is when other books raised alarms since the last look: a flood counts them, too.
    """
    seen = {one.alarm_id: one for one in present}
    if book.flood:
        seen[FLOOD] = _flood_condition(book)
    alarms = {name: book.alarms.get(name) or _fresh(seen[name]) for name in [*book.alarms, *seen]}
    alarms = {name: _advance(alarm, seen.get(name), at, now, settled) for name, alarm in alarms.items()}
    alarms, ended = _end_shelves(alarms, now)
    alarms = _silence(alarms, maintenance)
    alarms, told = _announce(alarms, at)
    returned = [
        Change(Happened.RETURNED, alarm)
        for name, alarm in alarms.items()
        if name in book.alarms and book.alarms[name].active and not alarm.active and alarm.told
    ]
    fresh = sum(1 for one in told if one.alarm.code != FLOOD)
    raised = (*(one for one in book.raised if now - one < FLOOD_WINDOW), *raised_elsewhere, *[now] * fresh)
    flood = len(raised) > (FLOOD_OVER_BELOW - 1 if book.flood else FLOOD_ABOVE)
    kept = {name: alarm for name, alarm in alarms.items() if alarm.stands or alarm.active or alarm.seen_since}
    return Book(kept, raised, flood), (*ended, *told, *returned)


def acknowledge(book: Book, name: str, by: str, at: datetime) -> tuple[Book, tuple[Change, ...]]:
    """Acknowledge an alarm; one that is acknowledged already stays so. Raises `UnknownAlarm`."""
    alarm = _standing(book, name)
    if alarm.state not in (AlarmState.UNACKNOWLEDGED, AlarmState.RETURNED):
        return book, ()
    seen = replace(alarm, acknowledged_at=at, acknowledged_by=by)
    return _with(book, seen), (Change(Happened.ACKNOWLEDGED, seen, by),)


def shelve(
    book: Book, name: str, by: str, reason: str, duration: timedelta, now: datetime
) -> tuple[Book, tuple[Change, ...]]:
    """Put an alarm aside for a while.

    Raises `UnknownAlarm`; `ValueError` for priority 1, without a reason, for other than 1 minute to 24 h.
    """
    alarm = _standing(book, name)
    if alarm.entry.priority == ALWAYS_ANNOUNCED:
        raise ValueError(N_("An alarm of priority 1 cannot be shelved. Acknowledge it and remove its cause."))
    reason = clean(reason)
    if not reason:
        raise ValueError(N_("Enter the reason for shelving the alarm."))
    if not SHORTEST_SHELF <= duration <= LONGEST_SHELF:
        raise ValueError(N_("An alarm can be shelved for 1 minute to 24 hours."))
    shelved = replace(alarm, shelf=Shelf(now + duration, by, reason), told=False)
    return _with(book, shelved), (Change(Happened.SHELVED, shelved, by),)


def unshelve(book: Book, name: str, by: str) -> tuple[Book, tuple[Change, ...]]:
    """Take an alarm back from the shelf; if it is still active the next step announces it anew."""
    alarm = _standing(book, name)
    if alarm.shelf is None:
        return book, ()
    back = replace(alarm, shelf=None)
    return _with(book, back), (Change(Happened.UNSHELVED, back, by),)


def to_keep(before: Book, after: Book, at: datetime) -> tuple[tuple[Alarm, datetime | None], ...]:
    """Return the alarms that differ in what outlives a restart, each with when it ended (None: it stands)."""
    changed = [
        (alarm, None)
        for name, alarm in after.alarms.items()
        if alarm.stands and _lasting(alarm) != _lasting(before.alarms.get(name))
    ]
    ended = [
        (replace(alarm, active=False, shelf=None, returned_at=alarm.returned_at or at), at)
        for name, alarm in before.alarms.items()
        if alarm.stands and not (name in after.alarms and after.alarms[name].stands)
    ]
    return (*changed, *ended)


def _lasting(alarm: Alarm | None) -> Alarm | None:
    if alarm is None:
        return None
    return replace(alarm, message=NOTHING, hint=NOTHING, where="", seen_since=None, gone_since=None)


def _standing(book: Book, name: str) -> Alarm:
    alarm = book.alarms.get(name)
    if alarm is None or not alarm.stands:
        raise UnknownAlarm(
            say(
                "There is no alarm {name} now; it may have returned to normal. See the alarm history.",
                name=name,
            )
        )
    return alarm


def _with(book: Book, alarm: Alarm) -> Book:
    return replace(book, alarms={**book.alarms, alarm.alarm_id: alarm})


def _fresh(condition: Condition) -> Alarm:
    return Alarm(condition.code, condition.tracker_id, condition.where, condition.message, condition.hint)


def _flood_condition(book: Book) -> Condition:
    text = say("{raised} alarms were raised within 10 minutes.", raised=len(book.raised))
    return Condition(FLOOD, None, SITE, text)


def _advance(alarm: Alarm, condition: Condition | None, at: datetime, now: datetime, settled: bool) -> Alarm:
    """Return an alarm after its condition was looked at: active once the delay is over, and back likewise."""
    if condition is None:
        gone_since = alarm.gone_since or now
        alarm = replace(alarm, seen_since=None, gone_since=gone_since)
        over = settled and now - gone_since >= alarm.entry.off_delay
        return replace(alarm, active=False, returned_at=at) if alarm.active and over else alarm
    alarm = replace(
        alarm,
        where=condition.where,
        message=condition.message,
        hint=condition.hint,
        seen_since=alarm.seen_since or now,
        gone_since=None,
    )
    if alarm.active or now - (alarm.seen_since or now) < alarm.entry.on_delay:
        return alarm
    waits = alarm.state is AlarmState.RETURNED
    return replace(
        alarm,
        active=True,
        told=False,
        raised_at=alarm.raised_at if waits else at,
        returned_at=None,
        acknowledged_at=None,
        acknowledged_by="",
        occurrences=alarm.occurrences + 1 if waits else 1,
    )


def _end_shelves(alarms: dict[str, Alarm], now: datetime) -> tuple[dict[str, Alarm], list[Change]]:
    """Return the alarms without the shelves whose time is over.

    So is that of a shelf which would last for more than 24 h: it is of a life whose clock was ahead.
    """
    ended = [
        replace(alarm, shelf=None)
        for alarm in alarms.values()
        if alarm.shelf is not None and not timedelta() < alarm.shelf.until - now <= LONGEST_SHELF
    ]
    back = {alarm.alarm_id: alarm for alarm in ended}
    return alarms | back, [Change(Happened.UNSHELVED, alarm) for alarm in ended]


def _silence(alarms: dict[str, Alarm], maintenance: frozenset[str]) -> dict[str, Alarm]:
    """Return the alarms with what keeps each from being announced; priority 1 is always announced."""
    there = {(alarm.code, alarm.tracker_id) for alarm in alarms.values() if alarm.active or alarm.seen_since}
    return {name: _silenced(alarm, there, maintenance) for name, alarm in alarms.items()}


def _silenced(alarm: Alarm, there: set[tuple[str, str | None]], maintenance: frozenset[str]) -> Alarm:
    entry = alarm.entry
    causes = [code for code in entry.suppressed_by if (code, alarm.tracker_id) in there]
    loud = entry.priority == ALWAYS_ANNOUNCED
    silent = replace(
        alarm,
        suppressed_by="" if loud or not causes else causes[0],
        in_maintenance=not loud and alarm.tracker_id in maintenance,
    )
    return replace(silent, told=False) if silent.silent and silent.active else silent


def _announce(alarms: dict[str, Alarm], at: datetime) -> tuple[dict[str, Alarm], list[Change]]:
    """Return the alarms with those announced that are active, not silent and not announced yet."""
    due = [alarm for alarm in alarms.values() if alarm.active and not alarm.told and not alarm.silent]
    changes = []
    for alarm in sorted(due, key=lambda one: one.entry.priority):
        told = replace(
            alarm,
            told=True,
            first_out=_is_first(alarms, alarm),
            raised_at=alarm.raised_at or at,
            acknowledged_at=None,
            acknowledged_by="",
        )
        alarms = alarms | {told.alarm_id: told}
        changes.append(Change(Happened.RAISED, told))
    return alarms, changes


def _is_first(alarms: dict[str, Alarm], alarm: Alarm) -> bool:
    """Return whether no alarm of its place that may be its cause has been announced and is still active."""
    return not any(
        other.tracker_id == alarm.tracker_id and other.entry.group in alarm.entry.kin
        for other in alarms.values()
        if other.active and other.told and other.alarm_id != alarm.alarm_id
    )
