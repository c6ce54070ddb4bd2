"""The tables of access come from migrations of their own, with a version table of their own."""

from pathlib import Path

from alembic.config import Config
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import Connection, Engine

from alembic import command
from app.access.tables import VERSION_TABLE
from app.store.connections import transaction
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
