"""What people are told: each thing once per order, kind and person, however often it is reported."""

from datetime import datetime
from enum import StrEnum

from sqlalchemy import JSON, UniqueConstraint
from sqlmodel import Field, SQLModel

from app.tables.columns import UtcTime, WordOf


class NoticeKind(StrEnum):
    """The things that people are told; the words are in `app/notify/texts`."""

    ACCEPTED = "accepted"
    ROBOT_NEAR = "robot_near"
    ROBOT_HERE = "robot_here"
    ON_ITS_WAY = "on_its_way"
    ROBOT_HERE_FOR_YOU = "robot_here_for_you"
    DELIVERED = "delivered"
    CANCELLED = "cancelled"
    EXPIRED = "expired"


class Notice(SQLModel, table=True):
    """`facts` fill the text's gaps (post titles, names, the window); a hand-over code is never among them."""

    __tablename__ = "notices"
    __table_args__ = (UniqueConstraint("order_id", "kind", "person_id"),)

    id: int | None = Field(default=None, primary_key=True)
    order_id: str = Field(foreign_key="orders.id")
    kind: NoticeKind = Field(sa_type=WordOf(NoticeKind))
    person_id: str = Field(foreign_key="people.id", index=True)
    at: datetime = Field(sa_type=UtcTime)
    facts: dict[str, str] = Field(sa_type=JSON)
    read_at: datetime | None = Field(default=None, sa_type=UtcTime)
