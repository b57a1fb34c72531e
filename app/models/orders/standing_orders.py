"""Orders that come again: on these weekdays at this local time, until they are ended."""

from datetime import datetime

from sqlalchemy import JSON
from sqlmodel import Field, SQLModel

from app.models.columns import EnumColumn, UtcTime
from app.models.orders.orders import Priority


class StandingOrder(SQLModel, table=True):
    """`weekdays` count from 0 (Monday); `at` is local time in `zone`, as 09:30; `until` the last local day.

    `next_at` is when its next order is made; None while it is paused and once it has ended.
    """

    __tablename__ = "standing_orders"

    id: str = Field(primary_key=True, max_length=64)
    sender_id: str = Field(foreign_key="people.id", index=True)
    recipient_id: str = Field(foreign_key="people.id", index=True)
    placed_by_id: str | None = Field(default=None, foreign_key="people.id")
    from_post: str = Field(max_length=64)
    to_post: str = Field(max_length=64)
    description: str | None = Field(default=None, max_length=500)
    priority: Priority = Field(default=Priority.NORMAL, sa_type=EnumColumn(Priority))
    weekdays: list[int] = Field(sa_type=JSON)
    at: str = Field(max_length=5)
    zone: str = Field(max_length=64)
    until: str | None = Field(default=None, max_length=10)
    created_at: datetime = Field(sa_type=UtcTime)
    next_at: datetime | None = Field(default=None, sa_type=UtcTime, index=True)
    paused_at: datetime | None = Field(default=None, sa_type=UtcTime)
    ended_at: datetime | None = Field(default=None, sa_type=UtcTime)
    why: str | None = Field(default=None, max_length=500)
