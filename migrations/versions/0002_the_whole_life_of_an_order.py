"""The whole life of an order.

Revises: 0001
"""

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"
branch_labels = None
depends_on = None

WISHES = ("return_requested_at", "reassign_requested_at", "not_before", "wait_until", "delayed_at")
NAMES = ("let_go_by", "wanted_robot", "avoided_robot", "return_post", "placed_by_id", "standing_order_id")


def upgrade() -> None:
    _standing_orders()
    with op.batch_alter_table("orders", schema=None) as batch_op:
        for name in WISHES:
            batch_op.add_column(sa.Column(name, sa.DateTime(), nullable=True))
        for name in NAMES:
            batch_op.add_column(sa.Column(name, sa.String(64), nullable=True))
        batch_op.add_column(sa.Column("occurs_on", sa.String(10), nullable=True))
        batch_op.add_column(sa.Column("priority", sa.String(32), nullable=False, server_default="normal"))
        batch_op.create_index(batch_op.f("ix_orders_let_go_by"), ["let_go_by"], unique=False)
        batch_op.create_foreign_key(batch_op.f("fk_orders_placed_by_id"), "people", ["placed_by_id"], ["id"])
        batch_op.create_foreign_key(
            batch_op.f("fk_orders_standing_order_id"), "standing_orders", ["standing_order_id"], ["id"]
        )
        batch_op.create_unique_constraint(
            batch_op.f("uq_orders_standing_order_id_occurs_on"), ["standing_order_id", "occurs_on"]
        )
    with op.batch_alter_table("order_events", schema=None) as batch_op:
        batch_op.add_column(sa.Column("kind", sa.String(32), nullable=False, server_default="moved"))
    with op.batch_alter_table("missions", schema=None) as batch_op:
        # What was decided on before this revision was told at once.
        batch_op.add_column(sa.Column("told_update", sa.Integer(), nullable=False, server_default="0"))
        batch_op.add_column(sa.Column("accepted_update", sa.Integer(), nullable=False, server_default="0"))
    op.execute("UPDATE missions SET told_update = update_number")
    op.execute("UPDATE missions SET accepted_update = 1 WHERE accepted_at IS NOT NULL")
    with op.batch_alter_table("stops", schema=None) as batch_op:
        batch_op.add_column(sa.Column("dropped_at", sa.DateTime(), nullable=True))
        batch_op.add_column(sa.Column("since_update", sa.Integer(), nullable=False, server_default="1"))


def _standing_orders() -> None:
    op.create_table(
        "standing_orders",
        sa.Column("id", sa.String(64), nullable=False),
        sa.Column("sender_id", sa.String(64), nullable=False),
        sa.Column("recipient_id", sa.String(64), nullable=False),
        sa.Column("placed_by_id", sa.String(64), nullable=True),
        sa.Column("from_post", sa.String(64), nullable=False),
        sa.Column("to_post", sa.String(64), nullable=False),
        sa.Column("description", sa.String(500), nullable=True),
        sa.Column("priority", sa.String(32), nullable=False),
        sa.Column("weekdays", sa.JSON(), nullable=False),
        sa.Column("at", sa.String(5), nullable=False),
        sa.Column("zone", sa.String(64), nullable=False),
        sa.Column("until", sa.String(10), nullable=True),
        sa.Column("created_at", sa.DateTime(), nullable=False),
        sa.Column("next_at", sa.DateTime(), nullable=True),
        sa.Column("paused_at", sa.DateTime(), nullable=True),
        sa.Column("ended_at", sa.DateTime(), nullable=True),
        sa.Column("why", sa.String(500), nullable=True),
        sa.ForeignKeyConstraint(["placed_by_id"], ["people.id"], name=op.f("fk_standing_orders_placed_by_id")),
        sa.ForeignKeyConstraint(["recipient_id"], ["people.id"], name=op.f("fk_standing_orders_recipient_id")),
        sa.ForeignKeyConstraint(["sender_id"], ["people.id"], name=op.f("fk_standing_orders_sender_id")),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_standing_orders")),
    )
    with op.batch_alter_table("standing_orders", schema=None) as batch_op:
        batch_op.create_index(batch_op.f("ix_standing_orders_next_at"), ["next_at"], unique=False)
        batch_op.create_index(batch_op.f("ix_standing_orders_recipient_id"), ["recipient_id"], unique=False)
        batch_op.create_index(batch_op.f("ix_standing_orders_sender_id"), ["sender_id"], unique=False)


def downgrade() -> None:
    with op.batch_alter_table("stops", schema=None) as batch_op:
        batch_op.drop_column("since_update")
        batch_op.drop_column("dropped_at")
    with op.batch_alter_table("missions", schema=None) as batch_op:
        batch_op.drop_column("accepted_update")
        batch_op.drop_column("told_update")
    with op.batch_alter_table("order_events", schema=None) as batch_op:
        batch_op.drop_column("kind")
    with op.batch_alter_table("orders", schema=None) as batch_op:
        batch_op.drop_constraint(batch_op.f("uq_orders_standing_order_id_occurs_on"), type_="unique")
        batch_op.drop_constraint(batch_op.f("fk_orders_standing_order_id"), type_="foreignkey")
        batch_op.drop_constraint(batch_op.f("fk_orders_placed_by_id"), type_="foreignkey")
        batch_op.drop_index(batch_op.f("ix_orders_let_go_by"))
        for name in (*WISHES, *NAMES):
            batch_op.drop_column(name)
        batch_op.drop_column("occurs_on")
        batch_op.drop_column("priority")
    op.drop_table("standing_orders")
