"""One item from a sender to a recipient, and how far it has come."""

from datetime import datetime
from enum import StrEnum

from sqlalchemy import UniqueConstraint
from sqlmodel import Field, SQLModel

from app.models.columns import EnumColumn, UtcTime


class OrderState(StrEnum):
    """Where an order stands; which may follow which is `app/orders/transitions.py`."""

    QUEUED = "queued"
    ASSIGNED = "assigned"
    TO_SENDER = "to_sender"
    AT_SENDER = "at_sender"
    CARRYING = "carrying"
    AT_RECIPIENT = "at_recipient"
    DELIVERED = "delivered"
    RETURNING = "returning"
    AT_RETURN = "at_return"
    RETURNED = "returned"
    HELD = "held"
    EXPIRED = "expired"
    CANCELLED = "cancelled"
    ATTENTION = "attention"


class Priority(StrEnum):
    """Priorities: how much sooner than others an order is fetched."""

    LOW = "low"
    NORMAL = "normal"
    HIGH = "high"


class Order(SQLModel, table=True):
    """`version` grows by one with every change and is the ETag; `state_before_attention` is where a fault struck.

    Dispatch leaves it alone until `not_before`. `placed_by_id` is who placed it for the sender. `return_post` is where
    mail that was not taken goes, `wait_until` how long the robot waits at the present stop. `…_requested_at` are wishes
    that take effect on the robot's word; `let_go_by` is a robot that is still to be told to drop this order.
    `occurs_on` is the day of its standing order (local, as 2026-01-05). `passed_on_at_post` is where staff of the
    mailroom has the mail in hand for its next leg with another robot.
    `window_…` is the arrival that was promised, `expected_…` the one expected now, worked out at `estimated_at`; they
    are null while no time is known.
    """

    __tablename__ = "orders"
    __table_args__ = (UniqueConstraint("standing_order_id", "occurs_on"),)

    id: str = Field(primary_key=True, max_length=64)
    state: OrderState = Field(default=OrderState.QUEUED, sa_type=EnumColumn(OrderState), index=True)
    version: int = 1
    sender_id: str = Field(foreign_key="people.id")
    recipient_id: str = Field(foreign_key="people.id")
    from_post: str = Field(max_length=64)
    to_post: str = Field(max_length=64)
    description: str | None = Field(default=None, max_length=500)
    created_at: datetime = Field(sa_type=UtcTime)
    updated_at: datetime = Field(sa_type=UtcTime)
    codes_expire_at: datetime = Field(sa_type=UtcTime)
    window_from: datetime | None = Field(default=None, sa_type=UtcTime)
    window_to: datetime | None = Field(default=None, sa_type=UtcTime)
    window_assumed: bool = True
    expected_from: datetime | None = Field(default=None, sa_type=UtcTime)
    expected_to: datetime | None = Field(default=None, sa_type=UtcTime)
    estimated_at: datetime | None = Field(default=None, sa_type=UtcTime)
    robot: str | None = Field(default=None, foreign_key="robots.name")
    why: str | None = Field(default=None, max_length=500)
    state_before_attention: OrderState | None = Field(default=None, sa_type=EnumColumn(OrderState))
    cancel_requested_at: datetime | None = Field(default=None, sa_type=UtcTime)
    cancel_requested_by: str | None = Field(default=None, max_length=32)
    return_requested_at: datetime | None = Field(default=None, sa_type=UtcTime)
    reassign_requested_at: datetime | None = Field(default=None, sa_type=UtcTime)
    let_go_by: str | None = Field(default=None, max_length=64)
    wanted_robot: str | None = Field(default=None, max_length=64)
    avoided_robot: str | None = Field(default=None, max_length=64)
    priority: Priority = Field(default=Priority.NORMAL, sa_type=EnumColumn(Priority))
    not_before: datetime | None = Field(default=None, sa_type=UtcTime)
    placed_by_id: str | None = Field(default=None, foreign_key="people.id")
    standing_order_id: str | None = Field(default=None, foreign_key="standing_orders.id")
    occurs_on: str | None = Field(default=None, max_length=10)
    return_post: str | None = Field(default=None, max_length=64)
    wait_until: datetime | None = Field(default=None, sa_type=UtcTime)
    delayed_at: datetime | None = Field(default=None, sa_type=UtcTime)
    passed_on_at_post: str | None = Field(default=None, max_length=64)

    @property
    def is_passed_on(self) -> bool:
        """One robot has carried it, a person has taken it out, and another robot carries it further."""
        return self.passed_on_at_post is not None

    @property
    def load_post(self) -> str:
        """Where a robot loads it: at its sender's, or where another robot has left it."""
        return self.passed_on_at_post or self.from_post
