"""The tables of access: users, sessions, tokens, wrong passwords, and what happened to them."""

from sqlalchemy import Column, Identity, Integer, MetaData, String, Table, Text

from app.store.tables import Instant, Number

VERSION_TABLE = "access_version"
REVISION = "0002"

metadata = MetaData(naming_convention={"pk": "pk_%(table_name)s"})

users = Table(
    "access_users",
    metadata,
    Column("name", String(32), primary_key=True),
    Column("roles", String(100), nullable=False),
    Column("password_hash", Text, nullable=False),
    Column("created_at", Instant, nullable=False),
    Column("changed_at", Instant, nullable=False),
)

sessions = Table(
    "access_sessions",
    metadata,
    Column("digest", String(64), primary_key=True),
    Column("user", String(32), nullable=False),
    Column("token_id", String(16), nullable=False),
    Column("address", String(64), nullable=False),
    Column("agent", String(120), nullable=False),
    Column("began_at", Instant, nullable=False),
    Column("used_at", Instant, nullable=False),
    Column("proven_at", Instant, nullable=False),
    Column("stepped_until", Instant),
)

tokens = Table(
    "access_tokens",
    metadata,
    Column("token_id", String(16), primary_key=True),
    Column("name", String(64), nullable=False),
    Column("owner", String(32), nullable=False),
    Column("digest", String(64), nullable=False),
    Column("scopes", String(100), nullable=False),
    Column("trackers", Text),
    Column("created_at", Instant, nullable=False),
    Column("expires_at", Instant, nullable=False),
    Column("used_at", Instant),
    Column("pin_hash", Text, nullable=False),
)

failures = Table(
    "access_failures",
    metadata,
    Column("subject", String(120), primary_key=True),
    Column("count", Integer, nullable=False),
    Column("last_at", Instant, nullable=False),
)

events = Table(
    "access_events",
    metadata,
    Column("number", Number, Identity(), primary_key=True),
    Column("at", Instant, nullable=False),
    Column("actor", String(100), nullable=False),
    Column("via", String(20), nullable=False),
    Column("address", String(64), nullable=False),
    Column("action", String(50), nullable=False),
    Column("object", String(100), nullable=False),
    Column("result", Text, nullable=False),
    Column("result_parts", Text),
    Column("prev_hash", String(64), nullable=False),
    Column("hash", String(64), nullable=False),
    sqlite_autoincrement=True,
)

meta = Table(
    "access_meta",
    metadata,
    Column("name", String(20), primary_key=True),
    Column("value", Text, nullable=False),
)
