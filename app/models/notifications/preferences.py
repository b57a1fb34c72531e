"""Preferences of people: what they muted, the devices they named, the address of a program."""

from datetime import datetime

from sqlalchemy import JSON
from sqlmodel import Field, SQLModel

from app.models.columns import UtcTime


class NotificationPreferences(SQLModel, table=True):
    """`muted` has the kinds that a person does not want on a channel; what it does not name is at its default.

    Who has no row has changed nothing.
    """

    __tablename__ = "notice_wishes"

    person_id: str = Field(primary_key=True, foreign_key="people.id")
    muted: dict[str, list[str]] = Field(sa_type=JSON)


class PushSubscription(SQLModel, table=True):
    """A browser that shows notices (Web Push). With its `auth` and `p256dh` a notice is encrypted for it alone."""

    __tablename__ = "push_subscriptions"

    id: str = Field(primary_key=True, max_length=64)
    person_id: str = Field(foreign_key="people.id", index=True)
    endpoint: str = Field(unique=True, max_length=1000)
    p256dh: str = Field(max_length=128)
    auth: str = Field(max_length=32)
    created_at: datetime = Field(sa_type=UtcTime)


class Webhook(SQLModel, table=True):
    """An address that is told of one person's notices. Its secret derives from the server key and `id`."""

    __tablename__ = "webhooks"

    id: str = Field(primary_key=True, max_length=64)
    person_id: str = Field(foreign_key="people.id", unique=True)
    url: str = Field(max_length=1000)
    created_at: datetime = Field(sa_type=UtcTime)
