"""Sign-in codes and sessions know the browser that asked.

Revises: 0013
"""

import sqlalchemy as sa
from alembic import op

revision = "0014"
down_revision = "0013"
branch_labels = None
depends_on = None


def upgrade() -> None:
    # Codes that are under way open nothing: they are good for ten minutes, and another is asked for.
    for table in ("sign_in_codes", "sessions"):
        op.add_column(table, sa.Column("browser_hash", sa.String(64), nullable=False, server_default=""))


def downgrade() -> None:
    for table in ("sign_in_codes", "sessions"):
        op.drop_column(table, "browser_hash")
