"""Orders over HTTP and in the event stream."""

from datetime import UTC, date, datetime
from typing import Annotated, Literal
from zoneinfo import available_timezones

from pydantic import AwareDatetime, BaseModel, ConfigDict, Field, StringConstraints, field_validator

from app.accounts.schemas import Email
from app.core.paging import PageOf
from app.core.text_lines import Text
from app.core.texts.reasons import Words
from app.models import OrderState, Priority
from app.orders.custody.custody import CustodyLink
from app.orders.views.estimate import EstimateView
from app.orders.views.robot_view import RobotView
from app.orders.window import Window

PostName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z][A-Za-z0-9_]*$", max_length=64)]


EmailOfSomebody = Annotated[
    Email | None,
    Field(description="For dispatchers: whose order this is, if not the dispatcher's own (a walk-up order)."),
]
LaterMoment = Annotated[AwareDatetime, Field(ge=datetime(2020, 1, 1, tzinfo=UTC), lt=datetime(2100, 1, 1, tzinfo=UTC))]


class OrderRequest(BaseModel):
    """A request to carry mail: from where to where and to whom."""

    model_config = ConfigDict(extra="forbid")

    from_post: PostName
    to_post: PostName
    recipient: Email
    description: Text | None = None
    priority: Annotated[Priority, Field(description="`high` is for dispatchers.")] = Priority.NORMAL
    on_behalf_of: EmailOfSomebody = None

    @property
    def addresses(self) -> set[str]:
        """Of whom something has to be known."""
        return {self.recipient, self.on_behalf_of or self.recipient}


class NewOrder(OrderRequest):
    """The content of the order form."""

    not_before: Annotated[LaterMoment | None, Field(description="Not to be fetched before this.")] = None


class NewStandingOrder(OrderRequest):
    """An order that comes again on some weekdays (0 is Monday) at a local time, until a last local day or for ever."""

    weekdays: Annotated[list[Annotated[int, Field(ge=0, le=6)]], Field(min_length=1, max_length=7)]
    at: Annotated[str, StringConstraints(pattern=r"^([01][0-9]|2[0-3]):[0-5][0-9]$")]
    zone: Annotated[str, StringConstraints(max_length=64), Field(description="Such as America/Toronto.")]
    until: date | None = None

    @field_validator("zone")
    @classmethod
    def _zone_is_known(cls, name: str) -> str:
        if name not in available_timezones():
            raise ValueError(f"there is no time zone {name!r}; zones are named like America/Toronto")
        return name


class StandingOrderView(BaseModel):
    """A standing order. `next_at` is when its next order is made: null while it is paused, and once it has ended."""

    id: str
    from_post: str
    to_post: str
    sender: "PartyView"
    recipient: "PartyView"
    description: str | None
    priority: Literal["low", "normal", "high"]
    weekdays: list[int]
    at: str
    zone: str
    until: date | None
    created_at: datetime
    next_at: datetime | None
    paused: bool
    ended: bool
    why: str | None


class WindowView(BaseModel):
    """An arrival interval; `assumed` while speeds are assumed and not learned."""

    model_config = ConfigDict(validate_by_name=True, validate_by_alias=True, serialize_by_alias=True)

    from_: datetime = Field(alias="from")
    to: datetime
    assumed: bool

    @classmethod
    def of(cls, window: Window) -> "WindowView":
        return cls(from_=window.begins_at, to=window.ends_at, assumed=window.assumed)

    @classmethod
    def of_estimate(cls, estimate: EstimateView) -> "WindowView | None":
        """The same times; None while none are known."""
        if estimate.from_ is None or estimate.to is None:
            return None
        return cls(from_=estimate.from_, to=estimate.to, assumed=estimate.assumed)


class Estimate(BaseModel):
    """Before ordering: when mail would arrive, and how far it has to go.

    `reason` (and `reason_words`, as a text of the catalogue): why no robot can come as things are. The window then only
    says how long it would take with one.
    """

    window: WindowView
    length_m: float
    assumed: bool = True
    reason: str | None = None
    reason_words: Words | None = None


