"""One file holds everything; it restores into either database, whichever made it."""

import fcntl
import sqlite3
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import pytest

from app.store.backup.backup import backup, inspect_backup
from app.store.backup.restore import (
    LOCK_NAME,
    PENDING_NAME,
    REFUSED_NAME,
    Restored,
    RestorePending,
    apply_pending_restore,
    request_restore,
    restore,
)
from app.store.chunks import encode_all
from app.store.engine import open_reader, open_writer
from app.store.migrations import upgrade
from app.store.store import JournalFilter, PlannedShow, StoreFailed
from app.store.tables import REVISION
from tests.fault_result import FaultResult
from tests.store.postgres import fresh_database
from tests.store.samples import SITE, event, plan, tracker
from tests.store.tracked_day import MIDNIGHT, day_info, tracked_day

EVENTS = 210
"""More than are copied at once."""


def content(url: str) -> tuple[object, ...]:
    """Return all that a store can tell."""
    with closing(open_reader(url)) as reader:
        return (
            reader.site(),
            reader.trackers(),
            reader.journal(JournalFilter(limit=10_000)),
            reader.show("show-1"),
            reader.recordings(),
            encode_all(reader.frames("day-1")),
        )


def fill(url: str, name: str = "one") -> tuple[object, ...]:
    writer = open_writer(url)
    writer.save_site(SITE, [event(number) for number in range(EVENTS)])
    writer.save_tracker(tracker("T1", name))
    writer.save_tracker(tracker("T2"))
    writer.save_show(PlannedShow("T1", plan()))
    writer.begin_recording(day_info())
    writer.append_frames("day-1", tracked_day(1000))
    writer.finish_recording("day-1", MIDNIGHT, "complete")
    writer.close()
    return content(url)


Empty = Callable[[str], str]


@pytest.fixture
def other(tmp_path: Path, request: pytest.FixtureRequest) -> Empty:
    """Makes the address of a further database of a kind, with tables and nothing in them."""

    def make(kind: str) -> str:
        if kind == "sqlite":
            made = f"sqlite:///{tmp_path / 'other' / 'heliopanel.db'}"
        else:
            made = fresh_database(request.getfixturevalue("postgres_folder"))
        upgrade(made)
        return made

    return make


@pytest.mark.parametrize("into", ["sqlite", "postgresql"])
def test_a_backup_restores_into_either_database(url: str, other: Empty, into: str, tmp_path: Path) -> None:
    before = fill(url)
    made = backup(url, tmp_path / "b" / "backup.db")
    nothing = f"sqlite:///{tmp_path / 'new' / 'heliopanel.db'}"
    assert restore(made.path, nothing, MIDNIGHT).kept is None
    assert content(nothing) == before
    assert inspect_backup(made.path) == made
    assert (made.site_name, made.trackers, made.events, made.recordings) == (SITE.name, 2, EVENTS, 1)
    assert (made.revision, made.size_bytes) == (REVISION, made.path.stat().st_size)
    target = other(into)
    replaced = fill(target, "other")
    restored = restore(made.path, target, MIDNIGHT)
    assert content(target) == before
    assert restored.kept is not None
    assert content(f"sqlite:///{restored.kept}") == replaced


def test_an_open_reader_sees_what_was_restored_and_what_is_written_then_goes_on_counting(
    url: str, tmp_path: Path
) -> None:
    fill(url)
    made = backup(url, tmp_path / "backup.db")
    open_and_forget(url)
    with closing(open_reader(url)) as reader:
        assert len(reader.trackers()) == 1
        restore(made.path, url, MIDNIGHT)
        assert len(reader.trackers()) == 2
    writer = open_writer(url)
    writer.append_events([event(EVENTS)])
    writer.save_tracker(tracker("T0"))
    newest = writer.journal(JournalFilter(limit=2))
    names = [state.config.tracker_id for state in writer.trackers()]
    writer.close()
    assert [entry.number for entry in newest] == [EVENTS + 1, EVENTS]
    assert names == ["T1", "T2", "T0"]


def test_a_backup_is_made_while_a_machine_writes(url: str, tmp_path: Path) -> None:
    fill(url)
    writer = open_writer(url)
    with writer._writing.begin() as connection:
        connection.exec_driver_sql("UPDATE shows SET tracker_id = 'changed'")
        made = backup(url, tmp_path / "backup.db")
    writer.close()
    reader = open_reader(f"sqlite:///{made.path}")
    assert reader.show("show-1") == PlannedShow("T1", plan())
    reader.close()


@pytest.mark.fault(51)
def test_a_damaged_database_is_kept_and_replaced(sqlite_url: str, tmp_path: Path, fault: FaultResult) -> None:
    upgrade(sqlite_url)
    before = fill(sqlite_url)
    made = backup(sqlite_url, tmp_path / "backup.db")
    path = tmp_path / "heliopanel.db"
    path.write_bytes(b"rubbish" * 1000)
    restored = restore(made.path, sqlite_url, MIDNIGHT)
    assert content(sqlite_url) == before
    assert restored.kept is not None
    assert restored.kept.read_bytes() == b"rubbish" * 1000
    fault.recovers("a backup is restored; the damaged file is kept")


