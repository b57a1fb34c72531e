"""Mail that changes robots half way.

Revises: 0011
"""

import sqlalchemy as sa
from alembic import op

revision = "0012"
down_revision = "0011"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("orders", sa.Column("passed_on_at_post", sa.String(64), nullable=True))


def downgrade() -> None:
    op.drop_column("orders", "passed_on_at_post")
