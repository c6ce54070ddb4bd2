"""Whether a SQLite file can be trusted, asked when it is opened."""

import sqlite3

from sqlalchemy import text

from app.base.message import N_, join, say
from app.store import tables
from app.store.connections import reading_engine, sqlite_path, transaction
from app.store.store import StoreDamaged

FIRST_SAFE_SQLITE = (3, 51, 3)
"""Older ones may damage a database in WAL mode if two connections write at once; here only one writes."""

RESTORE = N_("Restore a backup with: heliopanel restore FILE.")


def check_file(url: str) -> None:
    """Raise `StoreDamaged` if an existing SQLite file is damaged.

    Chunks are not looked through: they are most of the file, and each carries its own checksum.
    """
    path = sqlite_path(url)
    if path is None or not path.exists() or path.stat().st_size == 0:
        return
    engine = reading_engine(url)
    try:
        with transaction(engine) as connection:
            present = set(
                connection.execute(text("SELECT name FROM sqlite_master WHERE type = 'table'")).scalars()
            )
            for name in (table.name for table in tables.metadata.sorted_tables if table is not tables.chunks):
                found = (
                    connection.execute(text(f"PRAGMA quick_check({name})")).scalars()
                    if name in present
                    else ()
                )
                if any(line != "ok" for line in found):
                    damage = say("The database {path} is damaged (table {name}).", path=path, name=name)
                    raise StoreDamaged(join(" ", (damage, RESTORE)))
    finally:
        engine.dispose()


def sqlite_notice() -> str | None:
    """Return what a log should say about the linked SQLite, None if it is known to be good."""
    if sqlite3.sqlite_version_info >= FIRST_SAFE_SQLITE:
        return None
    return say(
        "SQLite {sqlite_version} is older than 3.51.3, which fixed a rare error with two "
        "writers. Heliopanel writes through one connection only; do not let another program "
        "write to its database.",
        sqlite_version=sqlite3.sqlite_version,
    )
