"""The first tables of access: users, sessions, tokens, wrong passwords, events.

Revision 0001, the first.
"""

import sqlalchemy as sa

from alembic import op

revision = "0001"
down_revision = None

NUMBER = sa.BigInteger().with_variant(sa.Integer(), "sqlite")

SQLITE_REFUSES = """
CREATE TRIGGER access_events_{action}_refused BEFORE {action} ON access_events
BEGIN SELECT RAISE(ABORT, 'Access events are only ever appended.'); END
"""
POSTGRES_FUNCTION = """
CREATE FUNCTION access_events_refuse() RETURNS trigger LANGUAGE plpgsql AS
$$ BEGIN RAISE EXCEPTION 'Access events are only ever appended.'; END $$
"""
POSTGRES_REFUSES = """
CREATE TRIGGER access_events_change_refused BEFORE UPDATE OR DELETE OR TRUNCATE ON access_events
FOR EACH STATEMENT EXECUTE FUNCTION access_events_refuse()
"""


def upgrade() -> None:
    _create_people()
    _create_tokens()
    op.create_table(
        "access_failures",
        sa.Column("subject", sa.String(120), nullable=False),
        sa.Column("count", sa.Integer(), nullable=False),
        sa.Column("last_at", sa.BigInteger(), nullable=False),
        sa.PrimaryKeyConstraint("subject", name="pk_access_failures"),
    )
    op.create_table(
        "access_meta",
        sa.Column("name", sa.String(20), nullable=False),
        sa.Column("value", sa.Text(), nullable=False),
        sa.PrimaryKeyConstraint("name", name="pk_access_meta"),
    )
    _create_events()


def _create_people() -> None:
    op.create_table(
        "access_users",
        sa.Column("name", sa.String(32), nullable=False),
        sa.Column("roles", sa.String(100), nullable=False),
        sa.Column("password_hash", sa.Text(), nullable=False),
        sa.Column("created_at", sa.BigInteger(), nullable=False),
        sa.Column("changed_at", sa.BigInteger(), nullable=False),
        sa.PrimaryKeyConstraint("name", name="pk_access_users"),
    )
    op.create_table(
        "access_sessions",
        sa.Column("digest", sa.String(64), nullable=False),
        sa.Column("user", sa.String(32), nullable=False),
        sa.Column("token_id", sa.String(16), nullable=False),
        sa.Column("address", sa.String(64), nullable=False),
        sa.Column("agent", sa.String(120), nullable=False),
        sa.Column("began_at", sa.BigInteger(), nullable=False),
        sa.Column("used_at", sa.BigInteger(), nullable=False),
        sa.Column("proven_at", sa.BigInteger(), nullable=False),
        sa.Column("stepped_until", sa.BigInteger()),
        sa.PrimaryKeyConstraint("digest", name="pk_access_sessions"),
    )


def _create_tokens() -> None:
    op.create_table(
        "access_tokens",
        sa.Column("token_id", sa.String(16), nullable=False),
        sa.Column("name", sa.String(64), nullable=False),
        sa.Column("owner", sa.String(32), nullable=False),
        sa.Column("digest", sa.String(64), nullable=False),
        sa.Column("scopes", sa.String(100), nullable=False),
        sa.Column("trackers", sa.Text()),
        sa.Column("created_at", sa.BigInteger(), nullable=False),
        sa.Column("expires_at", sa.BigInteger(), nullable=False),
        sa.Column("used_at", sa.BigInteger()),
        sa.Column("pin_hash", sa.Text(), nullable=False),
        sa.PrimaryKeyConstraint("token_id", name="pk_access_tokens"),
    )


def _create_events() -> None:
    op.create_table(
        "access_events",
        sa.Column("number", NUMBER, sa.Identity(), nullable=False),
        sa.Column("at", sa.BigInteger(), nullable=False),
        sa.Column("actor", sa.String(100), nullable=False),
        sa.Column("via", sa.String(20), nullable=False),
        sa.Column("address", sa.String(64), nullable=False),
        sa.Column("action", sa.String(50), nullable=False),
        sa.Column("object", sa.String(100), nullable=False),
        sa.Column("result", sa.Text(), nullable=False),
        sa.Column("prev_hash", sa.String(64), nullable=False),
        sa.Column("hash", sa.String(64), nullable=False),
        sa.PrimaryKeyConstraint("number", name="pk_access_events"),
        sqlite_autoincrement=True,
    )
    if op.get_context().dialect.name == "sqlite":
        op.execute(SQLITE_REFUSES.format(action="UPDATE"))
        op.execute(SQLITE_REFUSES.format(action="DELETE"))
    else:
        op.execute(POSTGRES_FUNCTION)
        op.execute(POSTGRES_REFUSES)


def downgrade() -> None:
    for name in ("events", "meta", "failures", "tokens", "sessions", "users"):
        op.drop_table(f"access_{name}")
    if op.get_context().dialect.name != "sqlite":
        op.execute("DROP FUNCTION access_events_refuse()")
