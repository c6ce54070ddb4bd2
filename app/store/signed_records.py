"""Signed commissioning records and their photos in the database."""

from collections.abc import Sequence
from typing import Any

from sqlalchemy import ColumnElement, Connection, Row, delete, insert, select, update

from app.base.message import N_
from app.store.documents import plain
from app.store.store import Photo, RecordHead, SignedRecord, StoreFailed
from app.store.tables import record_photos, records

HEAD = (
    records.c.number,
    records.c.tracker_id,
    records.c.kept_at,
    records.c.kept_by,
    records.c.digest,
)


def heads(connection: Connection, tracker_id: str | None, limit: int, before: int | None) -> list[RecordHead]:
    """Return the heads of signed records, newest first: those before a number."""
    query = select(*HEAD).order_by(records.c.number.desc()).limit(limit)
    if tracker_id is not None:
        query = query.where(records.c.tracker_id == tracker_id)
    if before is not None:
        query = query.where(records.c.number < before)
    return [_head(row) for row in connection.execute(query)]


def record(connection: Connection, number: int) -> SignedRecord | None:
    """Return one signed record."""
    query = select(*HEAD, records.c.document).where(records.c.number == number)
    row = connection.execute(query).one_or_none()
    return None if row is None else SignedRecord(_head(row), row.document)


def photos(connection: Connection, *conditions: ColumnElement[bool]) -> list[Photo]:
    """Return photos in the order they were added."""
    query = select(record_photos).where(*conditions).order_by(record_photos.c.number)
    return [Photo(**row) for row in connection.execute(query).mappings()]


def sign(connection: Connection, head: RecordHead, document: str, taken: Sequence[int]) -> int:
    """Add a record with the photos that it takes, or raise `StoreFailed` if one of them waits no longer."""
    values = {
        "tracker_id": head.tracker_id,
        "kept_at": head.kept_at,
        "kept_by": plain(head.kept_by),
        "digest": head.digest,
        "document": document,
    }
    number = int(connection.execute(insert(records).values(values).returning(records.c.number)).scalar_one())
    columns = record_photos.c
    waiting = (columns.tracker_id == head.tracker_id, columns.record_number.is_(None))
    moved = connection.execute(
        update(record_photos).where(columns.number.in_(taken), *waiting).values(record_number=number)
    )
    if moved.rowcount != len(taken):
        raise StoreFailed(
            N_("A photo of this record was removed meanwhile. Load the page again and sign again.")
        )
    return number


def add_photo(connection: Connection, photo: Photo) -> None:
    """Store a photo that waits for the next record of its tracker."""
    values = {column.name: getattr(photo, column.name) for column in record_photos.c}
    del values["number"]
    values |= {"caption": plain(photo.caption), "added_by": plain(photo.added_by)}
    connection.execute(insert(record_photos).values(values))


def remove_photo(connection: Connection, number: int) -> None:
    """Remove a photo that waits."""
    columns = record_photos.c
    connection.execute(delete(record_photos).where(columns.number == number, columns.record_number.is_(None)))


def _head(row: Row[*tuple[Any, ...]]) -> RecordHead:
    return RecordHead(row.number, row.tracker_id, row.kept_at, row.kept_by, row.digest)
