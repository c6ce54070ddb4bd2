"""Database files: copied while in use, given their name only when they are complete and on the disk."""

import os
import sqlite3
from contextlib import closing
from pathlib import Path

from app.store.store import StoreFailed

COMPANIONS = ("-wal", "-shm", "-journal")
"""What SQLite keeps beside a file; left beside another file of that name it would be played into that."""


def make_folder(folder: Path) -> None:
    """Make a folder if there is none, or raise `StoreFailed`."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise StoreFailed(
            f"The folder {folder} cannot be made ({error.strerror}). Choose another one."
        ) from error


def copy_sqlite(source: Path, target: Path) -> None:
    """Copy a SQLite database while it is in use; the target appears complete or not at all."""
    unfinished = target.with_name(f"{target.name}.unfinished")
    try:
        remove_sqlite(unfinished)
        remove_companions(target)
        with closing(sqlite3.connect(source)) as live, closing(sqlite3.connect(unfinished)) as copy:
            live.backup(copy)
        put_in_place(unfinished, target)
    except (sqlite3.Error, OSError) as error:
        remove_sqlite(unfinished)
        raise StoreFailed(f"The database {source} could not be copied to {target}: {error}.") from error


def remove_sqlite(path: Path) -> None:
    """Remove a closed SQLite file and what SQLite keeps beside it, if there is any."""
    path.unlink(missing_ok=True)
    remove_companions(path)


def remove_companions(path: Path) -> None:
    """Remove what SQLite keeps beside a closed file, if there is any."""
    for ending in COMPANIONS:
        path.with_name(path.name + ending).unlink(missing_ok=True)


def make_portable(path: Path) -> None:
    """Make a closed SQLite file complete in itself, readable from a folder that cannot be written."""
    with closing(sqlite3.connect(path)) as connection:
        connection.execute("PRAGMA journal_mode = DELETE")


def put_in_place(unfinished: Path, target: Path) -> None:
    """Give a finished file its name, so that it is there after a power cut too."""
    _flush(unfinished)
    unfinished.replace(target)
    _flush(target.parent)


def _flush(path: Path) -> None:
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
