"""The delegates that one person has named, over all their open orders."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession
from sqlmodel.sql.expression import SelectOfScalar

from app.core.paging import Paging, Sorting
from app.handover.people import may_see
from app.models import Delegate, Order, OrderState, Person
from app.orders.transitions import ROBOT_COMING
from app.orders.views.search import OPEN
from app.orders.views.views import MyRole, OrderFacts, load_facts, role_in
from protocol.parts import Purpose

NEWEST_FIRST: Final = Sorting("my delegates", col(Delegate.named_at), col(Delegate.id), descending=True)
TO_LOAD: Final = (OrderState.QUEUED, OrderState.ATTENTION, *sorted(ROBOT_COMING))
"""Where a code to load is good, or may be again: out of attention an order may go back into the queue."""
TO_COME: Final = (((Purpose.LOAD,), TO_LOAD), ((Purpose.RECEIVE, Purpose.RETURN), OPEN))
"""The purposes of delegates, and the states before each is over."""


@dataclass(frozen=True)
class NamedDelegate:
    """A delegate, the order, and the role in it of the person who named them."""

    delegate: Delegate
    facts: OrderFacts
    role: MyRole


async def named_by(session: AsyncSession, person: Person, page: Paging) -> tuple[list[NamedDelegate], str | None]:
    """Those whose code is good still, newest first: one page of them, and the cursor of the next. Raises BadCursor."""
    walks = [_named(person, purposes, states) for purposes, states in TO_COME]
    rows, following = await page.of_any(session, walks, NEWEST_FIRST)
    theirs = col(Order.id).in_({row.order_id for row in rows})
    orders = (await session.exec(select(Order).where(theirs))).all() if rows else ()
    facts = {one.order.id: one for one in await load_facts(session, orders)}
    return list(_seen(rows, facts, person)), following


def _seen(rows: Iterable[Delegate], facts: dict[str, OrderFacts], person: Person) -> Iterable[NamedDelegate]:
    """Leave out delegates named by a role that the person has lost."""
    for row in rows:
        role = role_in(facts[row.order_id].order, person)
        if role is not None and may_see(row, role):
            yield NamedDelegate(row, facts[row.order_id], role)


def _named(person: Person, purposes: tuple[Purpose, ...], states: tuple[OrderState, ...]) -> SelectOfScalar[Delegate]:
    # Orders that go on are few, and found by their state; delegates of all time are many.
    going_on = select(Order.id).where(col(Order.state).in_(states))
    return select(Delegate).where(
        col(Delegate.order_id).in_(going_on),
        Delegate.named_by_id == person.id,
        col(Delegate.purpose).in_(purposes),
        col(Delegate.revoked_at).is_(None),
    )
