"""Alarms outlive a restart; the journal grows old in one way only, on both databases."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest

from app.alarms.alarm import Alarm
from app.store.store import AlarmFilter, JournalFilter, KeptAlarm, StoreFailed
from app.store.writer import DatabaseWriter
from app.tracker.state.snapshot import Event, EventKind
from tests.store.samples import execute

NOON = datetime(2027, 6, 21, 9, 0, tzinfo=UTC)
RAISED = Alarm(
    "drive_lost", "T1", "North field", "It does not answer.", active=True, told=True, raised_at=NOON
)


def events(count: int) -> list[Event]:
    return [
        Event(NOON + timedelta(days=day), EventKind.STOPPED, "T1", f"Day {day}.", "ayse")
        for day in range(count)
    ]


def note(entries: int) -> Event:
    return Event(NOON + timedelta(days=9), EventKind.JOURNAL_PRUNED, None, f"{entries} entries.")


def test_what_stands_comes_back_and_what_ended_is_history(writer: DatabaseWriter) -> None:
    writer.save_alarms([KeptAlarm(RAISED, None)])
    seen = replace(RAISED, acknowledged_at=NOON, acknowledged_by="ayse")
    other = replace(RAISED, code="disk_full", tracker_id=None)
    writer.save_alarms([KeptAlarm(seen, None), KeptAlarm(other, None)], events(1))
    assert writer.standing_alarms() == [seen, other]
    writer.save_alarms([KeptAlarm(seen, NOON)])
    assert writer.standing_alarms() == [other]
    ended = writer.alarm_history(AlarmFilter(tracker_id="T1"))
    assert ended == [KeptAlarm(seen, NOON, 1)]
    assert writer.alarm_history(AlarmFilter(before=2, priorities=(2,))) == ended
    assert writer.alarm_history(AlarmFilter(priorities=(1,))) == []
    assert len(writer.journal(JournalFilter())) == 1


def test_retention_takes_the_oldest_and_says_so(writer: DatabaseWriter) -> None:
    writer.append_events(events(6))
    writer.save_alarms([KeptAlarm(RAISED, NOON)])
    assert writer.prune_history(NOON + timedelta(days=3), note) == 3
    left = [entry.event.message for entry in writer.journal(JournalFilter())]
    assert left == ["3 entries.", "Day 5.", "Day 4.", "Day 3."]
    assert writer.alarm_history(AlarmFilter()) == []
    assert writer.prune_history(NOON + timedelta(days=3), note) == 0


def test_nothing_young_leaves_the_journal_and_nothing_is_changed(writer: DatabaseWriter, url: str) -> None:
    writer.append_events(events(6))
    writer.prune_history(NOON + timedelta(days=3), note)
    for statement in ("DELETE FROM events", "UPDATE events SET message = 'nothing'"):
        with pytest.raises(StoreFailed, match=r"only ever appended|refused"):
            execute(url, statement)
    assert len(writer.journal(JournalFilter())) == 4


def test_the_journal_is_narrowed_by_person_and_words(writer: DatabaseWriter) -> None:
    writer.append_events([*events(2), replace(events(1)[0], actor="can", message="100 % of it.")])
    assert [one.event.actor for one in writer.journal(JournalFilter(text="100 %"))] == ["can"]
    assert len(writer.journal(JournalFilter(actor="ayse", text="DAY"))) == 2
    assert writer.journal(JournalFilter(text="1__ %")) == []
