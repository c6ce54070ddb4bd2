"""From the book to what the snapshot tells: the most urgent first, bounded, with counts of all."""

from bisect import bisect_left, insort
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from typing import cast

from app.alarms.alarm import Alarm, place_of
from app.alarms.catalogue import Group
from app.base.message import N_
from app.tracker.values.alarm_words import MOST_SHOWN, PRIORITIES, AlarmCounts, AlarmNow, AlarmState

COLLAPSED_FROM = 3
EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
MAINTENANCE = N_("inhibited for maintenance")
SILENCED = (AlarmState.SUPPRESSED, AlarmState.OUT_OF_SERVICE)
ASIDE = (AlarmState.SHELVED, *SILENCED)
Four = tuple[int, int, int, int]
Followed = set[tuple[Group, str | None]]
Urgency = tuple[bool, bool, bool, bool, int, float, str]
Ranked = tuple[Urgency, AlarmNow]
Counted = tuple[str, int]
Shown = tuple[tuple[AlarmNow, ...], AlarmCounts]


class Ranking:
    """The alarms that stand in the order of their urgency; a place that changes is put in anew."""

    def __init__(self) -> None:
        self._ranked: list[Ranked] = []
        self._places: dict[str | None, tuple[Ranked, ...]] = {}
        self._counts: Counter[Counted] = Counter()

    def renew(
        self, place: str | None, alarms: Iterable[Alarm], at: datetime, now: datetime, *, flood: bool
    ) -> None:
        """Take the alarms of one tracker, or of the site (None), in the place of those it had."""
        for ranked in self._places.pop(place, ()):
            del self._ranked[bisect_left(self._ranked, ranked[:1])]
            self._counts.subtract(_counted(ranked[1]))
        fresh = tuple((_urgency(one), one) for one in _standing(tuple(alarms), at, now, flood=flood))
        for ranked in fresh:
            insort(self._ranked, ranked)
            self._counts.update(_counted(ranked[1]))
        if fresh:
            self._places[place] = fresh

    def shown(self, *, flood: bool) -> Shown:
        """Return the alarms that stand, at most 50, and how many there are."""
        counts = AlarmCounts(
            standing=self._by_priority("standing"),
            calling=self._by_priority("calling"),
            shelved=self._counts["shelved", 0],
            silenced=self._counts["silenced", 0],
            more=max(0, len(self._ranked) - MOST_SHOWN),
            flood=flood,
        )
        return tuple(alarm for _, alarm in self._ranked[:MOST_SHOWN]), counts

    def _by_priority(self, what: str) -> Four:
        return cast(Four, tuple(self._counts[what, priority] for priority in PRIORITIES))


def _standing(alarms: tuple[Alarm, ...], at: datetime, now: datetime, *, flood: bool) -> Iterator[AlarmNow]:
    followed = _followed(alarms)
    for alarm in alarms:
        if alarm.stands:
            yield _leading(_now(alarm, at, now, flood=flood), alarm, followed)


def counts_of(alarms: Iterable[AlarmNow], *, flood: bool) -> AlarmCounts:
    """Return how many of these alarms there are of every kind."""
    found = Counter(kind for one in alarms for kind in _counted(one))

    def four(what: str) -> Four:
        return cast(Four, tuple(found[what, priority] for priority in PRIORITIES))

    return AlarmCounts(
        four("standing"), four("calling"), found["shelved", 0], found["silenced", 0], flood=flood
    )


def _counted(alarm: AlarmNow) -> tuple[Counted, ...]:
    """Return the counters in which an alarm counts."""
    if alarm.state is AlarmState.SHELVED:
        return (("shelved", 0),)
    if alarm.state in SILENCED:
        return (("silenced", 0),)
    calling = (("calling", alarm.priority),) if alarm.calls else ()
    return (("standing", alarm.priority), *calling)


def told(alarm: Alarm, ended_at: datetime | None) -> AlarmNow:
    """Return an alarm of the history as people read it."""
    at = ended_at or alarm.raised_at or EPOCH
    return _now(alarm, at, at, flood=False)


def _now(alarm: Alarm, at: datetime, now: datetime, *, flood: bool) -> AlarmNow:
    entry, shelf = alarm.entry, alarm.shelf
    return AlarmNow(
        alarm_id=alarm.alarm_id,
        code=alarm.code,
        tracker_id=alarm.tracker_id,
        where=place_of(alarm),
        priority=entry.priority,
        title=entry.title,
        message=alarm.message,
        do=alarm.hint or entry.do,
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
        collapsed=flood and entry.priority >= COLLAPSED_FROM,
        occurrences=max(1, alarm.occurrences),
    )


def _followed(alarms: Iterable[Alarm]) -> Followed:
    """Return the groups and places where an alarm came after another one that may be its cause."""
    later = (one for one in alarms if one.active and one.told and not one.first_out)
    return {(group, one.tracker_id) for one in later for group in one.entry.kin}


def _leading(now: AlarmNow, alarm: Alarm, followed: Followed) -> AlarmNow:
    """Return an alarm marked as the first only where others followed: alone it is just an alarm."""
    return replace(now, first_out=now.first_out and (alarm.entry.group, alarm.tracker_id) in followed)


def _by_site(steady: datetime, at: datetime, now: datetime) -> datetime:
    """Return an instant of the steady clock by the site's clock, to the second."""
    return (at + (steady - now) + timedelta(seconds=0.5)).replace(microsecond=0)


def _silenced_by(alarm: Alarm) -> str:
    return MAINTENANCE if alarm.in_maintenance else alarm.suppressed_by


def _urgency(alarm: AlarmNow) -> Urgency:
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
