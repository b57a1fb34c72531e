"""Indexes for what is asked often.

Revises: 0006
"""

import sqlalchemy as sa
from alembic import op

revision = "0007"
down_revision = "0006"
branch_labels = None
depends_on = None

ADDED = (
    ("ix_orders_sent", "orders", ["sender_id", "created_at", "id"], None),
    ("ix_orders_coming", "orders", ["recipient_id", "created_at", "id"], None),
    ("ix_orders_newest", "orders", ["created_at", "id"], None),
    ("ix_orders_robot_state", "orders", ["robot", "state"], None),
    ("ix_missions_robot_state", "missions", ["robot", "state"], None),
    ("ix_orders_let_go", "orders", ["let_go_by"], "let_go_by IS NOT NULL"),
    ("ix_missions_untold", "missions", ["state"], "told_update < update_number"),
    ("ix_server_outbox_waiting", "server_outbox", ["robot", "seq"], "acked_at IS NULL"),
    ("ix_robot_commands_unanswered", "robot_commands", ["robot", "answered_at"], None),
    ("ix_grants_held", "grants", ["robot", "cleared_at"], None),
    ("ix_alarms_ringing", "alarms", ["robot", "cleared_at"], None),
    ("ix_notices_unread", "notices", ["person_id"], "read_at IS NULL"),
)
REPLACED = (("orders", "sender_id"), ("orders", "recipient_id"), ("orders", "created_at"), ("orders", "robot"))
REPLACED += (("orders", "let_go_by"),)
REPLACED += tuple((table, "robot") for table in ("missions", "robot_commands", "grants", "alarms"))


def upgrade() -> None:
    for name, table, columns, only in ADDED:
        where = None if only is None else sa.text(only)
        op.create_index(name, table, columns, unique=False, sqlite_where=where, postgresql_where=where)
    for table, column in REPLACED:
        op.drop_index(op.f(f"ix_{table}_{column}"), table_name=table)


def downgrade() -> None:
    for table, column in REPLACED:
        op.create_index(op.f(f"ix_{table}_{column}"), table, [column], unique=False)
    for name, table, _columns, _only in ADDED:
        op.drop_index(name, table_name=table)
