"""Backups: one portable SQLite file, made while the machine runs, whichever database is behind the store."""

import sqlite3
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path
from urllib.parse import quote

from sqlalchemy import Connection, func, insert, inspect, select, text

from app.base.addresses.sqlite_url import sqlite_url
from app.base.message import say, told_by
from app.store import tables
from app.store.connections import (
    reading_engine,
    require_revision,
    revision_of,
    sqlite_path,
    transaction,
    writing_engine,
)
from app.store.documents import SITE
from app.store.files import keep_private, make_folder, make_portable, put_in_place, remove_sqlite
from app.store.migrations import upgrade
from app.store.store import StoreFailed

ROWS_AT_ONCE = 200


@dataclass(frozen=True, slots=True)
class BackupInfo:
    """What is in a backup file."""

    path: Path
    size_bytes: int
    revision: str
    site_name: str
    trackers: int
    events: int
    recordings: int
    audit_head: str = ""
    """The last entry of the audit as `SEQ:HASH`, empty without one: whoever keeps it can prove it later."""


def backup(url: str, target: Path) -> BackupInfo:
    """Write a checked backup of a database that may be in use; the file appears complete or not at all."""
    if target.exists():
        raise StoreFailed(
            say(
                "{target} already exists. Choose another name for the backup, or remove that file.",
                target=target,
            )
        )
    unfinished = target.with_name(f"{target.name}.unfinished")
    make_folder(target.parent)
    try:
        remove_sqlite(unfinished)
        keep_private(unfinished)
        _copy_to_file(url, unfinished)
        found = inspect_backup(unfinished)
        put_in_place(unfinished, target)
    except OSError as error:
        raise StoreFailed(
            say(
                "The backup {target} could not be written: {strerror}.",
                target=target,
                strerror=error.strerror,
            )
        ) from error
    finally:
        remove_sqlite(unfinished)
    return replace(found, path=target, size_bytes=target.stat().st_size)


def inspect_backup(path: Path) -> BackupInfo:
    """Return what is in a backup file after checking every page of it, or raise `StoreFailed`."""
    if not path.is_file():
        raise StoreFailed(say("There is no file {path}. Give the path of a backup.", path=path))
    engine = reading_engine(sqlite_url(path))
    try:
        with transaction(engine) as connection:
            if connection.execute(text("PRAGMA integrity_check(1)")).scalar_one() != "ok":
                raise StoreFailed(say("The backup {path} is damaged. Use another one.", path=path))
            revision = revision_of(connection)
            if revision is None:
                raise StoreFailed(
                    say("{path} is not a backup of Heliopanel. Give the path of a backup.", path=path)
                )
            counted = _count(connection)
            return BackupInfo(
                path, path.stat().st_size, revision, *counted, audit_head=audit_head(connection)
            )
    except StoreFailed as failure:
        raise StoreFailed(
            say("The backup {path} cannot be used. {failure}", path=path, failure=told_by(failure))
        ) from failure
    finally:
        engine.dispose()


def audit_head(connection: Connection) -> str:
    """Return the last entry of the audit as `SEQ:HASH`, empty where there is none."""
    if not inspect(connection).has_table(tables.audit.name):
        return ""
    columns = tables.audit.c
    last = select(columns.seq, columns.hash).order_by(columns.seq.desc()).limit(1)
    found = connection.execute(last).one_or_none()
    return f"{found.seq}:{found.hash}" if found else ""


def copy_database(source: Connection, target: Connection) -> None:
    """Copy every row from one database into the empty tables of another."""
    for table in tables.metadata.sorted_tables:
        rows = source.execution_options(yield_per=ROWS_AT_ONCE).execute(select(table)).mappings()
        for some in rows.partitions():
            target.execute(insert(table), [dict(row) for row in some])


def _copy_to_file(url: str, target: Path) -> None:
    source = sqlite_path(url)
    if source is not None:
        _vacuum(source, target)
        return
    upgrade(sqlite_url(target))
    reading, writing = reading_engine(url), writing_engine(sqlite_url(target))
    try:
        with transaction(reading) as from_connection, transaction(writing) as to_connection:
            require_revision(from_connection)
            copy_database(from_connection, to_connection)
    finally:
        reading.dispose()
        writing.dispose()
    make_portable(target)


def _vacuum(source: Path, target: Path) -> None:
    """Copy a SQLite file in one read transaction: complete, compact, and the writer never waits."""
    try:
        with closing(sqlite3.connect(f"file:{quote(str(source))}?mode=ro", uri=True)) as live:
            live.execute("VACUUM INTO ?", (str(target),))
    except sqlite3.Error as error:
        raise StoreFailed(
            say("The database {source} could not be copied: {error}.", source=source, error=told_by(error))
        ) from error


def _count(connection: Connection) -> tuple[str, int, int, int]:
    document = connection.execute(select(tables.site.c.document)).scalar_one_or_none()
    name = SITE.read(document).name if document else ""
    counts = [
        connection.execute(select(func.count()).select_from(table)).scalar_one()
        for table in (tables.trackers, tables.events, tables.recordings)
    ]
    return name, counts[0], counts[1], counts[2]
