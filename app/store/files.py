"""Database files: copied while in use, given their name only when they are complete and on the disk."""

import os
import sqlite3
from contextlib import closing, suppress
from pathlib import Path

from app.base.message import say, told_by
from app.store.store import StoreFailed

PRIVATE = 0o600
OTHERS = 0o077
DATABASES = ("*.db", "*.db-*", "*.db.*", "restore.*", "backups/*")
"""What in a data folder may hold secrets: addresses of notifications, names, the audit, and copies."""
COMPANIONS = ("-wal", "-shm", "-journal")
"""What SQLite keeps beside a file; left beside another file of that name it would be played into that."""


def make_folder(folder: Path) -> None:
    """Make a folder if there is none, or raise `StoreFailed`."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise StoreFailed(
            say(
                "The folder {folder} cannot be created ({strerror}). Choose another folder.",
                folder=folder,
                strerror=error.strerror,
            )
        ) from error


def keep_private(path: Path) -> None:
    """Let nobody else read a SQLite file; one that is not there is made, empty.

    SQLite gives what it keeps beside a file the rights of that file.
    """
    try:
        path.touch(PRIVATE)
        for name in (path.name, *(path.name + ending for ending in COMPANIONS)):
            _close_to_others(path.with_name(name))
    except OSError as error:
        raise StoreFailed(
            say(
                "The file {path} cannot be protected from other users ({strerror}). Check its owner.",
                path=path,
                strerror=error.strerror,
            )
        ) from error


def private_opener(name: str, flags: int) -> int:
    """Open a file for `open`; one that is made can be read by nobody else."""
    return os.open(name, flags, PRIVATE)


def keep_all_private(data_dir: Path) -> None:
    """Let nobody else read what databases and backups an older version left in a data folder."""
    for pattern in DATABASES:
        for path in data_dir.glob(pattern):
            with suppress(OSError):
                _close_to_others(path)


def _close_to_others(path: Path) -> None:
    if path.is_file() and path.stat().st_mode & OTHERS:
        path.chmod(PRIVATE)


def lay_out_log(path: Path, size: int) -> None:
    """Give the write-ahead log of an open SQLite file its place on the disk, as far as there is room.

    Commits then only fill it: a file that grows costs the file system's own journal more than what is
    written. SQLite reads its log up to the first frame that is not signed as part of it; zeros are none.
    """
    with suppress(OSError), path.with_name(f"{path.name}-wal").open("r+b", buffering=0) as log:
        present = os.fstat(log.fileno()).st_size
        os.pwrite(log.fileno(), bytes(max(0, size - present)), present)
        os.fsync(log.fileno())


def copy_sqlite(source: Path, target: Path) -> None:
    """Copy a SQLite database while it is in use; the target appears complete or not at all."""
    unfinished = target.with_name(f"{target.name}.unfinished")
    try:
        remove_sqlite(unfinished)
        remove_companions(target)
        keep_private(unfinished)
        with closing(sqlite3.connect(source)) as live, closing(sqlite3.connect(unfinished)) as copy:
            live.backup(copy)
        put_in_place(unfinished, target)
    except (sqlite3.Error, OSError) as error:
        remove_sqlite(unfinished)
        raise StoreFailed(
            say(
                "The database {source} could not be copied to {target}: {error}.",
                source=source,
                target=target,
                error=told_by(error),
            )
        ) from error


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
