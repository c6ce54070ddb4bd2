"""The first tables: site, trackers, journal, shows, recordings and their chunks.

Revision 0001, the first.
"""

import sqlalchemy as sa

from alembic import op

revision = "0001"
down_revision = None

NUMBER = sa.BigInteger().with_variant(sa.Integer(), "sqlite")

SQLITE_REFUSES = """
CREATE TRIGGER events_{action}_refused BEFORE {action} ON events
BEGIN SELECT RAISE(ABORT, 'The journal is only ever appended to.'); END
"""
POSTGRES_FUNCTION = """
CREATE FUNCTION events_refuse() RETURNS trigger LANGUAGE plpgsql AS
$$ BEGIN RAISE EXCEPTION 'The journal is only ever appended to.'; END $$
"""
POSTGRES_REFUSES = """
CREATE TRIGGER events_change_refused BEFORE UPDATE OR DELETE OR TRUNCATE ON events
FOR EACH STATEMENT EXECUTE FUNCTION events_refuse()
"""


def upgrade() -> None:
    op.create_table(
        "site",
        sa.Column("number", sa.Integer(), autoincrement=False, nullable=False),
        sa.Column("document", sa.Text(), nullable=False),
        sa.PrimaryKeyConstraint("number", name="pk_site"),
    )
    op.create_table(
        "trackers",
        sa.Column("number", NUMBER, sa.Identity(), nullable=False),
        sa.Column("tracker_id", sa.String(200), nullable=False),
        sa.Column("document", sa.Text(), nullable=False),
        sa.PrimaryKeyConstraint("number", name="pk_trackers"),
        sa.UniqueConstraint("tracker_id", name="uq_trackers_tracker_id"),
        sqlite_autoincrement=True,
    )
    _create_events()
    _create_shows()
    _create_recordings()


def _create_events() -> None:
    op.create_table(
        "events",
        sa.Column("number", NUMBER, sa.Identity(), nullable=False),
        sa.Column("at", sa.BigInteger(), nullable=False),
        sa.Column("kind", sa.String(50), nullable=False),
        sa.Column("tracker_id", sa.String(200)),
        sa.Column("actor", sa.Text(), nullable=False),
        sa.Column("message", sa.Text(), nullable=False),
        sa.Column("data", sa.Text(), nullable=False),
        sa.PrimaryKeyConstraint("number", name="pk_events"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_events_tracker_id_number", "events", ["tracker_id", "number"])
    op.create_index("ix_events_at", "events", ["at"])
    if op.get_context().dialect.name == "sqlite":
        op.execute(SQLITE_REFUSES.format(action="UPDATE"))
        op.execute(SQLITE_REFUSES.format(action="DELETE"))
    else:
        op.execute(POSTGRES_FUNCTION)
        op.execute(POSTGRES_REFUSES)


def _create_shows() -> None:
    op.create_table(
        "shows",
        sa.Column("number", NUMBER, sa.Identity(), nullable=False),
        sa.Column("show_id", sa.String(200), nullable=False),
        sa.Column("tracker_id", sa.String(200), nullable=False),
        sa.Column("document", sa.Text(), nullable=False),
        sa.PrimaryKeyConstraint("number", name="pk_shows"),
        sa.UniqueConstraint("show_id", name="uq_shows_show_id"),
        sqlite_autoincrement=True,
    )


def _create_recordings() -> None:
    op.create_table(
        "recordings",
        sa.Column("recording_id", sa.String(200), nullable=False),
        sa.Column("kind", sa.String(50), nullable=False),
        sa.Column("tracker_id", sa.String(200), nullable=False),
        sa.Column("began_at", sa.BigInteger(), nullable=False),
        sa.Column("ended_at", sa.BigInteger()),
        sa.Column("outcome", sa.Text(), nullable=False),
        sa.Column("frame_count", sa.Integer(), nullable=False),
        sa.Column("document", sa.Text(), nullable=False),
        sa.PrimaryKeyConstraint("recording_id", name="pk_recordings"),
    )
    op.create_index("ix_recordings_began_at", "recordings", ["began_at"])
    op.create_index("ix_recordings_tracker_id_began_at", "recordings", ["tracker_id", "began_at"])
    op.create_table(
        "chunks",
        sa.Column("recording_id", sa.String(200), nullable=False),
        sa.Column("position", sa.Integer(), autoincrement=False, nullable=False),
        sa.Column("first_elapsed_s", sa.Double(), nullable=False),
        sa.Column("last_elapsed_s", sa.Double(), nullable=False),
        sa.Column("frame_count", sa.Integer(), nullable=False),
        sa.Column("frames", sa.LargeBinary(), nullable=False),
        sa.PrimaryKeyConstraint("recording_id", "position", name="pk_chunks"),
        sa.ForeignKeyConstraint(
            ["recording_id"],
            ["recordings.recording_id"],
            name="fk_chunks_recording_id",
            ondelete="CASCADE",
        ),
    )


def downgrade() -> None:
    for name in ("chunks", "recordings", "shows", "events", "trackers", "site"):
        op.drop_table(name)
    if op.get_context().dialect.name != "sqlite":
        op.execute("DROP FUNCTION events_refuse()")
