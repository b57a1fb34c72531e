"""Orders as one person may see them."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from types import MappingProxyType
from typing import Final, Literal, TypeVar

from sqlalchemy import BindParameter, bindparam
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.settings import Settings
from app.core.texts.reasons import words_of
from app.models import Delegate, Handover, Order, OrderEvent, OrderState, Person, RobotRow, Role
from app.models.orders.order_events import DELEGATE_NAMED, DELEGATE_REVOKED, MOVED
from app.orders.custody.codes import CONFIRM_LIFETIME_S, mailrooms_turn, turn_of
from app.orders.custody.custody import custody_of
from app.orders.transitions import CARRIED, ENDED, LOADED, ROBOT_COMING, By
from app.orders.views.estimate import estimate_view
from app.orders.views.reasons import as_of_order, why_it_waits
from app.orders.views.robot_view import robot_view
from app.orders.views.schemas import CustodyView, EventView, HandoverRequested, OrderView, PartyView, WindowView
from maps import CampusMap
from protocol.parts import Purpose

CONFIRM_REQUESTED: Final = "confirm_requested"
MyRole = Literal["sender", "recipient", "dispatcher"]
HANDOVER_PURPOSES: Final[Mapping[MyRole, tuple[Purpose, ...]]] = {
    "sender": (Purpose.LOAD, Purpose.RETURN),
    "recipient": (Purpose.RECEIVE,),
    "dispatcher": tuple(Purpose),
}
"""The hand-overs for which each may name delegates (the first by default), and whose names they see."""
OfOrder = TypeVar("OfOrder", OrderEvent, Handover)


SHOWN_TO_DELEGATES: Final = (
    *(
        "id",
        "state",
        "version",
        "created_at",
        "updated_at",
        "from_post",
        "to_post",
        "return_post",
        "passed_on_at_post",
        "priority",
    ),
    *("not_before", "window", "estimate", "wait_until", "handover_requested", "cancel_requested", "return_requested"),
)
"""Where it is, when it comes, and whether a hand-over is still wanted."""
UNSAID_TO_DELEGATES: Final = MappingProxyType({"why": None, "why_words": None, "battery": None})
"""Of the robot: a delegate has to meet it, and nothing more."""


@dataclass(frozen=True)
class OrderFacts:
    """An order and the rows that its view shows."""

    order: Order
    events: Sequence[OrderEvent]
    people: Mapping[str, Person]
    robot: RobotRow | None
    handovers: Sequence[Handover] = ()
    delegates: Sequence[tuple[str, str, str]] = ()
    """Those who took part in hand-overs: their ids, what they were named for, their names."""

    @property
    def sender(self) -> Person:
        return self.people[self.order.sender_id]

    @property
    def recipient(self) -> Person:
        return self.people[self.order.recipient_id]


async def load_facts(session: AsyncSession, orders: Sequence[Order]) -> list[OrderFacts]:
    """The rows around some orders, in the same order, in five queries at most."""
    ids = [order.id for order in orders]
    events_of = _by_order((await session.exec(_EVENTS, params={"ids": ids})).all())
    wanted = {one for order in orders for one in _people_of(order)}
    people = {one.id: one for one in (await session.exec(_PEOPLE, params={"ids": list(wanted)})).all()}
    names_of_robots = {order.robot for order in orders if order.robot}
    robots = {one.name: one for one in (await session.exec(_ROBOTS, params={"ids": list(names_of_robots)})).all()}
    handovers = await _handovers(session, [order.id for order in orders if order.state in LOADED or order.is_passed_on])
    names, handovers_of = await _delegates(session, handovers), _by_order(handovers)
    return [
        OrderFacts(o, events_of[o.id], people, robots.get(o.robot or ""), handovers_of[o.id], names) for o in orders
    ]


def _by_order(rows: Iterable[OfOrder]) -> defaultdict[str, list[OfOrder]]:
    sorted_out: defaultdict[str, list[OfOrder]] = defaultdict(list)
    for row in rows:
        sorted_out[row.order_id].append(row)
    return sorted_out


def _people_of(order: Order) -> Iterator[str]:
    yield from (order.sender_id, order.recipient_id)
    if order.placed_by_id:
        yield order.placed_by_id


async def _handovers(session: AsyncSession, order_ids: Sequence[str]) -> Sequence[Handover]:
    """Return the hand-overs; without a query for what has never been loaded."""
    if not order_ids:
        return ()
    wanted = select(Handover).where(col(Handover.order_id).in_(order_ids)).order_by(col(Handover.id))
    return (await session.exec(wanted)).all()


async def _delegates(session: AsyncSession, handovers: Iterable[Handover]) -> Sequence[tuple[str, str, str]]:
    """Return the delegates who took part; mostly there are none, and no query."""
    ids = {one.delegate_id for one in handovers if one.delegate_id}
    if not ids:
        return ()
    wanted = select(Delegate.id, Delegate.purpose, Delegate.name).where(col(Delegate.id).in_(ids))
    return (await session.exec(wanted)).all()


# Put together once: that takes longer than asking.
_IDS: Final[BindParameter[str]] = bindparam("ids", expanding=True)
_EVENTS: Final = select(OrderEvent).where(col(OrderEvent.order_id).in_(_IDS)).order_by(col(OrderEvent.seq))
_PEOPLE: Final = select(Person).where(col(Person.id).in_(_IDS))
_ROBOTS: Final = select(RobotRow).where(col(RobotRow.name).in_(_IDS))


def role_in(order: Order, person: Person) -> MyRole | None:
    """Return this person's role in the order; None: they may not see it."""
    if person.id == order.sender_id:
        return "sender"
    if person.id == order.recipient_id:
        return "recipient"
    return "dispatcher" if person.has_role(Role.DISPATCHER) else None


