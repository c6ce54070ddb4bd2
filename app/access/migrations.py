"""The tables of access come from migrations of their own; `python -m app.access.migrations` checks them."""

import sys
import tempfile
from pathlib import Path

from alembic.autogenerate import compare_metadata
from alembic.config import Config
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import Connection, Engine

from alembic import command
from app.access.tables import VERSION_TABLE, metadata
from app.store.connections import sharing_engine, transaction
from app.store.store import StoreFailed

SCRIPTS = Path(__file__).parents[2] / "alembic" / "access"


def upgrade(engine: Engine) -> None:
    """Bring the tables up to date in one transaction, making them if there are none."""
    with transaction(engine) as connection:
        config = Config()
        config.set_main_option("script_location", str(SCRIPTS).replace("%", "%%"))
        config.attributes["connection"] = connection
        found, directory = revision_of(connection), ScriptDirectory(str(SCRIPTS))
        if found not in {None, *(script.revision for script in directory.walk_revisions())}:
            raise StoreFailed(
                f"The users were written by a newer version of Heliopanel (revision {found}). Install that "
                "version, or begin with new users: docs/operators-guide.md, Users, tells how."
            )
        if found != directory.get_current_head():
            command.upgrade(config, "head")


def revision_of(connection: Connection) -> str | None:
    """Return which migration the tables of access are at, None where there are none."""
    context = MigrationContext.configure(connection, opts={"version_table": VERSION_TABLE})
    return context.get_current_revision()


def differences(connection: Connection) -> list[object]:
    """Return in what the tables of access differ from `tables.py`; tables beside them are not looked at."""
    own = {*metadata.tables, VERSION_TABLE}
    options = {
        "compare_type": True,
        "version_table": VERSION_TABLE,
        "include_name": lambda name, kind, _: kind != "table" or name in own,
    }
    return list(compare_metadata(MigrationContext.configure(connection, opts=options), metadata))


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
