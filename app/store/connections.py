"""Connections: one that writes, any number that only read, on SQLite files and on PostgreSQL."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from urllib.parse import quote

from sqlalchemy import (
    URL,
    Connection,
    Engine,
    NullPool,
    TableClause,
    create_engine,
    event,
    inspect,
    make_url,
    select,
    table,
)
from sqlalchemy import column as sql_column
from sqlalchemy.exc import ArgumentError, SQLAlchemyError

from app.base.extras import need
from app.store.failures import explained
from app.store.store import StoreFailed, StoreUnfit
from app.store.tables import REVISION

BUSY_MS = 3000
"""Below the 5 s for which the panel waits for an answer, so that it hears why nothing was stored."""
LOG_PAGES = 256
"""Pages in the write-ahead log after which it is folded into the file and begun anew: one megabyte."""
LOG_BYTES = (LOG_PAGES + 64) * (4096 + 24)
"""How long the log is laid out at once: those pages with their frames, and a transaction beyond."""
WRITER_PRAGMAS = (
    f"PRAGMA busy_timeout = {BUSY_MS}",
    "PRAGMA journal_mode = WAL",
    f"PRAGMA wal_autocheckpoint = {LOG_PAGES}",
    "PRAGMA synchronous = FULL",
    "PRAGMA foreign_keys = ON",
)
SHARING_PRAGMAS = (
    f"PRAGMA busy_timeout = {BUSY_MS}",
    "PRAGMA journal_mode = DELETE",
    "PRAGMA synchronous = FULL",
    "PRAGMA foreign_keys = ON",
)
READER_PRAGMAS = (
    f"PRAGMA busy_timeout = {BUSY_MS}",
    "PRAGMA query_only = ON",
    "PRAGMA wal_autocheckpoint = 0",
)
POSTGRES = {"connect_timeout": 5, "options": f"-c lock_timeout={BUSY_MS} -c synchronous_commit=on"}
VERSION_TABLE = table("alembic_version", sql_column("version_num"))


def parse_url(url: str) -> URL:
    """Return the parsed address of a database, or raise `StoreUnfit` if it is of no known kind."""
    try:
        parsed = make_url(url)
    except ArgumentError as error:
        raise StoreUnfit(
            f"{url!r} is not a database URL, such as sqlite:////var/lib/heliopanel/a.db."
        ) from error
    if parsed.drivername == "postgresql+psycopg":
        need("postgres")
        return parsed
    if parsed.get_backend_name() != "sqlite" or parsed.database in (None, "", ":memory:"):
        raise StoreUnfit(
            f"{parsed.render_as_string()} cannot be used: give sqlite:///FILE or postgresql+psycopg://USER@HOST/NAME."
        )
    return parsed


def sqlite_path(url: str) -> Path | None:
    """Return the file of a SQLite database, None for PostgreSQL."""
    parsed = parse_url(url)
    return Path(parsed.database or "") if parsed.get_backend_name() == "sqlite" else None


def writing_engine(url: str) -> Engine:
    """Return an engine with exactly one connection, whose transactions take the write lock at once."""
    return _single(url, WRITER_PRAGMAS)


def sharing_engine(url: str) -> Engine:
    """Return an engine for a database that several processes write; on SQLite with a rollback journal.

    A write-ahead log is not used: SQLite before 3.51.3 may damage it when two connections write.
    """
    return _single(url, SHARING_PRAGMAS)


def reading_engine(url: str, *, keeps_open: bool = False) -> Engine:
    """Return an engine that cannot write.

    On SQLite each use opens the file anew, to see a restored one; with `keeps_open` it stays open, for those
    who ask every second: under root, SQLite changes the owner of its log with each opening.
    """
    path = sqlite_path(url)
    if path is None:
        options = {"postgresql_readonly": True, "isolation_level": "REPEATABLE READ"}
        return create_engine(
            parse_url(url), pool_pre_ping=True, connect_args=POSTGRES, execution_options=options
        )
    readonly = URL.create("sqlite", database=f"file:{quote(str(path))}", query={"mode": "ro", "uri": "true"})
    engine = create_engine(readonly) if keeps_open else create_engine(readonly, poolclass=NullPool)
    _speak_sqlite(engine, READER_PRAGMAS, "BEGIN")
    return engine


def _single(url: str, pragmas: tuple[str, ...]) -> Engine:
    """Return an engine with one connection; on SQLite it speaks these pragmas and locks when it begins."""
    if sqlite_path(url) is None:
        return create_engine(
            parse_url(url), pool_size=1, max_overflow=0, pool_pre_ping=True, connect_args=POSTGRES
        )
    engine = create_engine(
        parse_url(url), pool_size=1, max_overflow=0, connect_args={"timeout": BUSY_MS / 1000}
    )
    _speak_sqlite(engine, pragmas, "BEGIN IMMEDIATE")
    return engine


def _speak_sqlite(engine: Engine, pragmas: tuple[str, ...], begin: str) -> None:
    """Make every connection begin its transactions itself; the driver's own rules would begin too late."""

    @event.listens_for(engine, "connect")
    def set_up(connection: Any, _record: object) -> None:
        connection.isolation_level = None
        for pragma in pragmas:
            connection.execute(pragma)

    @event.listens_for(engine, "begin")
    def start(connection: Connection) -> None:
        connection.exec_driver_sql(begin)


@contextmanager
def transaction(engine: Engine) -> Iterator[Connection]:
    """Yield a connection in one transaction; whatever fails undoes all of it and becomes `StoreFailed`."""
    try:
        with engine.begin() as connection:
            yield connection
    except SQLAlchemyError as error:
        raise explained(error) from error


def revision_of(connection: Connection, versions: TableClause = VERSION_TABLE) -> str | None:
    """Return which migration the tables are at, None for a database without tables."""
    if not inspect(connection).has_table(versions.name):
        return None
    return connection.execute(select(versions.c.version_num)).scalar_one_or_none()


def require_revision(connection: Connection) -> None:
    """Raise `StoreFailed` unless the tables are those that this software was made for."""
    found = revision_of(connection)
    if found is None:
        raise StoreFailed("The database has no tables yet. Start the machine once: it makes them.")
    if found != REVISION:
        raise StoreFailed(
            f"The database is at revision {found}, but this version of Heliopanel needs {REVISION}. "
            "Start the machine, which brings an older database up to date, or install the version that wrote "
            "a newer one."
        )