@pytest.mark.parametrize("kind", ["sqlite"])
def test_a_backup_never_replaces_a_file_and_one_that_fails_leaves_nothing(url: str, tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(StoreFailed, match="already exists"):
        backup(url, tmp_path / "notes.txt")
    with pytest.raises(StoreFailed, match="cannot be created"):
        backup(url, tmp_path / "notes.txt" / "backup.db")
    assert (tmp_path / "notes.txt").read_text() == "mine"
    assert list(tmp_path.rglob("*unfinished*")) == []


def test_a_database_that_is_not_there_cannot_be_backed_up(tmp_path: Path) -> None:
    with pytest.raises(StoreFailed, match="could not be copied"):
        backup(f"sqlite:///{tmp_path / 'none.db'}", tmp_path / "backup.db")
    assert list(tmp_path.iterdir()) == []


def damaged(path: Path) -> None:
    with path.open("r+b") as file:
        file.seek(8192)
        file.write(b"\xa5" * 4096)


def stranger(path: Path) -> None:
    path.unlink()
    with closing(sqlite3.connect(path)) as connection:
        connection.execute("CREATE TABLE birds (name TEXT)")


def newer(path: Path) -> None:
    with closing(sqlite3.connect(path)) as connection:
        connection.execute("UPDATE alembic_version SET version_num = '9999'")
        connection.commit()


@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [
        (damaged, "cannot be used"),
        (stranger, "is not a backup of Heliopanel"),
        (newer, "newer version of Heliopanel"),
        (lambda path: path.write_bytes(b"x" * 5000), "cannot be used"),
        (lambda path: path.unlink(), "There is no file"),
    ],
)
@pytest.mark.parametrize("kind", ["sqlite"])
@pytest.mark.fault(72)
def test_what_is_not_a_good_backup_is_refused(
    url: str, tmp_path: Path, spoil: Callable[[Path], None], sentence: str, fault: FaultResult
) -> None:
    before = fill(url)
    made = backup(url, tmp_path / "backup.db")
    spoil(made.path)
    with pytest.raises(StoreFailed, match=sentence) as refused:
        restore(made.path, url, MIDNIGHT)
    fault.prevented("refused before anything is replaced")
    fault.shows(str(refused.value).replace(str(made.path), "FILE"))
    with pytest.raises(StoreFailed, match=sentence):
        request_restore(made.path, url, tmp_path, MIDNIGHT)
    assert content(url) == before
    assert list(tmp_path.glob("*restoring*")) == []
    assert not (tmp_path / PENDING_NAME).exists()
    fault.recovers("with a good backup")


@pytest.mark.parametrize("kind", ["sqlite"])
def test_a_restore_is_done_at_once_while_no_machine_runs(url: str, tmp_path: Path) -> None:
    before = fill(url)
    made = backup(url, tmp_path / "backup.db")
    (tmp_path / LOCK_NAME).write_text("an old lock file that nobody holds")
    open_and_forget(url)
    assert isinstance(request_restore(made.path, url, tmp_path, MIDNIGHT), Restored)
    assert content(url) == before
    assert apply_pending_restore(tmp_path, url, MIDNIGHT) is None


def open_and_forget(url: str) -> None:
    writer = open_writer(url)
    writer.remove_tracker("T1")
    writer.close()


def test_a_running_machine_restores_at_its_next_start(url: str, tmp_path: Path) -> None:
    before = fill(url)
    made = backup(url, tmp_path / "backup.db")
    open_and_forget(url)
    with (tmp_path / LOCK_NAME).open("w") as held_by_the_machine:
        fcntl.flock(held_by_the_machine, fcntl.LOCK_EX)
        handed_over = request_restore(made.path, url, tmp_path, MIDNIGHT)
        assert isinstance(handed_over, RestorePending)
        assert handed_over.backup.site_name == SITE.name
        assert content(url) != before
        assert (tmp_path / PENDING_NAME).exists()
        restored = apply_pending_restore(tmp_path, url, MIDNIGHT)
    assert restored is not None
    assert content(url) == before
    assert not list(tmp_path.glob(f"{PENDING_NAME}*"))


def test_a_restore_that_a_power_cut_interrupted_is_finished(sqlite_url: str, tmp_path: Path) -> None:
    upgrade(sqlite_url)
    before = fill(sqlite_url)
    backup(sqlite_url, tmp_path / PENDING_NAME)
    (tmp_path / "heliopanel.db").replace(tmp_path / "heliopanel.db.before-restore-1")
    (tmp_path / "heliopanel.db.restoring").write_bytes(b"half a file")
    (tmp_path / "heliopanel.db.restoring-wal").write_bytes(b"half a log")
    assert apply_pending_restore(tmp_path, sqlite_url, MIDNIGHT) is not None
    assert content(sqlite_url) == before
    assert not list(tmp_path.glob("*restoring*"))


@pytest.mark.parametrize("kind", ["sqlite"])
def test_a_pending_file_that_went_bad_is_put_aside(url: str, tmp_path: Path) -> None:
    before = fill(url)
    (tmp_path / PENDING_NAME).write_bytes(b"rubbish" * 1000)
    with pytest.raises(StoreFailed, match="cannot be used"):
        apply_pending_restore(tmp_path, url, MIDNIGHT)
    assert (tmp_path / REFUSED_NAME).exists()
    assert apply_pending_restore(tmp_path, url, MIDNIGHT) is None
    assert content(url) == before
