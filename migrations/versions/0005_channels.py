"""Channels of notices and what people want of them.

Revises: 0004
"""

import sqlalchemy as sa
from alembic import op

revision = "0005"
down_revision = "0004"
branch_labels = None
depends_on = None


def upgrade() -> None:
    _allow_new_copies_of_tables()
    with op.batch_alter_table("notices", schema=None) as batch_op:
        batch_op.add_column(sa.Column("key", sa.String(160), nullable=False, server_default=""))
        batch_op.alter_column("order_id", existing_type=sa.String(None), nullable=True)
    op.execute("UPDATE notices SET key = order_id || '.' || kind")
    with op.batch_alter_table("notices", schema=None) as batch_op:
        batch_op.alter_column("key", existing_type=sa.String(160), server_default=None)
        batch_op.drop_constraint("uq_notices_order_id_kind_person_id", type_="unique")
        batch_op.create_unique_constraint("uq_notices_person_id_key", ["person_id", "key"])
        batch_op.create_index(batch_op.f("ix_notices_order_id"), ["order_id"], unique=False)


def downgrade() -> None:
    _allow_new_copies_of_tables()
    op.execute("DELETE FROM outbox WHERE notice_id IN (SELECT id FROM notices WHERE key <> order_id || '.' || kind)")
    op.execute("DELETE FROM outbox WHERE notice_id IN (SELECT id FROM notices WHERE order_id IS NULL)")
    op.execute("DELETE FROM notices WHERE order_id IS NULL OR key <> order_id || '.' || kind")
    with op.batch_alter_table("notices", schema=None) as batch_op:
        batch_op.drop_index(batch_op.f("ix_notices_order_id"))
        batch_op.drop_constraint("uq_notices_person_id_key", type_="unique")
        batch_op.create_unique_constraint("uq_notices_order_id_kind_person_id", ["order_id", "kind", "person_id"])
        batch_op.alter_column("order_id", existing_type=sa.String(None), nullable=False)
        batch_op.drop_column("key")


def _allow_new_copies_of_tables() -> None:
    """SQLite writes a table anew to change it, and would not drop the old one while others refer to it."""
    if op.get_bind().dialect.name == "sqlite":
        op.execute("PRAGMA defer_foreign_keys=ON")
