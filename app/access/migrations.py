"""The tables of access come from migrations of their own; `python -m app.access.migrations` checks them."""

import sys
import tempfile
from pathlib import Path

from sqlalchemy import Connection, Engine, column, table

from app.access.tables import REVISION, VERSION_TABLE, metadata
from app.late import late
from app.own import own_folder
from app.store.connections import revision_of, sharing_engine, transaction
from app.store.store import StoreUnfit

SCRIPTS = own_folder("alembic") / "access"
VERSIONS = table(VERSION_TABLE, column("version_num"))


def upgrade(engine: Engine) -> None:
    """Bring the tables up to date in one transaction, making them if there are none."""
    with transaction(engine) as connection:
        found = revision_of(connection, VERSIONS)
        if found != REVISION:
            _migrate(connection, found)


def _migrate(connection: Connection, found: str | None) -> None:
    directory = late("alembic.script").ScriptDirectory(str(SCRIPTS))
    if found not in {None, *(script.revision for script in directory.walk_revisions())}:
        raise StoreUnfit(
            f"The users were written by a newer version of Heliopanel (revision {found}). Install that "
            "version, or begin with new users: the operator's guide, Users, tells how."
        )
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
        engine = sharing_engine(f"sqlite:///{Path(folder) / 'check.db'}")
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
