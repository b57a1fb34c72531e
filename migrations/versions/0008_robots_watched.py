"""Battery samples of robots.

Revises: 0007
"""

import sqlalchemy as sa
from alembic import op

revision = "0008"
down_revision = "0007"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "battery_samples",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("robot", sa.String(None), nullable=False),
        sa.Column("at", sa.DateTime(), nullable=False),
        sa.Column("ratio", sa.Float(), nullable=False),
        sa.Column("charging", sa.Boolean(), nullable=False),
        sa.ForeignKeyConstraint(["robot"], ["robots.name"], name=op.f("fk_battery_samples_robot")),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_battery_samples")),
    )
    op.create_index("ix_battery_samples_robot_at", "battery_samples", ["robot", "at"], unique=False)
    op.create_index(op.f("ix_battery_samples_at"), "battery_samples", ["at"], unique=False)


def downgrade() -> None:
    op.drop_table("battery_samples")
