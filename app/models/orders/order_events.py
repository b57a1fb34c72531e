"""The life of every order, append-only: audit trail and timeline in one."""

from datetime import datetime
from typing import Any, Final, NoReturn

from sqlalchemy import event
from sqlmodel import Field, SQLModel

from app.models.columns import EnumColumn, UtcTime
from app.models.orders.orders import OrderState


class EventsAreAppendOnly(RuntimeError):
    """An event of the past was to be changed or deleted: write a new event instead."""


MOVED: Final = "moved"
DELEGATE_NAMED: Final = "delegate_named"
DELEGATE_REVOKED: Final = "delegate_revoked"
"""Their `reason` is the delegate's name."""


class OrderEvent(SQLModel, table=True):
    """`at` is the server's time, `robot_at` the robot's; `by` is one of `app.orders.transitions.By`.

    `kind` is MOVED for a change of state; any other kind of event carries the state that the order had.
    """

    __tablename__ = "order_events"

    order_id: str = Field(primary_key=True, foreign_key="orders.id")
    seq: int = Field(primary_key=True)
    state: OrderState = Field(sa_type=EnumColumn(OrderState))
    kind: str = Field(default=MOVED, max_length=32)
    at: datetime = Field(sa_type=UtcTime)
    robot_at: datetime | None = Field(default=None, sa_type=UtcTime)
    by: str = Field(max_length=32)
    person_id: str | None = Field(default=None, foreign_key="people.id")
    robot: str | None = Field(default=None, max_length=64)
    post: str | None = Field(default=None, max_length=64)
    reason: str | None = Field(default=None, max_length=500)


@event.listens_for(OrderEvent, "before_update")
@event.listens_for(OrderEvent, "before_delete")
def _refuse(mapper: Any, connection: Any, target: OrderEvent) -> NoReturn:
    raise EventsAreAppendOnly(f"event {target.seq} of order {target.order_id} has happened and stays")
