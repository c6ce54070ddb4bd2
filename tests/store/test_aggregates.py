"""What is saved comes back as it was, on both databases."""

from dataclasses import replace
from datetime import timedelta

import pytest
from sqlalchemy import insert

from app.base.message import say
from app.store import documents, tables
from app.store.connections import transaction, writing_engine
from app.store.reader import DatabaseReader
from app.store.store import JournalFilter, PlannedShow, StoreFailed
from app.store.writer import SHOWS_KEPT, DatabaseWriter
from app.tracker.memory.memory import SiteState, TrackerMemory
from app.tracker.state.snapshot import EventKind
from app.tracker.weather.simulated_weather import SimulatedStation
from tests.store.samples import NOON, SITE, event, execute, plan, tracker

ALL = JournalFilter()


def test_site_and_trackers_come_back_in_the_order_they_were_added(
    writer: DatabaseWriter, reader: DatabaseReader
) -> None:
    writer.save_site(SiteState())
    writer.save_site(SITE)
    for name in ("T2", "T1", "T3"):
        writer.save_tracker(tracker(name))
    changed = replace(tracker("T2"), memory=TrackerMemory())
    writer.save_tracker(changed)
    assert reader.trackers() == [changed, tracker("T1"), tracker("T3")]
    assert reader.site() == SITE


def test_a_removed_tracker_leaves_its_journal(writer: DatabaseWriter, reader: DatabaseReader) -> None:
    writer.save_tracker(tracker(), [event(1, kind=EventKind.TRACKER_ADDED)])
    writer.remove_tracker("T1", [event(2, kind=EventKind.TRACKER_REMOVED)])
    assert reader.trackers() == []
    assert [entry.event.kind for entry in reader.journal(ALL)] == ["tracker_removed", "tracker_added"]


def test_the_oldest_shows_are_forgotten(url: str, writer: DatabaseWriter, reader: DatabaseReader) -> None:
    writer.save_show(PlannedShow("T1", plan("show-0")))
    writer.save_show(PlannedShow("T2", plan("show-0")))
    engine = writing_engine(url)
    with transaction(engine) as connection:
        others = [
            {"show_id": f"show-{number}", "tracker_id": "T1", "document": ""}
            for number in range(1, SHOWS_KEPT)
        ]
        connection.execute(insert(tables.shows), others)
    engine.dispose()
    assert reader.show("show-0") == PlannedShow("T2", plan("show-0")), "replaced by its id"
    writer.save_show(PlannedShow("T1", plan("newest")))
    assert reader.show("show-0") is None
    assert reader.show("newest") == PlannedShow("T1", plan("newest"))


def test_an_event_and_its_change_are_stored_together_or_not_at_all(
    writer: DatabaseWriter, reader: DatabaseReader
) -> None:
    broken = replace(event(), data={"what": object()})
    with pytest.raises(StoreFailed, match="event data cannot be stored"):
        writer.save_site(SITE, [event(), broken])
    assert reader.site() is None
    assert reader.journal(ALL) == []


def test_the_journal_is_read_newest_first_by_a_cursor(writer: DatabaseWriter, reader: DatabaseReader) -> None:
    writer.append_events([event(number) for number in range(25)])
    first = reader.journal(JournalFilter(limit=10))
    second = reader.journal(JournalFilter(limit=10, before=first[-1].number))
    third = reader.journal(JournalFilter(limit=10, before=second[-1].number))
    told = [entry.event for page in (first, second, third) for entry in page]
    assert told == [event(number) for number in reversed(range(25))]


@pytest.mark.parametrize(
    ("wanted", "numbers"),
    [
        (JournalFilter(tracker_id="T2"), [3]),
        (JournalFilter(after=1, limit=2), [1, 2]),
        (JournalFilter(kinds=(EventKind.STOPPED, EventKind.JOG_STARTED)), [2, 1]),
        (JournalFilter(start=NOON + timedelta(seconds=2)), [3, 2]),
        (JournalFilter(end=NOON + timedelta(seconds=1)), [1, 0]),
        (JournalFilter(start=NOON + timedelta(seconds=1), kinds=(EventKind.STOPPED,)), [1]),
    ],
)
def test_filters_narrow_the_journal(
    writer: DatabaseWriter, reader: DatabaseReader, wanted: JournalFilter, numbers: list[int]
) -> None:
    writer.append_events(
        [
            event(0),
            event(1, kind=EventKind.STOPPED),
            event(2, kind=EventKind.JOG_STARTED, tracker_id=None),
            event(3, tracker_id="T2"),
        ]
    )
    assert [entry.event.data["number"] for entry in reader.journal(wanted)] == numbers


@pytest.mark.parametrize(("name", "values"), [("Row 6", {"name": "Row 6"}), ("a\x00 \ud800", {})])
def test_the_journal_keeps_template_and_values_of_a_message(
    writer: DatabaseWriter, reader: DatabaseReader, name: str, values: dict[str, str]
) -> None:
    told = say("The drive of {name} does not answer.", name=name)
    writer.append_events([replace(event(), message=told, actor=name, data={"code": "drive_lost"})])
    (entry,) = reader.journal(ALL)
    assert entry.event.data == {"code": "drive_lost"}
    assert entry.event.message.values == values
    assert entry.event.message.template == (told.template if values else entry.event.message)
    assert entry.event.actor == (name if values else "a\N{REPLACEMENT CHARACTER} ?"), "what a database holds"


@pytest.mark.parametrize(
    ("statement", "sentence"),
    [
        (
            "UPDATE site SET document = '{\"name\": 5}'",
            r"stored site cannot be read \(name: .*Restore a backup",
        ),
        ("UPDATE site SET document = 'not json'", "stored site cannot be read"),
        ("UPDATE trackers SET document = '{}'", "stored tracker 'T1' cannot be read"),
    ],
)
@pytest.mark.fault(52)
def test_a_document_that_does_not_fit_is_named(
    url: str, writer: DatabaseWriter, statement: str, sentence: str
) -> None:
    writer.save_site(SITE)
    writer.save_tracker(tracker())
    execute(url, statement)
    with pytest.raises(StoreFailed, match=sentence):
        print(writer.site(), writer.trackers())


def test_what_former_versions_called_the_controller_is_found_as_the_controller(
    url: str, writer: DatabaseWriter
) -> None:
    execute(
        url, "INSERT INTO events (at, kind, actor, message, data) VALUES (0, 'stopped', 'machine', 'x', '{}')"
    )
    writer.append_events([event(1, kind=EventKind.STOPPED)])
    found = writer.journal(JournalFilter(actor="controller"))
    assert [entry.event.actor for entry in found] == ["controller"]


def test_an_unknown_kind_of_event_is_named(url: str, writer: DatabaseWriter) -> None:
    execute(url, "INSERT INTO events (at, kind, actor, message, data) VALUES (0, 'sang', 'm', 'x', '{}')")
    with pytest.raises(StoreFailed, match="Entry 1 of the journal is of the unknown kind 'sang'"):
        writer.journal(ALL)


def test_a_site_that_named_irradiance_light_is_read() -> None:
    site = SiteState(simulated_weather=SimulatedStation(irradiance_wm2=300.0))
    former = documents.SITE.write(site).replace("irradiance_wm2", "light_wm2")
    assert "light_wm2" in former
    assert documents.SITE.read(former) == site
