"""Tables come from migrations alone; a newer database is refused, an older one copied before it changes."""

import multiprocessing
import shutil
import signal
from pathlib import Path

import pytest
from sqlalchemy import text

from app.store.connections import revision_of, sqlite_path, transaction, writing_engine
from app.store.engine import open_reader, open_writer
from app.store.files import copy_sqlite
from app.store.migrations import (
    SCRIPTS,
    differences,
    make_apart,
    upgrade,
)
from app.store.store import StoreFailed
from app.store.tables import REVISION
from tests.fault_result import FaultResult
from tests.patience import PATIENCE_S
from tests.store.samples import SITE, execute


def test_tables_and_migrations_agree(url: str) -> None:
    engine = writing_engine(url)
    with transaction(engine) as connection:
        assert differences(connection) == []
        connection.execute(text("ALTER TABLE shows ADD COLUMN colour TEXT"))
        assert "colour" in str(differences(connection))
    engine.dispose()


def test_a_new_database_is_made_in_a_process_of_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    url = f"sqlite:///{tmp_path / 'new' / 'heliopanel.db'}"
    make_apart(url)
    loaded: list[str] = []
    monkeypatch.setattr("app.store.migrations.late", loaded.append)
    assert upgrade(url) == REVISION
    assert loaded == []


def test_a_migration_that_fails_leaves_nothing_behind(empty_url: str) -> None:
    execute(empty_url, "CREATE TABLE recordings (already INTEGER)")
    with pytest.raises(StoreFailed, match="rejected"):
        upgrade(empty_url)
    engine = writing_engine(empty_url)
    with transaction(engine) as connection:
        assert revision_of(connection) is None
        assert not connection.dialect.has_table(connection, "site")
    engine.dispose()


@pytest.mark.fault(72)
def test_a_newer_database_is_refused(url: str, fault: FaultResult) -> None:
    execute(url, "UPDATE alembic_version SET version_num = '9999'")
    with pytest.raises(
        StoreFailed, match=r"newer version of Heliopanel .revision 9999.*Install that version"
    ) as refused:
        upgrade(url)
    fault.prevented("refused before anything is changed")
    fault.shows(str(refused.value))
    with pytest.raises(StoreFailed, match="at revision 9999, but this version of Heliopanel needs"):
        open_writer(url)
    reader = open_reader(url)
    with pytest.raises(StoreFailed, match="at revision 9999"):
        reader.site()
    reader.close()
    fault.recovers("the newer version is installed again, or a backup of this version is restored")


def test_a_reader_waits_for_the_database(sqlite_url: str) -> None:
    reader = open_reader(sqlite_url)
    with pytest.raises(StoreFailed, match="cannot be opened"):
        reader.site()
    upgrade(sqlite_url)
    assert reader.site() is None
    reader.close()


def test_a_database_without_tables_is_not_written(empty_url: str) -> None:
    with pytest.raises(StoreFailed, match=r"has no tables yet\. Start the machine once"):
        open_writer(empty_url)


@pytest.mark.parametrize(
    "bad", ["mysql://me:secret@a/b", "sqlite://", "sqlite:///:memory:", "nonsense", "postgresql://a/b"]
)
def test_only_known_databases_are_opened(bad: str) -> None:
    with pytest.raises(StoreFailed, match="sqlite:///") as refused:
        open_reader(bad)
    assert "secret" not in str(refused.value)
    assert refused.value.exit_code == 2, "a service that ends with 2 is not started again"


def test_a_copy_is_complete_or_absent(sqlite_url: str, tmp_path: Path) -> None:
    upgrade(sqlite_url)
    path = Path(str(sqlite_path(sqlite_url)))
    copy_sqlite(path, tmp_path / "copy.db")
    assert (tmp_path / "copy.db").exists()
    path.write_bytes(b"rubbish" * 1000)
    with pytest.raises(StoreFailed, match="could not be copied"):
        copy_sqlite(path, tmp_path / "second.db")
    assert [file.name for file in tmp_path.glob("*second*")] == []


LATER = """
import os, signal
import sqlalchemy as sa
from alembic import op

revision = "later"
down_revision = "{newest}"


def upgrade() -> None:
    op.add_column("shows", sa.Column("colour", sa.Text()))
    op.execute("DELETE FROM site")
    {then}
"""


def later_software(folder: Path, then: str) -> Path:
    """Return the migrations of a later version, whose last one empties the site and then does something."""
    scripts = folder / "later"
    shutil.copytree(SCRIPTS, scripts, ignore=shutil.ignore_patterns("__pycache__"))
    (scripts / "versions" / "later.py").write_text(LATER.format(then=then, newest=REVISION))
    return scripts


def with_a_site(url: str) -> str:
    writer = open_writer(url)
    writer.save_site(SITE)
    writer.close()
    return url


def still_usable(url: str) -> bool:
    reader = open_reader(url)
    try:
        return reader.site() == SITE
    finally:
        reader.close()


def test_a_database_is_copied_before_a_migration_changes_it(sqlite_url: str, tmp_path: Path) -> None:
    upgrade(sqlite_url)
    with_a_site(sqlite_url)
    assert upgrade(sqlite_url, scripts=later_software(tmp_path, "pass")) == REVISION
    with pytest.raises(StoreFailed, match="newer version"):
        upgrade(sqlite_url)
    assert still_usable(f"{sqlite_url}.before-later")


def test_a_migration_that_fails_midway_leaves_the_old_database(url: str, tmp_path: Path) -> None:
    with_a_site(url)
    with pytest.raises(StoreFailed, match="rejected"):
        upgrade(url, scripts=later_software(tmp_path, "op.execute('nonsense')"))
    assert upgrade(url) == REVISION
    assert still_usable(url)


@pytest.mark.fault(53)
def test_a_migration_that_is_killed_midway_leaves_the_old_database(
    url: str, tmp_path: Path, fault: FaultResult
) -> None:
    with_a_site(url)
    scripts = later_software(tmp_path, "os.kill(os.getpid(), signal.SIGKILL)")
    child = multiprocessing.get_context("fork").Process(
        target=upgrade, args=(url,), kwargs={"scripts": scripts}
    )
    child.start()
    child.join(PATIENCE_S)
    assert child.exitcode == -signal.SIGKILL
    assert upgrade(url) == REVISION
    assert still_usable(url)
    fault.prevented("the migration is one transaction")
    fault.shows_nothing("the next start migrates again")
    fault.recovers("automatic: with the next start")
