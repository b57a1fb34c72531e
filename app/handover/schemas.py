"""Hand-overs and delegates over HTTP."""

from datetime import datetime
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from app.accounts.schemas import Email
from app.core.paging import PageOf
from app.core.server_key import ServerKey
from app.core.text_lines import Name
from app.handover.my_delegations import NamedDelegate
from app.handover.notifications import post_of
from app.models import Delegate, OrderState
from app.orders.custody.codes import HandoverCode
from app.orders.views.schemas import PartyView
from app.orders.views.views import MyRole, person_view
from protocol.parts import Purpose

PurposeName = Literal["load", "receive", "return"]


class CodeView(BaseModel):
    """A hand-over code: `text` as a QR code for the robot's camera, `digits` to be typed in the app."""

    purpose: PurposeName
    text: str
    digits: str
    digits_locked: bool
    svg_url: str
    expires_at: datetime

    @classmethod
    def of(cls, code: HandoverCode, key: ServerKey, svg_url: str, is_locked: bool) -> "CodeView":
        return cls(
            purpose=code.purpose.value,
            text=code.text(key),
            digits=code.digits(key),
            digits_locked=is_locked,
            svg_url=svg_url,
            expires_at=code.expires_at,
        )


class HandoverRequest(BaseModel):
    """Hand over now. Without digits it is a tap of the person whose turn it is."""

    model_config = ConfigDict(extra="forbid")

    digits: Annotated[
        str, Field(pattern=r"^([0-9]{6})?$", description="The six digits of a code that is good now; empty: a tap.")
    ] = ""


class HandoverAsked(BaseModel):
    """The robot is asked, until `expires_at`. Whether mail changes hands, its receipt says."""

    order_id: str
    purpose: PurposeName
    how: Literal["tap", "digits"]
    at: datetime
    expires_at: datetime


class NewDelegate(BaseModel):
    """A person who hands over instead of the sender or the recipient. `purpose` follows from the one who names them."""

    model_config = ConfigDict(extra="forbid")

    name: Name
    email: Email | None = None
    purpose: PurposeName | None = None


class DelegateView(BaseModel):
    """A delegate; `revoked_at` null: their code is good still."""

    id: str
    name: str
    email: str | None
    purpose: PurposeName
    named_at: datetime
    revoked_at: datetime | None

    @classmethod
    def of(cls, row: Delegate) -> "DelegateView":
        return cls.model_validate(row, from_attributes=True)


class Delegates(PageOf[DelegateView]):
    """The delegates of an order that the caller may see, oldest first."""


class MyDelegateView(BaseModel):
    """A delegate of the caller, whose code is good until `expires_at`: the `post` where they meet the robot, and the
    order."""

    id: str
    name: str
    email: str | None
    purpose: PurposeName
    post: str
    named_at: datetime
    expires_at: datetime
    order_id: str
    state: OrderState
    description: str | None
    sender: PartyView
    recipient: PartyView
    my_role: MyRole

    @classmethod
    def of(cls, named: NamedDelegate) -> "MyDelegateView":
        row, order = named.delegate, named.facts.order
        return cls(
            **DelegateView.of(row).model_dump(exclude={"revoked_at"}),
            post=post_of(order, Purpose(row.purpose)),
            expires_at=order.codes_expire_at,
            order_id=order.id,
            state=order.state,
            description=order.description,
            sender=person_view(named.facts.sender),
            recipient=person_view(named.facts.recipient),
            my_role=named.role,
        )


class MyDelegates(PageOf[MyDelegateView]):
    """Whom the caller has named for orders that go on, newest first."""
