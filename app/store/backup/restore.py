"""Restoring a backup: checked first, the old database kept beside it, never under a running machine."""

import fcntl
import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from sqlalchemy import Connection, func, select

from app.audit.entry import Entry, told
from app.base.addresses.sqlite_url import sqlite_url
from app.base.message import N_
from app.store import tables
from app.store.auditing import append
from app.store.backup.backup import BackupInfo, audit_head, backup, copy_database, inspect_backup
from app.store.connections import reading_engine, revision_of, sqlite_path, transaction, writing_engine
from app.store.files import (
    copy_sqlite,
    make_folder,
    make_portable,
    put_in_place,
    remove_companions,
    remove_sqlite,
)
from app.store.migrations import drop_tables, run_migrations, upgrade
from app.store.store import StoreFailed

LOCK_NAME = "machine.lock"
PENDING_NAME = "restore.pending"
REFUSED_NAME = "restore.refused"
KEPT_NAME = "heliopanel.db"
NUMBERED = (
    tables.trackers,
    tables.events,
    tables.shows,
    tables.alarms,
    tables.records,
    tables.record_photos,
    tables.sample_blocks,
)


@dataclass(frozen=True, slots=True)
class Restored:
    """The database is the backup's now; `kept` is the old one, None if there was none."""

    backup: BackupInfo
    kept: Path | None


@dataclass(frozen=True, slots=True)
class RestorePending:
    """The machine runs: the checked backup lies at `path`, and the machine restores it at its next start."""

    backup: BackupInfo
    path: Path


def request_restore(source: Path, url: str, data_dir: Path, now: datetime) -> Restored | RestorePending:
    """Hand a checked backup over and restore it if no machine runs; else the machine does at its next start.

    Handing over comes first, so that the next start finishes a restore that a power cut interrupted.
    """
    found = inspect_backup(source)
    pending = data_dir / PENDING_NAME
    put_in_place(_stage(source, data_dir / f"{PENDING_NAME}.staged"), pending)
    with _machine_kept_out(data_dir) as stopped:
        if stopped and (restored := apply_pending_restore(data_dir, url, now)) is not None:
            return Restored(found, restored.kept)
    return RestorePending(found, pending)


def apply_pending_restore(data_dir: Path, url: str, now: datetime) -> Restored | None:
    """Restore what was handed over, None if nothing was; the machine calls this before it opens the store.

    A file that cannot be restored is put aside as `restore.refused` and raises `StoreFailed`; the database is
    as it was, so that the next start goes on with it.
    """
    pending = data_dir / PENDING_NAME
    if not pending.exists():
        return None
    try:
        restored = restore(pending, url, now)
    except StoreFailed:
        pending.replace(data_dir / REFUSED_NAME)
        raise
    pending.unlink()
    return restored


def restore(source: Path, url: str, now: datetime) -> Restored:
    """Make a database what a backup holds, or raise `StoreFailed`; the machine must not run.

    An older backup is brought up to date on the way. The old database is kept: beside itself for SQLite, as a
    backup beside `source` for PostgreSQL. The restored audit goes on with an entry that says so, and with the
    head of the audit that it takes the place of.
    """
    found = inspect_backup(source)
    path = sqlite_path(url)
    staged = _stage(source, (path or source).with_name(f"{(path or source).name}.restoring"))
    try:
        _record(staged, found, _head_of(url), now)
        kept = _swap_file(staged, path) if path else _replace_rows(staged, url, source)
    finally:
        remove_sqlite(staged)
    return Restored(found, kept)


def _record(staged: Path, found: BackupInfo, head: str, now: datetime) -> None:
    """Append to the audit of a backup that is about to be restored that it is."""
    given = {
        "site_name": found.site_name,
        "revision": found.revision,
        "audit_head": found.audit_head,
        "replaced_audit_head": head,
    }
    entry = Entry(
        now, 0, "", "unknown", N_("local user"), "console", "", "restore_backup", "site", told(given)
    )
    engine = writing_engine(sqlite_url(staged))
    try:
        with transaction(engine) as connection:
            append(connection, entry)
    finally:
        engine.dispose()
    make_portable(staged)


def _head_of(url: str) -> str:
    """Return the head of the audit that is replaced, empty where the database is missing or damaged."""
    path = sqlite_path(url)
    if path is not None and not path.exists():
        return ""
    engine = reading_engine(url)
    try:
        with transaction(engine) as connection:
            return audit_head(connection)
    except StoreFailed:
        return ""
    finally:
        engine.dispose()


def _stage(source: Path, staged: Path) -> Path:
    """Return a copy of a backup with today's tables."""
    make_folder(staged.parent)
    copy_sqlite(source, staged)
    try:
        upgrade(sqlite_url(staged))
        make_portable(staged)
    except StoreFailed:
        remove_sqlite(staged)
        raise
    return staged


def _swap_file(staged: Path, path: Path) -> Path | None:
    kept = None
    if path.exists():
        _fold_log(path)
        kept = _free_name(path)
        log = path.with_name(f"{path.name}-wal")
        if log.exists():
            log.replace(kept.with_name(f"{kept.name}-wal"))
        path.replace(kept)
    remove_companions(path)
    put_in_place(staged, path)
    return kept


def _fold_log(path: Path) -> None:
    """Bring what the log holds into the file; a damaged file is kept as it is."""
    with suppress(sqlite3.Error), closing(sqlite3.connect(path)) as connection:
        connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")


def _replace_rows(staged: Path, url: str, source: Path) -> Path | None:
    kept = _keep_rows(url, source)
    reading, writing = reading_engine(sqlite_url(staged)), writing_engine(url)
    try:
        with transaction(reading) as from_connection, transaction(writing) as to_connection:
            if kept is not None:
                drop_tables(to_connection)
            run_migrations(to_connection)
            copy_database(from_connection, to_connection)
            _continue_numbers(to_connection)
    finally:
        reading.dispose()
        writing.dispose()
    return kept


def _keep_rows(url: str, source: Path) -> Path | None:
    engine = reading_engine(url)
    try:
        with transaction(engine) as connection:
            if revision_of(connection) is None:
                return None
    finally:
        engine.dispose()
    return backup(url, _free_name(source.with_name(KEPT_NAME))).path


def _continue_numbers(connection: Connection) -> None:
    """Let PostgreSQL's counters go on after the highest number that was restored."""
    for table in NUMBERED:
        counter = func.pg_get_serial_sequence(table.name, "number")
        highest = select(func.coalesce(func.max(table.c.number), 0)).scalar_subquery()
        connection.execute(select(func.setval(counter, highest + 1, False)))


def _free_name(path: Path) -> Path:
    """Return a name beside a file that no other file has."""
    number = 1
    while (candidate := path.with_name(f"{path.name}.before-restore-{number}")).exists():
        number += 1
    return candidate


@contextmanager
def _machine_kept_out(data_dir: Path) -> Iterator[bool]:
    """Hold the machine's lock if nobody does, so that no machine starts now; yield whether it is held."""
    make_folder(data_dir)
    with (data_dir / LOCK_NAME).open("a") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            yield False
            return
        yield True
