"""Durations, and promised arrivals.

Revises: 0009
"""

import sqlalchemy as sa
from alembic import op

revision = "0010"
down_revision = "0009"
branch_labels = None
depends_on = None

QUANTILES = [f"{whose}_{share}_s" for whose in ("raw", "told", "map") for share in ("p10", "p50", "p90")]


def upgrade() -> None:
    op.create_table(
        "durations",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("kind", sa.String(None), nullable=False),
        sa.Column("name", sa.String(None), nullable=False),
        sa.Column("assumed_s", sa.Float(), nullable=False),
        sa.Column("seconds", sa.Float(), nullable=False),
        sa.Column("at", sa.DateTime(), nullable=False),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_durations")),
    )
    op.create_index(op.f("ix_durations_at"), "durations", ["at"], unique=False)
    op.create_table(
        "forecasts",
        sa.Column("order_id", sa.String(None), nullable=False),
        sa.Column("begins_at", sa.DateTime(), nullable=False),
        *(sa.Column(name, sa.Float(), nullable=False) for name in QUANTILES),
        sa.Column("fetch_name", sa.String(None), nullable=False),
        sa.Column("fetch_assumed_s", sa.Float(), nullable=False),
        sa.Column("arrived_at", sa.DateTime(), nullable=True),
        sa.PrimaryKeyConstraint("order_id", name=op.f("pk_forecasts")),
    )
    op.create_index(op.f("ix_forecasts_begins_at"), "forecasts", ["begins_at"], unique=False)
    op.create_index(op.f("ix_forecasts_arrived_at"), "forecasts", ["arrived_at"], unique=False)


def downgrade() -> None:
    op.drop_table("forecasts")
    op.drop_table("durations")
