"""Orders know when they are expected now, beside what was promised.

Revises: 0015
"""

import sqlalchemy as sa
from alembic import op

revision = "0016"
down_revision = "0015"
branch_labels = None
depends_on = None

COLUMNS = ("expected_from", "expected_to", "estimated_at")


def upgrade() -> None:
    for name in COLUMNS:
        op.add_column("orders", sa.Column(name, sa.DateTime(), nullable=True))
    # The window was both until now.
    op.execute("UPDATE orders SET expected_from = window_from, expected_to = window_to, estimated_at = updated_at")


def downgrade() -> None:
    for name in COLUMNS:
        op.drop_column("orders", name)
