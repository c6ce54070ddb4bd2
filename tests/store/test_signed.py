"""What was signed stays as it was signed, on both databases."""

from datetime import UTC, datetime

import pytest

from app.store.store import JournalFilter, Photo, RecordHead, StoreFailed
from app.store.writer import DatabaseWriter
from tests.store.samples import event, execute

NOON = datetime(2027, 6, 21, 9, 0, tzinfo=UTC)


def head(digest: str, tracker_id: str = "T1") -> RecordHead:
    return RecordHead(0, tracker_id, NOON, "ayşe", digest)


def photo(tracker_id: str = "T1", content: bytes = b"\xff\xd8\x00jpeg") -> Photo:
    return Photo(tracker_id, NOON, "ayşe", "Type plate", "c" * 64, 640, 480, content)


def test_records_are_numbered_and_take_their_photos(writer: DatabaseWriter) -> None:
    for one in (photo(), photo("T2"), photo(content=b"2")):
        writer.add_photo(one)
    mine = writer.waiting_photos("T1")
    assert [one.content for one in mine] == [b"\xff\xd8\x00jpeg", b"2"]
    writer.remove_photo(mine[1].number)
    assert writer.sign_record(head("a" * 64), "{}", [mine[0].number], [event()]) == 1
    assert writer.sign_record(head("b" * 64, "T2"), "[]", [], []) == 2
    assert [one.number for one in writer.signed_records()] == [2, 1]
    assert [one.tracker_id for one in writer.signed_records("T2")] == ["T2"]
    kept = writer.signed_record(1)
    assert kept is not None
    assert (kept.document, kept.head.kept_at, kept.head.kept_by) == ("{}", NOON, "ayşe")
    assert writer.photos_of(1) == [writer.photo(mine[0].number)]
    assert writer.waiting_photos("T1") == []
    assert len(writer.waiting_photos("T2")) == 1
    assert len(writer.journal(JournalFilter())) == 1
    assert writer.signed_record(3) is None
    assert writer.photo(99) is None


def test_a_photo_that_is_gone_keeps_the_record_from_being_signed(writer: DatabaseWriter) -> None:
    with pytest.raises(StoreFailed, match="removed meanwhile"):
        writer.sign_record(head("a" * 64), "{}", [7], [event()])
    assert writer.signed_records() == []
    assert writer.journal(JournalFilter()) == []


@pytest.mark.parametrize(
    "statement",
    [
        "DELETE FROM records",
        "UPDATE records SET document = 'forged'",
        "DELETE FROM record_photos",
        "UPDATE record_photos SET record_number = NULL",
    ],
)
def test_what_was_signed_can_neither_be_changed_nor_removed(
    statement: str, writer: DatabaseWriter, url: str
) -> None:
    writer.add_photo(photo())
    writer.sign_record(head("a" * 64), "{}", [writer.waiting_photos("T1")[0].number], [])
    writer.remove_photo(1)
    with pytest.raises(StoreFailed, match=r"stays as it is|refused"):
        execute(url, statement)
    assert len(writer.photos_of(1)) == 1
