"""Hand-overs, delegates, enrolment by one-time code, commands to robots.

Revises: 0002
"""

import sqlalchemy as sa
from alembic import op

revision = "0003"
down_revision = "0002"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "enrolment_codes",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("robot", sa.String(64), nullable=False),
        sa.Column("code_hash", sa.String(64), nullable=False),
        sa.Column("made_by_id", sa.String(None), nullable=True),
        sa.Column("created_at", sa.DateTime(), nullable=False),
        sa.Column("expires_at", sa.DateTime(), nullable=False),
        sa.Column("tries_left", sa.Integer(), nullable=False),
        sa.Column("used_at", sa.DateTime(), nullable=True),
        sa.ForeignKeyConstraint(["made_by_id"], ["people.id"], name=op.f("fk_enrolment_codes_made_by_id")),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_enrolment_codes")),
    )
    with op.batch_alter_table("enrolment_codes", schema=None) as batch_op:
        batch_op.create_index(batch_op.f("ix_enrolment_codes_robot"), ["robot"], unique=False)

    op.create_table(
        "refused_receipts",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("robot", sa.String(None), nullable=False),
        sa.Column("order_id", sa.String(64), nullable=False),
        sa.Column("stop_id", sa.String(64), nullable=False),
        sa.Column("purpose", sa.String(16), nullable=False),
        sa.Column("post", sa.String(64), nullable=False),
        sa.Column("code_sha256", sa.String(64), nullable=True),
        sa.Column("how", sa.String(16), nullable=False),
        sa.Column("command_id", sa.String(64), nullable=True),
        sa.Column("signature", sa.String(100), nullable=True),
        sa.Column("robot_at", sa.DateTime(), nullable=False),
        sa.Column("at", sa.DateTime(), nullable=False),
        sa.Column("problem", sa.String(64), nullable=False),
        sa.ForeignKeyConstraint(["robot"], ["robots.name"], name=op.f("fk_refused_receipts_robot")),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_refused_receipts")),
    )
    with op.batch_alter_table("refused_receipts", schema=None) as batch_op:
        batch_op.create_index(batch_op.f("ix_refused_receipts_order_id"), ["order_id"], unique=False)

    op.create_table(
        "delegates",
        sa.Column("id", sa.String(64), nullable=False),
        sa.Column("order_id", sa.String(None), nullable=False),
        sa.Column("purpose", sa.String(16), nullable=False),
        sa.Column("name", sa.String(200), nullable=False),
        sa.Column("email", sa.String(320), nullable=True),
        sa.Column("named_by_id", sa.String(None), nullable=False),
        sa.Column("named_at", sa.DateTime(), nullable=False),
        sa.Column("revoked_at", sa.DateTime(), nullable=True),
        sa.ForeignKeyConstraint(["named_by_id"], ["people.id"], name=op.f("fk_delegates_named_by_id")),
        sa.ForeignKeyConstraint(["order_id"], ["orders.id"], name=op.f("fk_delegates_order_id")),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_delegates")),
    )
    with op.batch_alter_table("delegates", schema=None) as batch_op:
        batch_op.create_index(batch_op.f("ix_delegates_order_id"), ["order_id"], unique=False)

    op.create_table(
        "digit_locks",
        sa.Column("order_id", sa.String(None), nullable=False),
        sa.Column("wrong_tries", sa.Integer(), nullable=False),
        sa.Column("locked_at", sa.DateTime(), nullable=True),
        sa.ForeignKeyConstraint(["order_id"], ["orders.id"], name=op.f("fk_digit_locks_order_id")),
        sa.PrimaryKeyConstraint("order_id", name=op.f("pk_digit_locks")),
    )
    op.create_table(
        "robot_commands",
        sa.Column("command_id", sa.String(64), nullable=False),
        sa.Column("robot", sa.String(None), nullable=False),
        sa.Column("kind", sa.String(32), nullable=False),
        sa.Column("order_id", sa.String(None), nullable=True),
        sa.Column("asked_by_id", sa.String(None), nullable=True),
        sa.Column("asked_at", sa.DateTime(), nullable=False),
        sa.Column("how", sa.String(16), nullable=True),
        sa.Column("code_sha256", sa.String(64), nullable=True),
        sa.Column("answered_at", sa.DateTime(), nullable=True),
        sa.Column("accepted", sa.Boolean(), nullable=True),
        sa.Column("reason", sa.String(500), nullable=True),
        sa.ForeignKeyConstraint(["asked_by_id"], ["people.id"], name=op.f("fk_robot_commands_asked_by_id")),
        sa.ForeignKeyConstraint(["order_id"], ["orders.id"], name=op.f("fk_robot_commands_order_id")),
        sa.ForeignKeyConstraint(["robot"], ["robots.name"], name=op.f("fk_robot_commands_robot")),
        sa.PrimaryKeyConstraint("command_id", name=op.f("pk_robot_commands")),
    )
    with op.batch_alter_table("robot_commands", schema=None) as batch_op:
        batch_op.create_index(batch_op.f("ix_robot_commands_order_id"), ["order_id"], unique=False)
        batch_op.create_index(batch_op.f("ix_robot_commands_robot"), ["robot"], unique=False)

    with op.batch_alter_table("alarms", schema=None) as batch_op:
        batch_op.add_column(sa.Column("acknowledged_at", sa.DateTime(), nullable=True))
        batch_op.add_column(sa.Column("acknowledged_by_id", sa.String(None), nullable=True))
        batch_op.create_foreign_key(
            batch_op.f("fk_alarms_acknowledged_by_id"), "people", ["acknowledged_by_id"], ["id"]
        )

    with op.batch_alter_table("handovers", schema=None) as batch_op:
        batch_op.add_column(sa.Column("how", sa.String(16), nullable=False, server_default="code"))
        batch_op.add_column(sa.Column("holder", sa.String(16), nullable=True))
        batch_op.add_column(sa.Column("person_id", sa.String(None), nullable=True))
        batch_op.add_column(sa.Column("delegate_id", sa.String(None), nullable=True))
        batch_op.add_column(sa.Column("command_id", sa.String(64), nullable=True))
        batch_op.add_column(sa.Column("signature", sa.String(100), nullable=True))
        batch_op.create_foreign_key(batch_op.f("fk_handovers_delegate_id"), "delegates", ["delegate_id"], ["id"])
        batch_op.create_foreign_key(batch_op.f("fk_handovers_person_id"), "people", ["person_id"], ["id"])

    with op.batch_alter_table("robots", schema=None) as batch_op:
        batch_op.add_column(sa.Column("public_key", sa.String(64), nullable=True))
        batch_op.add_column(sa.Column("takes_confirm", sa.Boolean(), nullable=False, server_default=sa.false()))
        batch_op.add_column(sa.Column("clock_off_s", sa.Float(), nullable=False, server_default="0"))


