"""The tables, the same in SQLite and PostgreSQL; they are made by the migrations in `alembic/`."""

from datetime import UTC, datetime, timedelta
from typing import Any

from sqlalchemy import (
    BigInteger,
    Column,
    Dialect,
    Double,
    ForeignKey,
    Identity,
    Index,
    Integer,
    LargeBinary,
    MetaData,
    String,
    Table,
    Text,
    TypeDecorator,
    UniqueConstraint,
)

REVISION = "0008"
"""The newest migration: what the tables of a database must be for this software to use them."""

EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
MICROSECOND = timedelta(microseconds=1)


class Instant(TypeDecorator[datetime]):
    """An aware UTC instant, kept as microseconds since 1970 so that both databases order it alike."""

    impl = BigInteger
    cache_ok = True

    def process_bind_param(self, value: datetime | None, dialect: Dialect) -> int | None:
        """Return the number that is stored."""
        return None if value is None else (value - EPOCH) // MICROSECOND

    def process_result_value(self, value: Any | None, dialect: Dialect) -> datetime | None:
        """Return the instant that was stored."""
        return None if value is None else EPOCH + timedelta(microseconds=value)


Number = BigInteger().with_variant(Integer(), "sqlite")

metadata = MetaData(
    naming_convention={
        "ix": "ix_%(table_name)s_%(column_0_N_name)s",
        "pk": "pk_%(table_name)s",
        "fk": "fk_%(table_name)s_%(column_0_name)s",
        "uq": "uq_%(table_name)s_%(column_0_name)s",
    }
)

site = Table(
    "site",
    metadata,
    Column("number", Integer, primary_key=True, autoincrement=False),
    Column("document", Text, nullable=False),
)

software = Table(
    "software",
    metadata,
    Column("number", Integer, primary_key=True, autoincrement=False),
    Column("version", String(50), nullable=False),
)

trackers = Table(
    "trackers",
    metadata,
    Column("number", Number, Identity(), primary_key=True),
    Column("tracker_id", String(200), nullable=False, unique=True),
    Column("document", Text, nullable=False),
    Column("accepted", Text),
    sqlite_autoincrement=True,
)

events = Table(
    "events",
    metadata,
    Column("number", Number, Identity(), primary_key=True),
    Column("at", Instant, nullable=False),
    Column("kind", String(50), nullable=False),
    Column("tracker_id", String(200)),
    Column("actor", Text, nullable=False),
    Column("message", Text, nullable=False),
    Column("data", Text, nullable=False),
    Index(None, "tracker_id", "number"),
    Index(None, "at"),
    sqlite_autoincrement=True,
)

journal_retention = Table(
    "journal_retention",
    metadata,
    Column("number", Integer, primary_key=True, autoincrement=False),
    Column("before_number", BigInteger, nullable=False),
)

alarms = Table(
    "alarms",
    metadata,
    Column("number", Number, Identity(), primary_key=True),
    Column("alarm_id", String(200), nullable=False),
    Column("tracker_id", String(200)),
    Column("priority", Integer, nullable=False),
    Column("raised_at", Instant, nullable=False),
    Column("ended_at", Instant),
    Column("document", Text, nullable=False),
    UniqueConstraint("alarm_id", "raised_at"),
    Index(None, "ended_at"),
    sqlite_autoincrement=True,
)

shows = Table(
    "shows",
    metadata,
    Column("number", Number, Identity(), primary_key=True),
    Column("show_id", String(200), nullable=False, unique=True),
    Column("tracker_id", String(200), nullable=False),
    Column("document", Text, nullable=False),
    sqlite_autoincrement=True,
)

recordings = Table(
    "recordings",
    metadata,
    Column("recording_id", String(200), primary_key=True),
    Column("kind", String(50), nullable=False),
    Column("tracker_id", String(200), nullable=False),
    Column("began_at", Instant, nullable=False),
    Column("ended_at", Instant),
    Column("outcome", Text, nullable=False),
    Column("frame_count", Integer, nullable=False),
    Column("document", Text, nullable=False),
    Index(None, "began_at"),
    Index(None, "tracker_id", "began_at"),
)

chunks = Table(
    "chunks",
    metadata,
    Column("recording_id", ForeignKey("recordings.recording_id", ondelete="CASCADE"), primary_key=True),
    Column("position", Integer, primary_key=True, autoincrement=False),
    Column("first_elapsed_s", Double, nullable=False),
    Column("last_elapsed_s", Double, nullable=False),
    Column("frame_count", Integer, nullable=False),
    Column("frames", LargeBinary, nullable=False),
)

sample_blocks = Table(
    "sample_blocks",
    metadata,
    Column("number", Number, Identity(), primary_key=True),
    Column("recording_id", ForeignKey("recordings.recording_id", ondelete="CASCADE"), nullable=False),
    Column("first_elapsed_s", Double, nullable=False),
    Column("last_elapsed_s", Double, nullable=False),
    Column("frame_count", Integer, nullable=False),
    Column("frames", LargeBinary, nullable=False),
)
"""Frames of running recordings until there are enough for a chunk: few rows, so that no index is kept."""

audit = Table(
    "audit",
    metadata,
    Column("seq", Number, primary_key=True, autoincrement=False),
    Column("utc", Instant, nullable=False),
    Column("mono_ms", BigInteger, nullable=False),
    Column("boot_id", String(64), nullable=False),
    Column("clock_quality", String(20), nullable=False),
    Column("actor", Text, nullable=False),
    Column("via", String(50), nullable=False),
    Column("address", Text, nullable=False),
    Column("action", String(50), nullable=False),
    Column("object", Text, nullable=False),
    Column("given", Text, nullable=False),
    Column("before", Text, nullable=False),
    Column("after", Text, nullable=False),
    Column("result", Text, nullable=False),
    Column("result_parts", Text),
    Column("prev_hash", String(64), nullable=False),
    Column("hash", String(64), nullable=False),
    Index(None, "utc"),
)

records = Table(
    "records",
    metadata,
    Column("number", Number, Identity(), primary_key=True),
    Column("tracker_id", String(200), nullable=False),
    Column("kept_at", Instant, nullable=False),
    Column("kept_by", Text, nullable=False),
    Column("digest", String(64), nullable=False, unique=True),
    Column("document", Text, nullable=False),
    Index(None, "tracker_id", "number"),
    sqlite_autoincrement=True,
)

record_photos = Table(
    "record_photos",
    metadata,
    Column("number", Number, Identity(), primary_key=True),
    Column("tracker_id", String(200), nullable=False),
    Column("record_number", BigInteger),
    Column("added_at", Instant, nullable=False),
    Column("added_by", Text, nullable=False),
    Column("caption", Text, nullable=False),
    Column("digest", String(64), nullable=False),
    Column("width", Integer, nullable=False),
    Column("height", Integer, nullable=False),
    Column("content", LargeBinary, nullable=False),
    Index(None, "tracker_id"),
    Index(None, "record_number"),
    sqlite_autoincrement=True,
)
