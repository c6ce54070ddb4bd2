"""Template and values of what came of an event, beside the text that its chain covers.

Revision 0002, after 0001.
"""

import sqlalchemy as sa

from alembic import op

revision = "0002"
down_revision = "0001"


def upgrade() -> None:
    op.add_column("access_events", sa.Column("result_parts", sa.Text()))


def downgrade() -> None:
    op.drop_column("access_events", "result_parts")
