"""The settings of a tracker that were accepted last, beside those that are stored.

Revision 0005, after 0004.
"""

import sqlalchemy as sa

from alembic import op

revision = "0005"
down_revision = "0004"


def upgrade() -> None:
    op.add_column("trackers", sa.Column("accepted", sa.Text()))


def downgrade() -> None:
    with op.batch_alter_table("trackers") as table:
        table.drop_column("accepted")
