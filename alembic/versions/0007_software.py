"""Which version wrote the database last: an older one leaves it alone although the tables are its own.

Revision 0007, after 0006.
"""

import sqlalchemy as sa

from alembic import op

revision = "0007"
down_revision = "0006"


def upgrade() -> None:
    op.create_table(
        "software",
        sa.Column("number", sa.Integer(), autoincrement=False, nullable=False),
        sa.Column("version", sa.String(50), nullable=False),
        sa.PrimaryKeyConstraint("number", name="pk_software"),
    )


def downgrade() -> None:
    op.drop_table("software")
