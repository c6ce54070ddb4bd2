"""Runs the migrations of access on the connection that `app.access.migrations` opened, in one transaction."""

from alembic import context
from app.access.tables import VERSION_TABLE, metadata

context.configure(
    connection=context.config.attributes["connection"],
    target_metadata=metadata,
    transactional_ddl=True,
    version_table=VERSION_TABLE,
)
with context.begin_transaction():
    context.run_migrations()
