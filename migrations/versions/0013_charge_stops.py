"""Stops at which robots charge.

Revises: 0012
"""

import sqlalchemy as sa
from alembic import op

revision = "0013"
down_revision = "0012"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("stops", sa.Column("until_ratio", sa.Float(), nullable=True))


def downgrade() -> None:
    op.drop_column("stops", "until_ratio")
