"""One item from a sender to a recipient, and how far it has come."""

from datetime import datetime
from enum import StrEnum

from sqlmodel import Field, SQLModel

from app.tables.columns import UtcTime, WordOf


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


class Order(SQLModel, table=True):
    """`version` grows by one with every change and is the ETag; `state_before_attention` is where a fault struck."""

    __tablename__ = "orders"

    id: str = Field(primary_key=True, max_length=64)
    state: OrderState = Field(default=OrderState.QUEUED, sa_type=WordOf(OrderState), index=True)
    version: int = 1
    sender_id: str = Field(foreign_key="people.id", index=True)
    recipient_id: str = Field(foreign_key="people.id", index=True)
    from_post: str = Field(max_length=64)
    to_post: str = Field(max_length=64)
    description: str | None = Field(default=None, max_length=500)
    created_at: datetime = Field(sa_type=UtcTime, index=True)
    updated_at: datetime = Field(sa_type=UtcTime)
    codes_expire_at: datetime = Field(sa_type=UtcTime)
    window_from: datetime | None = Field(default=None, sa_type=UtcTime)
    window_to: datetime | None = Field(default=None, sa_type=UtcTime)
    window_assumed: bool = True
    robot: str | None = Field(default=None, foreign_key="robots.name", index=True)
    why: str | None = Field(default=None, max_length=500)
    state_before_attention: OrderState | None = Field(default=None, sa_type=WordOf(OrderState))
    cancel_requested_at: datetime | None = Field(default=None, sa_type=UtcTime)
    cancel_requested_by: str | None = Field(default=None, max_length=32)
