"""Alarms, and the one way by which old entries leave the journal.

Revision 0003, after 0002.
"""

import sqlalchemy as sa

from alembic import op

revision = "0003"
down_revision = "0002"

NUMBER = sa.BigInteger().with_variant(sa.Integer(), "sqlite")

SQLITE_REFUSES_DELETE = """
CREATE TRIGGER events_DELETE_refused BEFORE DELETE ON events
WHEN OLD.number >= COALESCE((SELECT before_number FROM journal_retention), 0)
BEGIN SELECT RAISE(ABORT, 'The journal is only ever appended to.'); END
"""
SQLITE_REFUSED_DELETE = """
CREATE TRIGGER events_DELETE_refused BEFORE DELETE ON events
BEGIN SELECT RAISE(ABORT, 'The journal is only ever appended to.'); END
"""
POSTGRES_KEEP = """
CREATE FUNCTION events_keep() RETURNS trigger LANGUAGE plpgsql AS
$$ BEGIN
  IF OLD.number >= COALESCE((SELECT before_number FROM journal_retention), 0) THEN
    RAISE EXCEPTION 'The journal is only ever appended to.';
  END IF;
  RETURN OLD;
END $$
"""
POSTGRES_KEEPS = """
CREATE TRIGGER events_delete_kept BEFORE DELETE ON events
FOR EACH ROW EXECUTE FUNCTION events_keep()
"""
POSTGRES_REFUSES = """
CREATE TRIGGER events_change_refused BEFORE UPDATE {more}OR TRUNCATE ON events
FOR EACH STATEMENT EXECUTE FUNCTION events_refuse()
"""


def upgrade() -> None:
    op.create_table(
        "alarms",
        sa.Column("number", NUMBER, sa.Identity(), nullable=False),
        sa.Column("alarm_id", sa.String(200), nullable=False),
        sa.Column("tracker_id", sa.String(200)),
        sa.Column("priority", sa.Integer(), nullable=False),
        sa.Column("raised_at", sa.BigInteger(), nullable=False),
        sa.Column("ended_at", sa.BigInteger()),
        sa.Column("document", sa.Text(), nullable=False),
        sa.PrimaryKeyConstraint("number", name="pk_alarms"),
        sa.UniqueConstraint("alarm_id", "raised_at", name="uq_alarms_alarm_id"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_alarms_ended_at", "alarms", ["ended_at"])
    op.create_table(
        "journal_retention",
        sa.Column("number", sa.Integer(), autoincrement=False, nullable=False),
        sa.Column("before_number", sa.BigInteger(), nullable=False),
        sa.PrimaryKeyConstraint("number", name="pk_journal_retention"),
    )
    if op.get_context().dialect.name == "sqlite":
        op.execute("DROP TRIGGER events_DELETE_refused")
        op.execute(SQLITE_REFUSES_DELETE)
    else:
        op.execute("DROP TRIGGER events_change_refused ON events")
        op.execute(POSTGRES_REFUSES.format(more=""))
        op.execute(POSTGRES_KEEP)
        op.execute(POSTGRES_KEEPS)


def downgrade() -> None:
    if op.get_context().dialect.name == "sqlite":
        op.execute("DROP TRIGGER events_DELETE_refused")
        op.execute(SQLITE_REFUSED_DELETE)
    else:
        op.execute("DROP TRIGGER events_delete_kept ON events")
        op.execute("DROP FUNCTION events_keep()")
        op.execute("DROP TRIGGER events_change_refused ON events")
        op.execute(POSTGRES_REFUSES.format(more="OR DELETE "))
    op.drop_table("journal_retention")
    op.drop_table("alarms")
