"""Nobody else on the computer reads the database, what SQLite keeps beside it, or copies of it."""

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.access.store import AccessStore
from app.store.backup.backup import backup
from app.store.backup.restore import Restored, request_restore
from app.store.engine import open_reader, open_writer
from app.store.files import copy_sqlite, keep_all_private
from app.store.migrations import upgrade
from tests.store.samples import NOON, SITE


@pytest.fixture(autouse=True)
def usual_umask() -> Iterator[None]:
    """Files that say nothing else can be read by everybody, as on most computers."""
    before = os.umask(0o022)
    yield
    os.umask(before)


def rights(folder: Path) -> dict[str, str]:
    return {
        str(path.relative_to(folder)): f"{path.stat().st_mode & 0o777:o}"
        for path in folder.rglob("*")
        if path.is_file()
    }


def test_a_new_database_its_copies_and_what_a_restore_leaves_are_private(
    sqlite_url: str, tmp_path: Path
) -> None:
    upgrade(sqlite_url)
    writer, reader = open_writer(sqlite_url), open_reader(sqlite_url)
    writer.save_site(SITE)
    assert reader.site() == SITE
    made = backup(sqlite_url, tmp_path / "backups" / "a.backup")
    copy_sqlite(tmp_path / "heliopanel.db", tmp_path / "heliopanel.db.before-0009")
    with AccessStore(f"sqlite:///{tmp_path / 'access.db'}", b"key").writing():
        pass
    found = rights(tmp_path)
    writer.close()
    names = {"heliopanel.db", "heliopanel.db-wal", "heliopanel.db-shm", "backups/a.backup", "access.db"}
    assert found.keys() >= {*names, "heliopanel.db.before-0009"}
    assert set(found.values()) == {"600"}
    assert isinstance(request_restore(made.path, sqlite_url, tmp_path, NOON), Restored)
    (tmp_path / "machine.lock").unlink()
    assert set(rights(tmp_path).values()) == {"600"}


def test_files_of_an_older_version_are_made_private(sqlite_url: str, tmp_path: Path) -> None:
    upgrade(sqlite_url)
    writer = open_writer(sqlite_url)
    writer.save_site(SITE)
    (tmp_path / "backups").mkdir()
    for name in ("backups/old.backup", "access.db", "heliopanel.db.before-0002", "restore.refused"):
        (tmp_path / name).write_bytes(b"")
    for path in tmp_path.rglob("*"):
        path.chmod(0o755 if path.is_dir() else 0o644)
    keep_all_private(tmp_path)
    assert set(rights(tmp_path).values()) == {"600"}
    writer.close()
    (tmp_path / "heliopanel.db").chmod(0o644)
    upgrade(sqlite_url)
    assert rights(tmp_path)["heliopanel.db"] == "600"