def view_for(
    person: Person, facts: OrderFacts, campus: CampusMap, settings: Settings, now: datetime
) -> OrderView | None:
    """The order as `person` sees it; None if it is not theirs to see."""
    role = role_in(facts.order, person)
    return None if role is None else order_view(facts, role, person.id, campus, settings, now)


def order_view(
    facts: OrderFacts, role: MyRole, person_id: str, campus: CampusMap, settings: Settings, now: datetime
) -> OrderView:
    """The order in one role. The robot is shown while it has to do with the order, and not after."""
    order = facts.order
    row = facts.robot if order.state not in ENDED else None
    why = why_it_waits(order, row)
    why_words = words_of(why) if why and not _is_why_typed(facts) else None
    estimate = estimate_view(order, row, why, why_words, now)
    turn = turn_of(order, person_id) or (mailrooms_turn(order) if role == "dispatcher" else None)
    return OrderView(
        id=order.id,
        state=str(order.state),
        version=order.version,
        from_post=order.from_post,
        to_post=order.to_post,
        sender=person_view(facts.sender),
        recipient=person_view(facts.recipient),
        description=order.description,
        created_at=order.created_at,
        updated_at=order.updated_at,
        window=estimate and WindowView.of_estimate(estimate),
        estimate=estimate,
        robot=row and as_of_order(robot_view(row, campus, settings, now), why),
        why=why,
        why_words=why_words,
        my_role=role,
        my_code=None if turn is None else turn.value,
        handover_requested=_handover_requested(facts.events, settings),
        can_cancel=is_cancellable(order, role),
        cancel_requested=is_cancel_under_way(order) and order.state not in ENDED,
        return_requested=order.return_requested_at is not None and order.state in CARRIED,
        priority=order.priority.value,
        not_before=order.not_before,
        wait_until=order.wait_until,
        return_post=order.return_post,
        passed_on_at_post=order.passed_on_at_post,
        standing_order_id=order.standing_order_id,
        placed_by=person_view(facts.people[order.placed_by_id]) if order.placed_by_id else None,
        custody=[CustodyView.of(link) for link in custody_of(order, facts.handovers, _names_for(role, facts))],
        events=[_event(event, may_read(role, order, event.kind, event.by)) for event in facts.events],
    )


