"""Channels of notices and what people want of them.

Revises: 0004
"""

import sqlalchemy as sa
from alembic import op

revision = "0005"
down_revision = "0004"
branch_labels = None
depends_on = None

NOT_ROUTED = sa.text("routed_at IS NULL")
DUE = sa.text("next_try_at IS NOT NULL")
GIVEN_UP = sa.text("gave_up_at IS NOT NULL")


def upgrade() -> None:
    _name_what_notices_tell()
    _add_wishes()
    with op.batch_alter_table("outbox", schema=None) as batch_op:
        batch_op.add_column(sa.Column("target", sa.String(64), nullable=True))
        batch_op.add_column(sa.Column("gave_up_at", sa.DateTime(), nullable=True))
        batch_op.alter_column("next_try_at", existing_type=sa.DateTime(), nullable=True)
        batch_op.create_index(batch_op.f("ix_outbox_notice_id"), ["notice_id"], unique=False)
        batch_op.create_index(
            "ix_outbox_due", ["channel", "next_try_at"], unique=False, sqlite_where=DUE, postgresql_where=DUE
        )
        batch_op.create_index(
            "ix_outbox_given_up", ["channel"], unique=False, sqlite_where=GIVEN_UP, postgresql_where=GIVEN_UP
        )
    op.execute("UPDATE outbox SET next_try_at = NULL WHERE sent_at IS NOT NULL")


def _name_what_notices_tell() -> None:
    with op.batch_alter_table("notices", schema=None) as batch_op:
        batch_op.add_column(sa.Column("key", sa.String(160), nullable=False, server_default=""))
        batch_op.add_column(sa.Column("routed_at", sa.DateTime(), nullable=True))
        batch_op.alter_column("order_id", existing_type=sa.String(None), nullable=True)
    # What was told so far has been given to its channel with the notice itself.
    op.execute("UPDATE notices SET key = order_id || '.' || kind, routed_at = at")
    with op.batch_alter_table("notices", schema=None) as batch_op:
        batch_op.alter_column("key", existing_type=sa.String(160), server_default=None)
        batch_op.drop_constraint("uq_notices_order_id_kind_person_id", type_="unique")
        batch_op.create_unique_constraint("uq_notices_person_id_key", ["person_id", "key"])
        batch_op.create_index(batch_op.f("ix_notices_order_id"), ["order_id"], unique=False)
        batch_op.create_index(
            "ix_notices_not_routed", ["id"], unique=False, sqlite_where=NOT_ROUTED, postgresql_where=NOT_ROUTED
        )


def _add_wishes() -> None:
    op.create_table(
        "notice_wishes",
        sa.Column("person_id", sa.String(None), nullable=False),
        sa.Column("muted", sa.JSON(), nullable=False),
        sa.ForeignKeyConstraint(["person_id"], ["people.id"], name=op.f("fk_notice_wishes_person_id")),
        sa.PrimaryKeyConstraint("person_id", name=op.f("pk_notice_wishes")),
    )
    op.create_table(
        "push_subscriptions",
        sa.Column("id", sa.String(64), nullable=False),
        sa.Column("person_id", sa.String(None), nullable=False),
        sa.Column("endpoint", sa.String(1000), nullable=False),
        sa.Column("p256dh", sa.String(128), nullable=False),
        sa.Column("auth", sa.String(32), nullable=False),
        sa.Column("created_at", sa.DateTime(), nullable=False),
        sa.ForeignKeyConstraint(["person_id"], ["people.id"], name=op.f("fk_push_subscriptions_person_id")),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_push_subscriptions")),
        sa.UniqueConstraint("endpoint", name=op.f("uq_push_subscriptions_endpoint")),
    )
    with op.batch_alter_table("push_subscriptions", schema=None) as batch_op:
        batch_op.create_index(batch_op.f("ix_push_subscriptions_person_id"), ["person_id"], unique=False)
    op.create_table(
        "webhooks",
        sa.Column("id", sa.String(64), nullable=False),
        sa.Column("person_id", sa.String(None), nullable=False),
        sa.Column("url", sa.String(1000), nullable=False),
        sa.Column("created_at", sa.DateTime(), nullable=False),
        sa.ForeignKeyConstraint(["person_id"], ["people.id"], name=op.f("fk_webhooks_person_id")),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_webhooks")),
        sa.UniqueConstraint("person_id", name=op.f("uq_webhooks_person_id")),
    )


def downgrade() -> None:
    op.drop_table("webhooks")
    with op.batch_alter_table("push_subscriptions", schema=None) as batch_op:
        batch_op.drop_index(batch_op.f("ix_push_subscriptions_person_id"))
    op.drop_table("push_subscriptions")
    op.drop_table("notice_wishes")
    # What the schema before cannot hold: other channels, alarms, later rounds.
    op.execute("DELETE FROM outbox WHERE channel <> 'mail'")
    unknown = "SELECT id FROM notices WHERE order_id IS NULL OR key <> order_id || '.' || kind"
    op.execute(f"DELETE FROM outbox WHERE notice_id IN ({unknown})")  # noqa: S608  # nothing from outside is in it
    op.execute("DELETE FROM notices WHERE order_id IS NULL OR key <> order_id || '.' || kind")
    op.execute("UPDATE outbox SET next_try_at = created_at WHERE next_try_at IS NULL")
    with op.batch_alter_table("outbox", schema=None) as batch_op:
        batch_op.drop_index("ix_outbox_given_up")
        batch_op.drop_index("ix_outbox_due")
        batch_op.drop_index(batch_op.f("ix_outbox_notice_id"))
        batch_op.alter_column("next_try_at", existing_type=sa.DateTime(), nullable=False)
        batch_op.drop_column("gave_up_at")
        batch_op.drop_column("target")
    with op.batch_alter_table("notices", schema=None) as batch_op:
        batch_op.drop_index("ix_notices_not_routed")
        batch_op.drop_index(batch_op.f("ix_notices_order_id"))
        batch_op.drop_constraint("uq_notices_person_id_key", type_="unique")
        batch_op.create_unique_constraint("uq_notices_order_id_kind_person_id", ["order_id", "kind", "person_id"])
        batch_op.alter_column("order_id", existing_type=sa.String(None), nullable=False)
        batch_op.drop_column("routed_at")
        batch_op.drop_column("key")