class PartyView(BaseModel):
    """The other person of an order."""

    email: str
    name: str


class EventView(BaseModel):
    """One step of the timeline: when by the server, when by the robot, by whom, where, why.

    `kind` is `moved` for a change of state; any other says what else happened, such as `wait_extended`.
    """

    seq: int
    kind: str
    state: OrderState
    at: datetime
    robot_at: datetime | None
    by: str
    robot: str | None
    post: str | None
    reason: str | None
    reason_words: Words | None


class CustodyView(BaseModel):
    """One link of the chain of custody: who held the mail, from when to when (null: to this day).

    `holder` is sender, robot, recipient, delegate or mailroom, `name` the robot's or the delegate's. `how` says how
    they came to have it: code, tap, digits or button by a robot's receipt, `dispatcher` by a dispatcher's report, null
    for the sender's own. `confirmed_by` is whose code, tap or digits it was (null for the button), and
    `confirmed_by_name` which delegate's; `signed`: the robot has signed for it, and the signature was checked. A
    delegate of the other side is a delegate without a name.

    `evidence` says what the link goes by: `proof` (only the code that was shown gives it), `tap`, `digits`,
    `dispatcher`, `digest` (weaker: an older robot), `button`, `claimed` (nothing but the robot's report, so that no one
    has confirmed it) or `settled` (claimed, and found true since); null for the sender's own. Who is said to have mail
    that is claimed to be out stands last, while the robot answers for it still.
    """

    model_config = ConfigDict(validate_by_name=True, validate_by_alias=True, serialize_by_alias=True)

    holder: str
    name: str | None
    from_: datetime = Field(alias="from")
    to: datetime | None
    how: str | None
    confirmed_by: str | None
    confirmed_by_name: str | None
    signed: bool
    evidence: str | None

    @classmethod
    def of(cls, link: CustodyLink) -> "CustodyView":
        return cls(
            holder=link.holder,
            name=link.name,
            from_=link.since,
            to=link.until,
            how=link.how,
            confirmed_by=link.confirmed_by,
            confirmed_by_name=link.confirmed_by_name,
            signed=link.signed,
            evidence=link.evidence,
        )


class HandoverRequested(BaseModel):
    """A person has tapped or typed digits, and the robot has not answered yet; after `expires_at` it will not."""

    how: str
    at: datetime
    expires_at: datetime


class OrderView(BaseModel):
    """An order as one person may see it. A delegate sees where it is, and of sender and recipient the names alone.

    `estimate`: when the robot should be at the recipient's, or why that is not known; null once it is there, or the
    mail goes elsewhere. `window` has the same times, or null. `why`: what the order waits for, never another order's
    stop. `passed_on_at_post`: where the mailroom has taken the mail out of one robot for another to carry
    it on.
    """

    id: str
    state: OrderState
    version: int
    from_post: str
    to_post: str
    sender: PartyView
    recipient: PartyView
    description: str | None
    created_at: datetime
    updated_at: datetime
    window: WindowView | None
    estimate: EstimateView | None = None
    robot: RobotView | None
    why: str | None
    why_words: Words | None
    my_role: Literal["sender", "recipient", "dispatcher", "delegate"]
    my_code: Literal["load", "receive", "return"] | None
    handover_requested: HandoverRequested | None
    can_cancel: bool
    cancel_requested: bool
    return_requested: bool
    priority: Literal["low", "normal", "high"]
    not_before: datetime | None
    wait_until: datetime | None
    return_post: str | None
    passed_on_at_post: str | None
    standing_order_id: str | None
    placed_by: PartyView | None
    custody: list[CustodyView]
    events: list[EventView]


class StandingOrderPage(PageOf[StandingOrderView]):
    """Some standing orders, newest first; `next` is the cursor of the following page, null on the last."""


class OrderPage(PageOf[OrderView]):
    """Some orders, newest first; `next` is the cursor of the following page, null on the last."""


def etag_of(view: OrderView) -> str:
    """The version of an order, for If-Match."""
    return f'"{view.version}"'
