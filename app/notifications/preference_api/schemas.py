"""Preferences over HTTP."""

from datetime import datetime
from typing import Annotated

import httpx
from pydantic import BaseModel, ConfigDict, Field, StringConstraints

from app.models import NotificationKind, PushSubscription, Webhook
from app.notifications.preferences import ChannelName

Url = Annotated[str, StringConstraints(max_length=1000, pattern=r"^[!-~]+$")]
KeyText = Annotated[str, StringConstraints(max_length=128, pattern=r"^[A-Za-z0-9_=-]+$")]


class DeviceView(BaseModel):
    """A browser that shows notices, and whose push service carries them."""

    id: str
    push_service: str
    created_at: datetime

    @classmethod
    def of(cls, row: PushSubscription) -> "DeviceView":
        return cls(id=row.id, push_service=httpx.URL(row.endpoint).host, created_at=row.created_at)


class WebhookView(BaseModel):
    """An address that is told of one's notices."""

    url: str
    created_at: datetime

    @classmethod
    def of(cls, row: Webhook) -> "WebhookView":
        return cls(url=row.url, created_at=row.created_at)


class NewWebhookView(WebhookView):
    """With the secret that signs what it is sent."""

    secret: str


class TrialView(BaseModel):
    """The result of a delivery for trial."""

    is_good: bool = Field(description="Whether the receiver took it: its answer was 2xx.")
    status: int | None = Field(description="What it answered; null: nothing.")
    problem: str | None = Field(description="Why there was no answer.")


class PreferencesView(BaseModel):
    """The preferences of a person. The inbox has everything; `muted` says what a channel does not carry."""

    language: str
    kinds: list[NotificationKind]
    must_reach: list[NotificationKind] = Field(description="Kinds that cannot be muted on every channel.")
    muted: dict[ChannelName, list[NotificationKind]]
    push_key: str = Field(description="`applicationServerKey` for a browser that subscribes.")
    devices: list[DeviceView]
    webhook: WebhookView | None


class PreferencesRequest(BaseModel):
    """Kinds that are not to come on a channel. A channel that is not named stays as it is."""

    model_config = ConfigDict(extra="forbid")

    muted: dict[ChannelName, Annotated[list[NotificationKind], Field(max_length=100)]]


class SubscriptionKeys(BaseModel):
    """The browser's own keys (RFC 8291), URL-safe base64."""

    p256dh: KeyText
    auth: KeyText


class NewDevice(BaseModel):
    """The result of `PushSubscription.toJSON()` in a browser."""

    endpoint: Url
    keys: SubscriptionKeys


class NewWebhook(BaseModel):
    """Where to."""

    model_config = ConfigDict(extra="forbid")

    url: Url
