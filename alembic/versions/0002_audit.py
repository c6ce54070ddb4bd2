"""The audit: every command and change of settings, chained by hashes, only ever appended to.

Revision 0002, after 0001.
"""

import sqlalchemy as sa

from alembic import op

revision = "0002"
down_revision = "0001"

NUMBER = sa.BigInteger().with_variant(sa.Integer(), "sqlite")
TEXTS = ("given", "before", "after", "result")

SQLITE_REFUSES = """
CREATE TRIGGER audit_{action}_refused BEFORE {action} ON audit
BEGIN SELECT RAISE(ABORT, 'The audit is only ever appended to.'); END
"""
POSTGRES_FUNCTION = """
CREATE FUNCTION audit_refuse() RETURNS trigger LANGUAGE plpgsql AS
$$ BEGIN RAISE EXCEPTION 'The audit is only ever appended to.'; END $$
"""
POSTGRES_REFUSES = """
CREATE TRIGGER audit_change_refused BEFORE UPDATE OR DELETE OR TRUNCATE ON audit
FOR EACH STATEMENT EXECUTE FUNCTION audit_refuse()
"""


def upgrade() -> None:
    op.create_table(
        "audit",
        sa.Column("seq", NUMBER, autoincrement=False, nullable=False),
        sa.Column("utc", sa.BigInteger(), nullable=False),
        sa.Column("mono_ms", sa.BigInteger(), nullable=False),
        sa.Column("boot_id", sa.String(64), nullable=False),
        sa.Column("clock_quality", sa.String(20), nullable=False),
        sa.Column("actor", sa.Text(), nullable=False),
        sa.Column("via", sa.String(50), nullable=False),
        sa.Column("address", sa.Text(), nullable=False),
        sa.Column("action", sa.String(50), nullable=False),
        sa.Column("object", sa.Text(), nullable=False),
        *(sa.Column(name, sa.Text(), nullable=False) for name in TEXTS),
        sa.Column("prev_hash", sa.String(64), nullable=False),
        sa.Column("hash", sa.String(64), nullable=False),
        sa.PrimaryKeyConstraint("seq", name="pk_audit"),
    )
    op.create_index("ix_audit_utc", "audit", ["utc"])
    if op.get_context().dialect.name == "sqlite":
        op.execute(SQLITE_REFUSES.format(action="UPDATE"))
        op.execute(SQLITE_REFUSES.format(action="DELETE"))
    else:
        op.execute(POSTGRES_FUNCTION)
        op.execute(POSTGRES_REFUSES)


def downgrade() -> None:
    op.drop_table("audit")
    if op.get_context().dialect.name != "sqlite":
        op.execute("DROP FUNCTION audit_refuse()")
