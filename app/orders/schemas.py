"""Orders over HTTP and in the event stream."""

from datetime import datetime
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

from app.orders.custody import Held
from app.orders.robot_view import RobotView
from app.orders.window import Window
from app.paging import PageOf
from app.people.schemas import Email

PostName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z][A-Za-z0-9_]*$", max_length=64)]


class NewOrder(BaseModel):
    """What the order form says."""

    model_config = ConfigDict(extra="forbid")

    from_post: PostName
    to_post: PostName
    recipient: Email
    description: Annotated[str, StringConstraints(max_length=500, strip_whitespace=True)] | None = None


class WindowView(BaseModel):
    """An arrival interval; `assumed` while speeds are assumed and not learned."""

    model_config = ConfigDict(validate_by_name=True, validate_by_alias=True, serialize_by_alias=True)

    from_: datetime = Field(alias="from")
    to: datetime
    assumed: bool

    @classmethod
    def of(cls, window: Window) -> "WindowView":
        return cls(from_=window.begins_at, to=window.ends_at, assumed=True)


class Estimate(BaseModel):
    """Before ordering: when mail would arrive, and how far it has to go."""

    window: WindowView
    length_m: float
    assumed: bool = True


class Somebody(BaseModel):
    """The other person of an order."""

    email: str
    name: str


class EventView(BaseModel):
    """One step of the timeline: when by the server, when by the robot, on whose word, where, why.

    `kind` is `moved` for a change of state; any other says what else happened, such as `wait_extended`.
    """

    seq: int
    kind: str
    state: str
    at: datetime
    robot_at: datetime | None
    by: str
    robot: str | None
    post: str | None
    reason: str | None


class CustodyView(BaseModel):
    """One link of the chain of custody: who held the mail, from when to when (null: to this day).

    `holder` is sender, robot, recipient, delegate or mailroom, `name` the robot's. `how` says how they came to have it:
    code, tap, digits or button by a robot's receipt, `dispatcher` by a dispatcher's word, null for the sender's own.
    """

    model_config = ConfigDict(validate_by_name=True, validate_by_alias=True, serialize_by_alias=True)

    holder: str
    name: str | None
    from_: datetime = Field(alias="from")
    to: datetime | None
    how: str | None

    @classmethod
    def of(cls, held: Held) -> "CustodyView":
        return cls(holder=held.holder, name=held.name, from_=held.since, to=held.until, how=held.how)


class OrderView(BaseModel):
    """An order as one person may see it."""

    id: str
    state: str
    version: int
    from_post: str
    to_post: str
    sender: Somebody
    recipient: Somebody
    description: str | None
    created_at: datetime
    updated_at: datetime
    window: WindowView | None
    robot: RobotView | None
    why: str | None
    my_role: Literal["sender", "recipient", "dispatcher"]
    my_code: Literal["load", "receive", "return"] | None
    can_cancel: bool
    cancel_requested: bool
    return_requested: bool
    priority: Literal["low", "normal", "high"]
    not_before: datetime | None
    wait_until: datetime | None
    return_post: str | None
    standing_order_id: str | None
    placed_by: Somebody | None
    custody: list[CustodyView]
    events: list[EventView]


class OrderPage(PageOf[OrderView]):
    """Some orders, newest first; `next` is the cursor of the following page, null on the last."""


class CodeView(BaseModel):
    """The hand-over code that it is this person's turn to show."""

    purpose: Literal["load", "receive", "return"]
    text: str
    svg_url: str
    expires_at: datetime
