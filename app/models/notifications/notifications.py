"""Notifications: each thing once per person, however often it is reported."""

from datetime import datetime
from enum import StrEnum
from typing import Final

from sqlalchemy import JSON, Index, UniqueConstraint, text
from sqlmodel import Field, SQLModel

from app.models.columns import EnumColumn, UtcTime

NOT_ROUTED: Final = text("routed_at IS NULL")


class NotificationKind(StrEnum):
    """The things that people are told; the words are in the catalogues, under `notice.<kind>`."""

    ACCEPTED = "accepted"
    ROBOT_NEAR = "robot_near"
    ROBOT_HERE = "robot_here"
    ON_ITS_WAY = "on_its_way"
    ROBOT_HERE_FOR_YOU = "robot_here_for_you"
    DELIVERED = "delivered"
    NOT_TAKEN = "not_taken"
    CALLED_BACK = "called_back"
    AT_RETURN = "at_return"
    RETURNED = "returned"
    HELD = "held"
    DELAYED = "delayed"
    CANCELLED = "cancelled"
    EXPIRED = "expired"
    ATTENTION = "attention"
    ALARM = "alarm"
    DELEGATED = "delegated"
    DELEGATION_OVER = "delegation_over"


class Notification(SQLModel, table=True):
    """`facts` fill the text's gaps (post titles, names, the window); a hand-over code is never among them.

    `key` names the thing that is told: the order, the kind and, for what may happen again after a person had to see to
    it, the round. An alarm has no order. `routed_at` is null until the channels have it (`outbox`) and its reader's
    open pages.
    """

    __tablename__ = "notices"
    __table_args__ = (
        UniqueConstraint("person_id", "key"),
        # Of the few that wait, not of all there ever were.
        Index("ix_notices_not_routed", "id", sqlite_where=NOT_ROUTED, postgresql_where=NOT_ROUTED),
    )

    id: int | None = Field(default=None, primary_key=True)
    key: str = Field(max_length=160)
    order_id: str | None = Field(default=None, foreign_key="orders.id", index=True)
    kind: NotificationKind = Field(sa_type=EnumColumn(NotificationKind))
    person_id: str = Field(foreign_key="people.id", index=True)
    at: datetime = Field(sa_type=UtcTime)
    facts: dict[str, str] = Field(sa_type=JSON)
    read_at: datetime | None = Field(default=None, sa_type=UtcTime)
    routed_at: datetime | None = Field(default=None, sa_type=UtcTime)