def downgrade() -> None:
    # In place: others refer to this table, which SQLite could not drop to write it anew.
    with op.batch_alter_table("robots", schema=None, recreate="never") as batch_op:
        batch_op.drop_column("clock_off_s")
        batch_op.drop_column("takes_confirm")
        batch_op.drop_column("public_key")

    with op.batch_alter_table("handovers", schema=None) as batch_op:
        batch_op.drop_constraint(batch_op.f("fk_handovers_person_id"), type_="foreignkey")
        batch_op.drop_constraint(batch_op.f("fk_handovers_delegate_id"), type_="foreignkey")
        batch_op.drop_column("signature")
        batch_op.drop_column("command_id")
        batch_op.drop_column("delegate_id")
        batch_op.drop_column("person_id")
        batch_op.drop_column("holder")
        batch_op.drop_column("how")

    with op.batch_alter_table("alarms", schema=None) as batch_op:
        batch_op.drop_constraint(batch_op.f("fk_alarms_acknowledged_by_id"), type_="foreignkey")
        batch_op.drop_column("acknowledged_by_id")
        batch_op.drop_column("acknowledged_at")

    with op.batch_alter_table("robot_commands", schema=None) as batch_op:
        batch_op.drop_index(batch_op.f("ix_robot_commands_robot"))
        batch_op.drop_index(batch_op.f("ix_robot_commands_order_id"))

    op.drop_table("robot_commands")
    op.drop_table("digit_locks")
    with op.batch_alter_table("delegates", schema=None) as batch_op:
        batch_op.drop_index(batch_op.f("ix_delegates_order_id"))

    op.drop_table("delegates")
    with op.batch_alter_table("refused_receipts", schema=None) as batch_op:
        batch_op.drop_index(batch_op.f("ix_refused_receipts_order_id"))

    op.drop_table("refused_receipts")
    with op.batch_alter_table("enrolment_codes", schema=None) as batch_op:
        batch_op.drop_index(batch_op.f("ix_enrolment_codes_robot"))

    op.drop_table("enrolment_codes")
