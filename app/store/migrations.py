"""Tables come from migrations: brought up to date when the machine starts, checked by `make check`."""

import sqlite3
import sys
import tempfile
from collections.abc import Sequence
from contextlib import closing
from pathlib import Path

from alembic.autogenerate import compare_metadata
from alembic.config import Config
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import Connection, Engine

from alembic import command
from app.store.connections import revision_of, sqlite_path, transaction, writing_engine
from app.store.integrity import check_file
from app.store.store import StoreFailed
from app.store.tables import REVISION, metadata

SCRIPTS = Path(__file__).parents[2] / "alembic"


def upgrade(url: str) -> str | None:
    """Bring a database to the newest tables, making it if there is none; return the revision it had.

    A SQLite file that a migration changes is copied first, beside it; all migrations are one transaction.
    Raises `StoreFailed` for a database that is damaged or newer than this software.
    """
    path = sqlite_path(url)
    if path is not None:
        make_folder(path.parent)
        check_file(url)
    engine = writing_engine(url)
    try:
        with transaction(engine) as connection:
            found = revision_of(connection)
        _refuse_newer(found)
        if found != REVISION:
            if found is not None and path is not None:
                copy_sqlite(path, path.with_name(f"{path.name}.before-{REVISION}"))
            _migrate(engine)
    finally:
        engine.dispose()
    return found


def run_migrations(connection: Connection, revision: str = "head") -> None:
    """Run what leads to a revision inside the transaction that is open on this connection."""
    command.upgrade(_config(connection), revision)


def drop_tables(connection: Connection) -> None:
    """Remove every table inside the transaction that is open on this connection."""
    command.downgrade(_config(connection), "base")


def differences(connection: Connection) -> list[object]:
    """Return in what the tables of a database differ from `tables.py`."""
    return list(
        compare_metadata(MigrationContext.configure(connection, opts={"compare_type": True}), metadata)
    )


def copy_sqlite(source: Path, target: Path) -> None:
    """Copy a SQLite database while it is in use; the target appears complete or not at all."""
    unfinished = target.with_name(f"{target.name}.unfinished")
    unfinished.unlink(missing_ok=True)
    try:
        with closing(sqlite3.connect(source)) as live, closing(sqlite3.connect(unfinished)) as copy:
            live.backup(copy)
    except sqlite3.Error as error:
        unfinished.unlink(missing_ok=True)
        raise StoreFailed(f"The database {source} could not be copied to {target}: {error}.") from error
    unfinished.replace(target)


def make_folder(folder: Path) -> None:
    """Make a folder if there is none, or raise `StoreFailed`."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise StoreFailed(
            f"The folder {folder} cannot be made ({error.strerror}). Choose another one."
        ) from error


def _migrate(engine: Engine) -> None:
    with transaction(engine) as connection:
        run_migrations(connection)


def _refuse_newer(found: str | None) -> None:
    known = {script.revision for script in ScriptDirectory(str(SCRIPTS)).walk_revisions()}
    if found is not None and found not in known:
        raise StoreFailed(
            f"The database was written by a newer version of Heliopanel (revision {found}; this one knows "
            f"up to {REVISION}). Install that version, or restore a backup that this version wrote."
        )


def _config(connection: Connection) -> Config:
    config = Config()
    config.set_main_option("script_location", str(SCRIPTS).replace("%", "%%"))
    config.attributes["connection"] = connection
    return config


def check() -> list[object]:
    """Return in what freshly migrated tables differ from `tables.py`; nothing is how it must be."""
    with tempfile.TemporaryDirectory() as folder:
        url = f"sqlite:///{Path(folder) / 'check.db'}"
        upgrade(url)
        engine = writing_engine(url)
        try:
            with transaction(engine) as connection:
                return differences(connection)
        finally:
            engine.dispose()


def main(arguments: Sequence[str]) -> int:
    """Run `check` or `upgrade URL`; return the exit code."""
    match arguments:
        case ["check"]:
            found = check()
            sys.stdout.writelines(f"Tables and migrations differ: {difference}\n" for difference in found)
            return 1 if found else 0
        case ["upgrade", url]:
            upgrade(url)
            return 0
        case _:
            sys.stderr.write("Say: python -m app.store.migrations check | upgrade URL\n")
            return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
