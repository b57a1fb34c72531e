"""Robots whose corridors were given to others, and by which command.

Revises: 0010
"""

import sqlalchemy as sa
from alembic import op

revision = "0011"
down_revision = "0010"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("robots", sa.Column("taken_out_at", sa.DateTime(), nullable=True))
    op.add_column("robot_commands", sa.Column("asked_because", sa.String(None), nullable=True))
    op.add_column("grants", sa.Column("freed_by", sa.String(None), nullable=True))
    ringing = sa.text("cleared_at IS NULL")
    op.create_index("ix_alarms_named", "alarms", ["name"], sqlite_where=ringing, postgresql_where=ringing)


def downgrade() -> None:
    op.drop_index("ix_alarms_named", "alarms")
    op.drop_column("grants", "freed_by")
    op.drop_column("robot_commands", "asked_because")
    op.drop_column("robots", "taken_out_at")
