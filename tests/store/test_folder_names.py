"""A data folder may be called anything: all that is stored lies in it, and both sockets can be opened."""

import os
import socket
import tempfile
from contextlib import closing
from pathlib import Path

import pytest

from app.access.accounts import Accounts
from app.access.opening import open_store
from app.access.passwords import Passwords
from app.access.principal import this_computer
from app.access.roles import Role
from app.base.settings import Settings
from app.link.codec import stop_path
from app.machine.safe_mode import rescued
from app.store.backup.backup import backup, inspect_backup
from app.store.backup.backups import backups
from app.store.backup.restore import restore
from app.store.connections import sqlite_path
from app.store.engine import open_reader, open_writer
from app.store.migrations import make_apart, upgrade
from app.studies.folder import StudyFolder
from tests.access.fake_hasher import FakeHasher
from tests.amount import SOAK
from tests.fake_data import NOON
from tests.golden.table import rows
from tests.store.samples import SITE, tracker

NAMES = [row["text"] for row in rows("world/folders.csv")]
MADE_APART = [Path(name).name for name in NAMES if SOAK or "%" in name]
"""Here a process of its own makes the database, as at a first start; that is dear."""


@pytest.fixture(params=NAMES)
def settings(request: pytest.FixtureRequest, tmp_path: Path) -> Settings:
    """Return the settings of a controller whose data folder has this name."""
    folder = tmp_path / "site" / request.param
    folder.mkdir(parents=True)
    return Settings(data_dir=folder)


def test_both_sockets_can_be_opened(settings: Settings, monkeypatch: pytest.MonkeyPatch) -> None:
    for temporary in (None, str(settings.data_dir)):
        monkeypatch.setattr(tempfile, "tempdir", temporary)
        for path in (settings.link_path, stop_path(settings.link_path)):
            with socket.socket(socket.AF_UNIX) as listener:
                try:
                    listener.bind(str(path))
                finally:
                    path.unlink(missing_ok=True)


def test_everything_is_kept_in_the_folder_and_a_backup_is_restored(
    settings: Settings, tmp_path: Path
) -> None:
    if settings.data_dir.name in MADE_APART:
        make_apart(settings.url)
    upgrade(settings.url)
    with closing(open_writer(settings.url)) as writer:
        writer.save_site(SITE)
        writer.save_tracker(tracker("T1"))
    accounts = Accounts(open_store(settings), Passwords(FakeHasher()))
    accounts.add(this_computer("127.0.0.1"), "ann", {Role.ADMINISTRATOR}, "violet-anvil-harbour-9", NOON)
    StudyFolder(settings.data_dir).put_weather("ankara.epw", b"LOCATION")
    names = {path.name for path in settings.data_dir.iterdir()}
    assert {"heliopanel.db", "access.db"} <= names
    outside = [
        path for path in tmp_path.rglob("*") if path.is_file() and not path.is_relative_to(settings.data_dir)
    ]
    assert not outside
    assert sqlite_path(settings.url) == settings.data_dir / "heliopanel.db"
    made = backup(settings.url, settings.data_dir / "backups" / "one.backup")
    assert inspect_backup(made.path).trackers == 1
    (settings.data_dir / "heliopanel.db").write_bytes(b"no database" * 1000)
    found, trackers = rescued(settings.url, settings.data_dir)
    assert (found.name, len(trackers)) == (SITE.name, 1)
    restore(backups(settings.data_dir)[0].path, settings.url, NOON)
    with closing(open_reader(settings.url)) as reader:
        assert reader.site() == SITE


def test_a_folder_that_is_not_in_utf_8_has_its_own_database(tmp_path: Path) -> None:
    folder = Path(os.fsdecode(os.fsencode(tmp_path) + b"/g\xfcne\xfe?"))
    folder.mkdir()
    settings = Settings(data_dir=folder)
    upgrade(settings.url)
    assert (folder / "heliopanel.db").is_file()
