"""The audit in both databases: in the transaction of the change, chained, and nothing else but appended."""

import json
from dataclasses import replace
from datetime import timedelta
from pathlib import Path

import pytest

from app.audit.chain import FIRST, first_break
from app.audit.entry import Entry
from app.base.message import Message, say
from app.store.backup.backup import backup
from app.store.backup.restore import restore
from app.store.engine import open_reader, open_writer
from app.store.store import AuditFilter, StoreFailed
from app.store.writer import DatabaseWriter
from tests.store.samples import NOON, SITE, execute, tracker

ENTRY = Entry(NOON, 12, "boot", "trusted", "Ayşe", "session", "10.0.0.7", "set_location", "site", "{}")


@pytest.fixture
def audited(writer: DatabaseWriter) -> DatabaseWriter:
    writer.save_site(SITE)
    for number in range(5):
        with writer.audited(replace(ENTRY, utc=NOON + timedelta(minutes=number), object=f"T{number}")):
            writer.save_tracker(tracker(f"T{number}"))
    return writer


def numbers(writer: DatabaseWriter, **wanted: object) -> list[int]:
    return [one.seq for one in writer.audit(AuditFilter(**wanted))]  # type: ignore[arg-type]


def test_an_entry_tells_what_its_transaction_changed(writer: DatabaseWriter) -> None:
    writer.save_site(SITE)
    with writer.audited(ENTRY):
        writer.save_site(replace(SITE, name="North field"))
    (kept,) = writer.audit(AuditFilter())
    assert json.loads(kept.entry.before) == {"name": "Samsun \N{EN DASH} test field"}
    assert json.loads(kept.entry.after) == {"name": "North field"}
    assert (kept.entry.actor, kept.entry.utc, kept.prev_hash) == ("Ayşe", NOON, FIRST)
    stored = writer.site()
    assert stored is not None
    assert stored.name == "North field"


def test_a_refusal_is_read_with_its_values_and_its_chain_holds(writer: DatabaseWriter) -> None:
    refused = say("refused: {error}", error=say("{name} is in service mode.", name="T1"))
    with writer.audited(replace(ENTRY, result=refused)):
        writer.save_site(SITE)
    (kept,) = writer.audit(AuditFilter())
    assert isinstance(kept.entry.result, Message)
    assert kept.entry.result.values == refused.values
    assert first_break([kept.link()]) is None


def test_what_is_not_done_is_not_recorded_as_done(writer: DatabaseWriter) -> None:
    def half_way() -> None:
        with writer.audited(ENTRY):
            writer.save_site(SITE)
            writer.finish_recording("nothing", NOON, "complete")

    with pytest.raises(StoreFailed, match="is not open"):
        half_way()
    assert writer.audit(AuditFilter()) == []
    assert writer.site() is None


def test_a_change_that_cannot_be_recorded_is_not_done(writer: DatabaseWriter) -> None:
    with pytest.raises(StoreFailed), writer.audited(replace(ENTRY, boot_id=None)):  # type: ignore[arg-type]
        writer.save_site(SITE)
    assert writer.site() is None
    writer.save_site(SITE)
    assert writer.site() == SITE


def test_without_a_change_nothing_more_is_recorded(writer: DatabaseWriter) -> None:
    writer.save_site(SITE)
    with writer.audited(ENTRY, only_changes=True):
        writer.save_site(SITE)
    assert writer.audit(AuditFilter()) == []


def test_removing_tells_what_was_there(audited: DatabaseWriter) -> None:
    with audited.audited(replace(ENTRY, action="remove_tracker")):
        audited.remove_tracker("T0", ())
    newest = audited.audit(AuditFilter(limit=1))[0].entry
    assert json.loads(newest.before)["config"]["tracker_id"] == "T0"
    assert newest.after == "{}"


def test_entries_form_a_chain_and_are_found(audited: DatabaseWriter) -> None:
    everything = audited.audit(AuditFilter(after=0))
    assert [one.seq for one in everything] == [1, 2, 3, 4, 5]
    assert first_break(one.link() for one in everything) is None
    assert numbers(audited, limit=2) == [5, 4]
    assert numbers(audited, before=3) == [2, 1]
    assert numbers(audited, object="T3") == [4]
    assert numbers(audited, actor="nobody") == []
    assert numbers(audited, start=NOON + timedelta(minutes=3), end=NOON + timedelta(minutes=4)) == [4]


@pytest.mark.parametrize(
    "statement",
    ["UPDATE audit SET actor = 'eve' WHERE seq = 2", "DELETE FROM audit WHERE seq = 5", "DELETE FROM audit"],
)
def test_entries_are_never_changed(audited: DatabaseWriter, url: str, statement: str) -> None:
    with pytest.raises(StoreFailed):
        execute(url, statement)
    assert numbers(audited) == [5, 4, 3, 2, 1]


def test_text_that_databases_cannot_hold_is_kept_readable(writer: DatabaseWriter) -> None:
    with writer.audited(replace(ENTRY, actor="a\x00b\ud800", via="x" * 90)):
        writer.save_site(SITE)
    (kept,) = writer.audit(AuditFilter())
    assert kept.entry.actor == "a\N{REPLACEMENT CHARACTER}b?"
    assert first_break([kept.link()]) is None


def test_a_backup_takes_the_chain_along(audited: DatabaseWriter, url: str, tmp_path: Path) -> None:
    made = backup(url, tmp_path / "kept.db")
    head = audited.audit(AuditFilter(limit=1))[0]
    assert made.audit_head == f"{head.seq}:{head.hash}"
    with audited.audited(ENTRY):
        audited.save_site(SITE)
    audited.close()
    restore(tmp_path / "kept.db", url, ENTRY.utc)
    again = open_writer(url)
    with again.audited(replace(ENTRY, action="restore")):
        again.save_site(SITE)
    everything = again.audit(AuditFilter(after=0))
    again.close()
    assert [one.seq for one in everything] == [1, 2, 3, 4, 5, 6, 7]
    told = everything[5].entry
    assert (told.action, told.via, json.loads(told.given)["audit_head"]) == (
        "restore_backup",
        "console",
        made.audit_head,
    )
    assert json.loads(told.given)["replaced_audit_head"].startswith("6:")
    assert first_break(one.link() for one in everything) is None
    reader = open_reader(url)
    assert reader.audit(AuditFilter(limit=1))[0].entry.action == "restore"
    reader.close()
