"""Claims that wait, corridors that people close, and where robots are at home.

Revises: 0008
"""

import sqlalchemy as sa
from alembic import op

revision = "0009"
down_revision = "0008"
branch_labels = None
depends_on = None

NEW = {
    "claims": (("goal", sa.String(None)),),
    "grants": (("left_at", sa.String(None)),),
    "robots": (("home", sa.String(None)), ("docked", sa.Boolean()), ("waits_for", sa.JSON())),
}


def upgrade() -> None:
    for table, columns in NEW.items():
        for name, kind in columns:
            op.add_column(table, sa.Column(name, kind, nullable=True))
    op.create_table(
        "closed_corridors",
        sa.Column("corridor", sa.String(None), nullable=False),
        sa.Column("closed_at", sa.DateTime(), nullable=False),
        sa.Column("closed_by_id", sa.String(None), nullable=False),
        sa.Column("reason", sa.String(None), nullable=False),
        sa.ForeignKeyConstraint(["closed_by_id"], ["people.id"], name=op.f("fk_closed_corridors_closed_by_id")),
        sa.PrimaryKeyConstraint("corridor", name=op.f("pk_closed_corridors")),
    )
    waiting = sa.text("granted IS NULL")
    op.create_index("ix_claims_waiting", "claims", ["robot"], sqlite_where=waiting, postgresql_where=waiting)


def downgrade() -> None:
    op.drop_index("ix_claims_waiting", "claims")
    op.drop_table("closed_corridors")
    for table, columns in NEW.items():
        for name, _ in columns:
            op.drop_column(table, name)
