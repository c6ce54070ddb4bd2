"""Tables come from migrations: brought up to date when the machine starts, checked by `make check`.

Alembic is loaded where there is something to migrate; most starts find the newest tables.
"""

import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from sqlalchemy import Connection

from app.base.addresses.sqlite_url import sqlite_url
from app.base.own import own_folder, own_process
from app.base.startup import late
from app.store.connections import revision_of, sqlite_path, transaction, writing_engine
from app.store.files import copy_sqlite, keep_private, make_folder
from app.store.integrity import check_file
from app.store.software import refuse_newer
from app.store.store import StoreUnfit
from app.store.tables import REVISION, metadata

SCRIPTS = own_folder("alembic")


def upgrade(url: str, *, scripts: Path = SCRIPTS) -> str | None:
    """Bring a database to the newest tables, making it if there is none; return the revision it had.

    A SQLite file that a migration changes is copied first, beside it; all migrations are one transaction.
    Raises `StoreDamaged`, or `StoreUnfit` for a database that is newer than this software.
    """
    path = sqlite_path(url)
    if path is not None:
        make_folder(path.parent)
        keep_private(path)
        check_file(url)
    engine = writing_engine(url)
    try:
        with transaction(engine) as connection:
            found = revision_of(connection)
            refuse_newer(connection)
        if (found, scripts) == (REVISION, SCRIPTS):
            return found
        newest = _newest(scripts, found)
        if found != newest:
            if found is not None and path is not None:
                copy_sqlite(path, path.with_name(f"{path.name}.before-{newest}"))
            with transaction(engine) as connection:
                run_migrations(connection, scripts=scripts)
    finally:
        engine.dispose()
    return found


def make_apart(url: str) -> None:
    """Make a SQLite database where there is none; what that loads, 11 MB, ends with the process that does it.

    Where that fails `upgrade` says why, as for any other database.
    """
    path = sqlite_path(url)
    if path is not None and not path.exists():
        command = (*own_process("app.store.migrations"), "upgrade", url)
        quiet = subprocess.DEVNULL
        subprocess.run(command, check=False, stdout=quiet, stderr=quiet)  # noqa: S603 - our own module


def run_migrations(connection: Connection, *, scripts: Path = SCRIPTS) -> None:
    """Run what leads to the newest tables inside the transaction that is open on this connection."""
    late("alembic.command").upgrade(_config(connection, scripts), "head")


def drop_tables(connection: Connection) -> None:
    """Remove every table inside the transaction that is open on this connection."""
    late("alembic.command").downgrade(_config(connection, SCRIPTS), "base")


def differences(connection: Connection) -> list[object]:
    """Return in what the tables of a database differ from `tables.py`."""
    context = late("alembic.migration").MigrationContext.configure(connection, opts={"compare_type": True})
    return list(late("alembic.autogenerate").compare_metadata(context, metadata))


def _newest(scripts: Path, found: str | None) -> str | None:
    """Return the newest revision, or raise `StoreUnfit` if the database is at one that is not known."""
    directory = late("alembic.script").ScriptDirectory(str(scripts))
    newest: str | None = directory.get_current_head()
    known = {script.revision for script in directory.walk_revisions()}
    if found is not None and found not in known:
        raise StoreUnfit(
            f"The database was written by a newer version of Heliopanel (revision {found}; this version "
            f"supports up to {newest}). Install that version, or restore a backup that this version wrote."
        )
    return newest


def _config(connection: Connection, scripts: Path) -> Any:
    config = late("alembic.config").Config()
    config.set_main_option("script_location", str(scripts).replace("%", "%%"))
    config.attributes["connection"] = connection
    return config


def check() -> list[object]:
    """Return in what freshly migrated tables differ from `tables.py`; nothing is how it must be."""
    with tempfile.TemporaryDirectory() as folder:
        url = sqlite_url(Path(folder) / "check.db")
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
