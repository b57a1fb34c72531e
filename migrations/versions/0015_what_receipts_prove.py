"""Hand-overs know what they go by, and robots since when they prove that a code was shown.

Revises: 0014
"""

import sqlalchemy as sa
from alembic import op

revision = "0015"
down_revision = "0014"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("handovers", sa.Column("evidence", sa.String(16), nullable=False, server_default="digest"))
    # Until now a receipt for a code repeated what the robot had been told; one without any was the button's.
    op.execute("UPDATE handovers SET evidence = how WHERE how != 'code'")
    op.execute("UPDATE handovers SET evidence = 'button' WHERE how = 'code' AND code_sha256 IS NULL")
    op.add_column("handovers", sa.Column("problem", sa.String(64), nullable=True))
    op.add_column("handovers", sa.Column("settled", sa.String(16), nullable=True))
    op.create_index("ix_handovers_robot", "handovers", ["robot"])
    op.add_column("robots", sa.Column("proves_since", sa.DateTime(), nullable=True))


def downgrade() -> None:
    op.drop_column("robots", "proves_since")
    op.drop_index("ix_handovers_robot", "handovers")
    for column in ("settled", "problem", "evidence"):
        op.drop_column("handovers", column)
