"""Runs migrations on the connection that `app.store.migrations` opened, in one transaction."""

from alembic import context
from app.store.tables import metadata

connection = context.config.attributes.get("connection")
if connection is None:
    raise SystemExit("Run migrations with: python -m app.store.migrations upgrade URL")

context.configure(connection=connection, target_metadata=metadata, transactional_ddl=True, compare_type=True)
with context.begin_transaction():
    context.run_migrations()
