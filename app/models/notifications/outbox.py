"""Notices on their way through a channel: written with what they tell of, sent after it."""

from datetime import datetime
from typing import Final

from sqlalchemy import Index, text
from sqlmodel import Field, SQLModel

from app.models.columns import UtcTime

DUE: Final = text("next_try_at IS NOT NULL")
GIVEN_UP: Final = text("gave_up_at IS NOT NULL")


class OutgoingNotification(SQLModel, table=True):
    """`key` names the sending on its channel, so that a second try after a crash is the same sending.

    `target` is the device or address of a channel that has several for one person. `next_try_at` is null once it was
    sent or given up.
    """

    __tablename__ = "outbox"
    # Of the few that wait or were given up, not of all there ever were.
    __table_args__ = (
        Index("ix_outbox_due", "channel", "next_try_at", sqlite_where=DUE, postgresql_where=DUE),
        Index("ix_outbox_given_up", "channel", sqlite_where=GIVEN_UP, postgresql_where=GIVEN_UP),
    )

    id: int | None = Field(default=None, primary_key=True)
    key: str = Field(unique=True, max_length=255)
    channel: str = Field(max_length=32)
    target: str | None = Field(default=None, max_length=64)
    notice_id: int = Field(foreign_key="notices.id", index=True)
    created_at: datetime = Field(sa_type=UtcTime)
    tries: int = 0
    next_try_at: datetime | None = Field(default=None, sa_type=UtcTime)
    sent_at: datetime | None = Field(default=None, sa_type=UtcTime, index=True)
    gave_up_at: datetime | None = Field(default=None, sa_type=UtcTime)
    problem: str | None = Field(default=None, max_length=500)
