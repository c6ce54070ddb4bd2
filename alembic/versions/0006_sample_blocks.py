"""Samples of running recordings as small blocks, until there are enough of them for a chunk.

Revision 0006, after 0005.
"""

import sqlalchemy as sa

from alembic import op

revision = "0006"
down_revision = "0005"

NUMBER = sa.BigInteger().with_variant(sa.Integer(), "sqlite")


def upgrade() -> None:
    op.create_table(
        "sample_blocks",
        sa.Column("number", NUMBER, sa.Identity(), nullable=False),
        sa.Column("recording_id", sa.String(200), nullable=False),
        sa.Column("first_elapsed_s", sa.Double(), nullable=False),
        sa.Column("last_elapsed_s", sa.Double(), nullable=False),
        sa.Column("frame_count", sa.Integer(), nullable=False),
        sa.Column("frames", sa.LargeBinary(), nullable=False),
        sa.PrimaryKeyConstraint("number", name="pk_sample_blocks"),
        sa.ForeignKeyConstraint(
            ["recording_id"],
            ["recordings.recording_id"],
            name="fk_sample_blocks_recording_id",
            ondelete="CASCADE",
        ),
    )


def downgrade() -> None:
    op.drop_table("sample_blocks")
