"""Orders as one person may see them."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypeVar

from sqlmodel import SQLModel, col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.orders.codes import turn_of
from app.orders.robot_view import robot_view
from app.orders.schemas import EventView, OrderView, Somebody, WindowView
from app.orders.transitions import ENDED, ROBOT_COMING
from app.settings import Settings
from app.tables import Order, OrderEvent, OrderState, Person, RobotRow, Role
from maps import CampusMap

MyRole = Literal["sender", "recipient", "dispatcher"]
Row = TypeVar("Row", bound=SQLModel)


@dataclass(frozen=True)
class OrderFacts:
    """An order and the rows that its view shows."""

    order: Order
    events: Sequence[OrderEvent]
    people: Mapping[str, Person]
    robot: RobotRow | None

    @property
    def sender(self) -> Person:
        return self.people[self.order.sender_id]

    @property
    def recipient(self) -> Person:
        return self.people[self.order.recipient_id]


async def load_facts(session: AsyncSession, orders: Sequence[Order]) -> list[OrderFacts]:
    """The rows around some orders, in the same order, in three queries."""
    ids = [order.id for order in orders]
    events = select(OrderEvent).where(col(OrderEvent.order_id).in_(ids)).order_by(col(OrderEvent.seq))
    all_events = (await session.exec(events)).all()
    people = await _by_key(session, Person, Person.id, {one for o in orders for one in (o.sender_id, o.recipient_id)})
    robots = await _by_key(session, RobotRow, RobotRow.name, {o.robot for o in orders if o.robot})
    return [
        OrderFacts(o, [e for e in all_events if e.order_id == o.id], people, robots.get(o.robot or "")) for o in orders
    ]


async def _by_key(session: AsyncSession, table: type[Row], key: Any, wanted: Iterable[str]) -> dict[str, Row]:
    rows = (await session.exec(select(table).where(col(key).in_(list(wanted))))).all()
    return {str(getattr(row, key.key)): row for row in rows}


def role_in(order: Order, person: Person) -> MyRole | None:
    """As what this person sees the order; None: not at all."""
    if person.id == order.sender_id:
        return "sender"
    if person.id == order.recipient_id:
        return "recipient"
    return "dispatcher" if person.has_role(Role.DISPATCHER) else None


def view_for(person: Person, facts: OrderFacts, campus: CampusMap, settings: Settings) -> OrderView | None:
    """The order as `person` sees it; None if it is not theirs to see."""
    role = role_in(facts.order, person)
    return None if role is None else order_view(facts, role, person.id, campus, settings)


def order_view(facts: OrderFacts, role: MyRole, person_id: str, campus: CampusMap, settings: Settings) -> OrderView:
    """The order in one role. The robot is shown while it has to do with the order, and not after."""
    order = facts.order
    robot = robot_view(facts.robot, campus, settings) if facts.robot and order.state not in ENDED else None
    turn = turn_of(order, person_id)
    return OrderView(
        id=order.id,
        state=str(order.state),
        version=order.version,
        from_post=order.from_post,
        to_post=order.to_post,
        sender=_somebody(facts.sender),
        recipient=_somebody(facts.recipient),
        description=order.description,
        created_at=order.created_at,
        updated_at=order.updated_at,
        window=_window(order),
        robot=robot,
        why=order.why or (robot.why if robot else None),
        my_role=role,
        my_code=None if turn is None else turn.value,
        can_cancel=role != "recipient" and is_cancellable(order),
        cancel_requested=is_cancel_under_way(order) and order.state not in ENDED,
        events=[_event(event) for event in facts.events],
    )


def is_cancellable(order: Order) -> bool:
    """Until the mail is aboard, and once."""
    waiting = order.state is OrderState.QUEUED or order.state in ROBOT_COMING
    return waiting and order.cancel_requested_at is None


def is_cancel_under_way(order: Order) -> bool:
    """Cancelled, or asked for with the robot's answer still to come: asking again changes nothing."""
    if order.state in ROBOT_COMING:
        return order.cancel_requested_at is not None
    return order.state is OrderState.CANCELLED


def _window(order: Order) -> WindowView | None:
    if order.window_from is None or order.window_to is None:
        return None
    return WindowView(from_=order.window_from, to=order.window_to, assumed=order.window_assumed)


def _somebody(person: Person) -> Somebody:
    return Somebody(email=person.email, name=person.name)


def _event(event: OrderEvent) -> EventView:
    return EventView(
        seq=event.seq,
        kind=event.kind,
        state=str(event.state),
        at=event.at,
        robot_at=event.robot_at,
        by=event.by,
        robot=event.robot,
        post=event.post,
        reason=event.reason,
    )
