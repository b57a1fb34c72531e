"""Notices on their way through a channel: written with the change itself, sent after it."""

from datetime import datetime

from sqlmodel import Field, SQLModel

from app.tables.columns import UtcTime


class OutgoingNotice(SQLModel, table=True):
    """`key` names the sending on its channel, so that a second try after a crash is the same sending."""

    __tablename__ = "outbox"

    id: int | None = Field(default=None, primary_key=True)
    key: str = Field(unique=True, max_length=255)
    channel: str = Field(max_length=32)
    notice_id: int = Field(foreign_key="notices.id")
    created_at: datetime = Field(sa_type=UtcTime)
    tries: int = 0
    next_try_at: datetime = Field(sa_type=UtcTime)
    sent_at: datetime | None = Field(default=None, sa_type=UtcTime, index=True)
    problem: str | None = Field(default=None, max_length=500)
