"""From the book to what the snapshot tells: the most urgent first, bounded, with counts of all."""

from collections import Counter
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from typing import cast

from app.alarms.alarm import Alarm
from app.alarms.book import Book
from app.alarms.catalogue import Group
from app.tracker.alarm_words import MOST_SHOWN, PRIORITIES, AlarmCounts, AlarmNow, AlarmState

COLLAPSED_FROM = 3
EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
MAINTENANCE = "locked for maintenance"
SILENCED = (AlarmState.SUPPRESSED, AlarmState.OUT_OF_SERVICE)
ASIDE = (AlarmState.SHELVED, *SILENCED)
Four = tuple[int, int, int, int]
Followed = set[tuple[Group, str | None]]


def view(book: Book, at: datetime, now: datetime) -> tuple[tuple[AlarmNow, ...], AlarmCounts]:
    """Return the alarms that stand, at most 50, and how many there are; `at` and `now` as in the book."""
    followed = _followed(book)
    alarms = sorted(
        (_leading(_now(one, book, at, now), one, followed) for one in book.alarms.values() if one.stands),
        key=_urgency,
    )
    listed = [one for one in alarms if one.state not in ASIDE]
    counts = AlarmCounts(
        standing=_by_priority(listed),
        calling=_by_priority([one for one in listed if one.calls]),
        shelved=sum(one.state is AlarmState.SHELVED for one in alarms),
        silenced=sum(one.state in SILENCED for one in alarms),
        more=max(0, len(alarms) - MOST_SHOWN),
        flood=book.flood,
    )
    return tuple(alarms[:MOST_SHOWN]), counts


def told(alarm: Alarm, ended_at: datetime | None) -> AlarmNow:
    """Return an alarm of the history as people read it."""
    at = ended_at or alarm.raised_at or EPOCH
    return _now(alarm, Book(), at, at)


def _now(alarm: Alarm, book: Book, at: datetime, now: datetime) -> AlarmNow:
    entry, shelf = alarm.entry, alarm.shelf
    return AlarmNow(
        alarm_id=alarm.alarm_id,
        code=alarm.code,
        tracker_id=alarm.tracker_id,
        where=alarm.where,
        priority=entry.priority,
        title=entry.title,
        message=alarm.message,
        do=entry.do,
        state=alarm.state,
        since=alarm.raised_at or at,
        returned_at=alarm.returned_at,
        acknowledged_at=alarm.acknowledged_at,
        acknowledged_by=alarm.acknowledged_by,
        shelved_until=None if shelf is None else _by_site(shelf.until, at, now),
        shelved_by="" if shelf is None else shelf.by,
        shelved_for="" if shelf is None else shelf.reason,
        silenced_by=_silenced_by(alarm),
        first_out=alarm.first_out,
        collapsed=book.flood and entry.priority >= COLLAPSED_FROM,
        occurrences=max(1, alarm.occurrences),
    )


def _followed(book: Book) -> Followed:
    """Return the groups and places where an alarm came after another one that may be its cause."""
    later = (one for one in book.alarms.values() if one.active and one.told and not one.first_out)
    return {(group, one.tracker_id) for one in later for group in one.entry.kin}


def _leading(now: AlarmNow, alarm: Alarm, followed: Followed) -> AlarmNow:
    """Return an alarm marked as the first only where others followed: alone it is just an alarm."""
    return replace(now, first_out=now.first_out and (alarm.entry.group, alarm.tracker_id) in followed)


def _by_site(steady: datetime, at: datetime, now: datetime) -> datetime:
    """Return an instant of the steady clock by the site's clock, to the second."""
    return (at + (steady - now) + timedelta(seconds=0.5)).replace(microsecond=0)


def _silenced_by(alarm: Alarm) -> str:
    return MAINTENANCE if alarm.in_maintenance else alarm.suppressed_by


def _urgency(alarm: AlarmNow) -> tuple[object, ...]:
    """Return what sorts alarms: priority 1, then what calls, by priority, the newest first; aside is last."""
    aside = alarm.state in ASIDE
    return (
        aside,
        alarm.priority > 1,
        alarm.collapsed,
        not alarm.calls,
        alarm.priority,
        -alarm.since.timestamp(),
        alarm.alarm_id,
    )


def _by_priority(alarms: list[AlarmNow]) -> Four:
    counted = Counter(one.priority for one in alarms)
    return cast(Four, tuple(counted[priority] for priority in PRIORITIES))
