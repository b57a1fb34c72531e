"""What can be done with an order, put together: each module beside this one is one kind of doing."""

from dataclasses import dataclass

from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import Order, Person
from app.orders.changes.cancelling import Cancelling
from app.orders.changes.passing_on import PassingOn
from app.orders.changes.placing import Placing
from app.orders.changes.waiting import Waiting
from app.orders.custody.codes import verifiers
from app.orders.ledger import Word, unknown
from app.orders.views.schemas import OrderView
from app.orders.views.views import load_facts, view_for
from protocol.to_robot import Verifier

__all__ = ["Orders", "Word"]


@dataclass(frozen=True)
class Orders(Placing, Cancelling, PassingOn, Waiting):
    """The orders of one campus."""

    async def view(self, session: AsyncSession, person: Person, order_id: str) -> OrderView:
        """One order as this person sees it. Raises UnknownOrder, for what is not theirs too."""
        order = await session.get(Order, order_id)  # to look at: readers lock nothing
        facts = await load_facts(session, [order]) if order is not None else []
        view = view_for(person, facts[0], self.campus, self.settings, self.clock.utc()) if facts else None
        if view is None:
            raise unknown(order_id)
        return view

    async def verifiers(self, session: AsyncSession, *orders: Order) -> tuple[Verifier, ...]:
        """What a robot needs to check the codes of these orders, delegates' too, with no network."""
        return await verifiers(session, self.key, orders)