def delegates_view(
    facts: OrderFacts, turn: Purpose | None, campus: CampusMap, settings: Settings, now: datetime
) -> OrderView:
    """Return the order for a delegate: where it is and whose, nothing of what it holds or went
    through, and no `why`, which may be anybody's own words. `turn`: what their code is good for now."""
    whole = order_view(facts, "recipient", "", campus, settings, now)
    return OrderView(
        **{name: getattr(whole, name) for name in SHOWN_TO_DELEGATES if name != "estimate"},
        estimate=whole.estimate and whole.estimate.without_own_words(),
        sender=PartyView(email="", name=facts.sender.name),
        recipient=PartyView(email="", name=facts.recipient.name),
        robot=whole.robot and whole.robot.model_copy(update=UNSAID_TO_DELEGATES),
        my_role="delegate",
        my_code=turn and turn.value,
        can_cancel=False,
        description=None,
        why=None,
        why_words=None,
        standing_order_id=None,
        placed_by=None,
        custody=[],
        events=[],
    )


def whose_delegates(role: MyRole | None, order: Order) -> tuple[Purpose, ...]:
    """Return the purposes of the delegates whose names this role sees.

    Sender and recipient do not see each other's: only that it was a delegate.
    """
    if role is None:
        return ()
    return HANDOVER_PURPOSES["dispatcher" if order.sender_id == order.recipient_id else role]


def may_read(role: MyRole | None, order: Order, kind: str, by: str) -> bool:
    """The reason of an event that names a delegate is for those who did so, and for dispatchers."""
    sees_all = whose_delegates(role, order) == HANDOVER_PURPOSES["dispatcher"]
    return kind not in (DELEGATE_NAMED, DELEGATE_REVOKED) or sees_all or role == by


def _names_for(role: MyRole, facts: OrderFacts) -> Mapping[str, str]:
    sees = whose_delegates(role, facts.order)
    return {id_: name for id_, purpose, name in facts.delegates if purpose in sees}


def is_cancellable(order: Order, role: MyRole) -> bool:
    """Until it has ended or turned back, and once. What waits for a dispatcher is resolved otherwise."""
    if role == "recipient" or is_cancel_under_way(order):
        return False
    return order.state is OrderState.QUEUED or order.state in ROBOT_COMING or order.state in CARRIED


def is_cancel_under_way(order: Order) -> bool:
    """Cancelled, turned back, or asked for with the robot's answer still to come: asking again changes nothing."""
    if order.state in ROBOT_COMING:
        return order.cancel_requested_at is not None
    if order.state in CARRIED:
        return order.return_requested_at is not None
    return order.state in {OrderState.CANCELLED, OrderState.RETURNING, OrderState.AT_RETURN}


def _handover_requested(events: Sequence[OrderEvent], settings: Settings) -> HandoverRequested | None:
    """The newest thing that happened to the order, if that is what it was."""
    last = events[-1] if events else None
    if last is None or last.kind != CONFIRM_REQUESTED:
        return None
    expires_at = last.at + timedelta(seconds=CONFIRM_LIFETIME_S)
    return HandoverRequested(how=last.reason or "tap", at=last.at, expires_at=expires_at)


def person_view(person: Person) -> PartyView:
    return PartyView(email=person.email, name=person.name)


def _is_typed(event: OrderEvent) -> bool:
    """Return whether a dispatcher typed the reason: then it is no reason code, whatever it looks like."""
    return event.by == By.DISPATCHER and event.person_id is not None


def _is_why_typed(facts: OrderFacts) -> bool:
    """An order in attention waits for the reason with which it was stopped."""
    stopped = next((event for event in reversed(facts.events) if event.kind == MOVED), None)
    return stopped is not None and stopped.state == OrderState.ATTENTION and _is_typed(stopped)


def _event(event: OrderEvent, with_reason: bool) -> EventView:
    reason = event.reason if with_reason else None
    return EventView(
        seq=event.seq,
        kind=event.kind,
        state=str(event.state),
        at=event.at,
        robot_at=event.robot_at,
        by=event.by,
        robot=event.robot,
        post=event.post,
        reason=reason,
        reason_words=words_of(reason) if reason and not _is_typed(event) else None,
    )
