"""Commissioning records and their photos: what was signed stays as it was signed.

Revision 0004, after 0003.
"""

import sqlalchemy as sa

from alembic import op

revision = "0004"
down_revision = "0003"

NUMBER = sa.BigInteger().with_variant(sa.Integer(), "sqlite")
SIGNED = "A signed commissioning record stays as it is."

SQLITE_RECORDS = """
CREATE TRIGGER records_{action}_refused BEFORE {action} ON records
BEGIN SELECT RAISE(ABORT, '{signed}'); END
"""
SQLITE_PHOTOS = """
CREATE TRIGGER record_photos_{action}_refused BEFORE {action} ON record_photos
WHEN OLD.record_number IS NOT NULL
BEGIN SELECT RAISE(ABORT, '{signed}'); END
"""
POSTGRES_REFUSE = """
CREATE FUNCTION records_refuse() RETURNS trigger LANGUAGE plpgsql AS
$$ BEGIN RAISE EXCEPTION '{signed}'; END $$
"""
POSTGRES_RECORDS = """
CREATE TRIGGER records_change_refused BEFORE UPDATE OR DELETE OR TRUNCATE ON records
FOR EACH STATEMENT EXECUTE FUNCTION records_refuse()
"""
POSTGRES_PHOTOS = """
CREATE TRIGGER record_photos_change_refused BEFORE UPDATE OR DELETE ON record_photos
FOR EACH ROW WHEN (OLD.record_number IS NOT NULL) EXECUTE FUNCTION records_refuse()
"""


def upgrade() -> None:
    op.create_table(
        "records",
        sa.Column("number", NUMBER, sa.Identity(), nullable=False),
        sa.Column("tracker_id", sa.String(200), nullable=False),
        sa.Column("kept_at", sa.BigInteger(), nullable=False),
        sa.Column("kept_by", sa.Text(), nullable=False),
        sa.Column("digest", sa.String(64), nullable=False),
        sa.Column("document", sa.Text(), nullable=False),
        sa.PrimaryKeyConstraint("number", name="pk_records"),
        sa.UniqueConstraint("digest", name="uq_records_digest"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_records_tracker_id_number", "records", ["tracker_id", "number"])
    op.create_table(
        "record_photos",
        sa.Column("number", NUMBER, sa.Identity(), nullable=False),
        sa.Column("tracker_id", sa.String(200), nullable=False),
        sa.Column("record_number", sa.BigInteger()),
        sa.Column("added_at", sa.BigInteger(), nullable=False),
        sa.Column("added_by", sa.Text(), nullable=False),
        sa.Column("caption", sa.Text(), nullable=False),
        sa.Column("digest", sa.String(64), nullable=False),
        sa.Column("width", sa.Integer(), nullable=False),
        sa.Column("height", sa.Integer(), nullable=False),
        sa.Column("content", sa.LargeBinary(), nullable=False),
        sa.PrimaryKeyConstraint("number", name="pk_record_photos"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_record_photos_tracker_id", "record_photos", ["tracker_id"])
    op.create_index("ix_record_photos_record_number", "record_photos", ["record_number"])
    if op.get_context().dialect.name == "sqlite":
        for action in ("UPDATE", "DELETE"):
            op.execute(SQLITE_RECORDS.format(action=action, signed=SIGNED))
            op.execute(SQLITE_PHOTOS.format(action=action, signed=SIGNED))
    else:
        op.execute(POSTGRES_REFUSE.format(signed=SIGNED))
        op.execute(POSTGRES_RECORDS)
        op.execute(POSTGRES_PHOTOS)


def downgrade() -> None:
    op.drop_table("record_photos")
    op.drop_table("records")
    if op.get_context().dialect.name != "sqlite":
        op.execute("DROP FUNCTION records_refuse()")
