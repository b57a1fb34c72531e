"""What the body of each robot is in, and the bay that is its home.

Revises: 0017
"""

import sqlalchemy as sa
from alembic import op

revision = "0018"
down_revision = "0017"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "occupancies",
        sa.Column("robot", sa.String(None), nullable=False),
        sa.Column("kind", sa.String(16), nullable=False),
        sa.Column("place", sa.String(64), nullable=False),
        sa.Column("towards", sa.String(64), nullable=True),
        sa.Column("evidence", sa.String(16), nullable=False),
        sa.Column("way_mm", sa.Integer(), nullable=True),
        sa.Column("at", sa.DateTime(), nullable=False),
        sa.ForeignKeyConstraint(["robot"], ["robots.name"], name=op.f("fk_occupancies_robot_robots")),
        sa.PrimaryKeyConstraint("robot", name=op.f("pk_occupancies")),
    )
    op.add_column("robots", sa.Column("home_bay", sa.String(64), nullable=True))


def downgrade() -> None:
    op.drop_column("robots", "home_bay")
    op.drop_table("occupancies")
