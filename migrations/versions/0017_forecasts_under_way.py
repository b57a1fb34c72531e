"""Promised arrivals of orders that a robot has, and what came of them.

Revises: 0016
"""

import sqlalchemy as sa
from alembic import op

revision = "0017"
down_revision = "0016"
branch_labels = None
depends_on = None

QUANTILES = [f"{whose}_{share}_s" for whose in ("raw", "told", "map") for share in ("p10", "p50", "p90")]


def upgrade() -> None:
    op.create_table(
        "forecasts_under_way",
        sa.Column("order_id", sa.String(None), nullable=False),
        sa.Column("is_aboard", sa.Boolean(), nullable=False),
        sa.Column("told_at", sa.DateTime(), nullable=False),
        *(sa.Column(name, sa.Float(), nullable=False) for name in QUANTILES),
        sa.Column("arrived_at", sa.DateTime(), nullable=True),
        sa.PrimaryKeyConstraint("order_id", "is_aboard", name=op.f("pk_forecasts_under_way")),
    )
    for name in ("told_at", "arrived_at"):
        op.create_index(op.f(f"ix_forecasts_under_way_{name}"), "forecasts_under_way", [name], unique=False)


def downgrade() -> None:
    op.drop_table("forecasts_under_way")
