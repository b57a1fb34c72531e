"""Notices over HTTP and in the event stream."""

from datetime import datetime
from typing import Annotated

from pydantic import BaseModel, Field

from app.core.paging import PageOf
from app.models import Notification, NotificationKind
from app.notifications.wording import body_of, title_of


class NotificationView(BaseModel):
    """One notice in the reader's language; an alarm has no order. Never holds a hand-over code."""

    id: int
    order_id: str | None
    kind: NotificationKind
    title: str
    body: str
    at: datetime
    read: bool

    @classmethod
    def of(cls, notice: Notification, language: str) -> "NotificationView":
        assert notice.id is not None  # noqa: S101  # flushed rows have one
        return cls(
            id=notice.id,
            order_id=notice.order_id,
            kind=NotificationKind(notice.kind),
            title=title_of(notice, language),
            body=body_of(notice, language),
            at=notice.at,
            read=notice.read_at is not None,
        )


class Inbox(PageOf[NotificationView]):
    """The newest notices first; `unread` counts all, not only those shown."""

    unread: int


class NoticesRead(BaseModel):
    """Which notices the person has read."""

    ids: list[Annotated[int, Field(ge=1, le=2**53)]] = Field(max_length=500)
