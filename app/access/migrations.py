"""The tables of access come from migrations of their own; `python -m app.access.migrations` checks them."""

import sys
import tempfile
from pathlib import Path

from sqlalchemy import Connection, Engine, column, select, table

from app.access.tables import REVISION, VERSION_TABLE, meta, metadata
from app.base.addresses.sqlite_url import sqlite_url
from app.base.build import VERSION
from app.base.message import say
from app.base.own import own_folder
from app.base.startup import late
from app.store.connections import revision_of, sharing_engine, transaction
from app.store.files import copy_sqlite
from app.store.putting import put
from app.store.software import is_newer
from app.store.store import StoreUnfit

SCRIPTS = own_folder("alembic") / "access"
VERSIONS = table(VERSION_TABLE, column("version_num"))
WRITTEN_BY = "version"
"""Beside the key and the number of changes: which version of Heliopanel wrote here last."""


def upgrade(engine: Engine) -> None:
    """Bring the tables up to date, making them if there are none, and note that this version writes them.

    A SQLite file that a migration changes is copied first, beside it; all migrations are one transaction.
    Raises `StoreUnfit` for users that a newer version wrote.
    """
    with transaction(engine) as connection:
        found = revision_of(connection, VERSIONS)
        noted = _refuse_newer(connection, found)
    if found not in (None, REVISION) and engine.dialect.name == "sqlite":
        path = Path(engine.url.database or "")
        copy_sqlite(path, path.with_name(f"{path.name}.before-{REVISION}"))
    if (found, noted) == (REVISION, VERSION):
        return
    with transaction(engine) as connection:
        if found != REVISION:
            _migrate(connection)
        put(connection, meta, {"name": WRITTEN_BY}, {"value": VERSION})


def _refuse_newer(connection: Connection, found: str | None) -> str | None:
    """Return which version wrote the users last, None where none was noted; raise for a newer one."""
    if found is None:
        return None
    if found > REVISION:
        raise _newer(
            say("revision {found}; this version supports up to {revision}", found=found, revision=REVISION)
        )
    asked = select(meta.c.value).where(meta.c.name == WRITTEN_BY)
    noted: str | None = connection.execute(asked).scalar_one_or_none()
    if noted is not None and is_newer(noted, VERSION):
        raise _newer(say("{noted}; this version is {version}", noted=noted, version=VERSION))
    return noted


def _newer(what: str) -> StoreUnfit:
    return StoreUnfit(
        say(
            "The users were stored by a newer version of Heliopanel ({what}). Install that "
            "version, or start with new users: move access.db out of the data folder, or drop "
            "the access_* tables in PostgreSQL.",
            what=what,
        )
    )


def _migrate(connection: Connection) -> None:
    config = late("alembic.config").Config()
    config.set_main_option("script_location", str(SCRIPTS).replace("%", "%%"))
    config.attributes["connection"] = connection
    late("alembic.command").upgrade(config, "head")


def differences(connection: Connection) -> list[object]:
    """Return in what the tables of access differ from `tables.py`; tables beside them are not looked at."""
    own = {*metadata.tables, VERSION_TABLE}
    options = {
        "compare_type": True,
        "version_table": VERSION_TABLE,
        "include_name": lambda name, kind, _: kind != "table" or name in own,
    }
    context = late("alembic.migration").MigrationContext.configure(connection, opts=options)
    return list(late("alembic.autogenerate").compare_metadata(context, metadata))


def check() -> list[object]:
    """Return in what freshly migrated tables differ from `tables.py`; nothing is how it must be."""
    with tempfile.TemporaryDirectory() as folder:
        engine = sharing_engine(sqlite_url(Path(folder) / "check.db"))
        try:
            upgrade(engine)
            with transaction(engine) as connection:
                return differences(connection)
        finally:
            engine.dispose()


def main() -> int:
    """Print every difference; return 1 if there is one."""
    found = check()
    sys.stdout.writelines(f"Tables and migrations of access differ: {difference}\n" for difference in found)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
