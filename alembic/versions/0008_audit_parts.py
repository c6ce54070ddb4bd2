"""Template and values of what the audit says came of an order, beside the text that its chain covers.

Revision 0008, after 0007.
"""

import sqlalchemy as sa

from alembic import op

revision = "0008"
down_revision = "0007"


def upgrade() -> None:
    op.add_column("audit", sa.Column("result_parts", sa.Text()))


def downgrade() -> None:
    op.drop_column("audit", "result_parts")
