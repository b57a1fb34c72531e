"""Cancelling: at once, or on the word of the robot that is on its way."""

from sqlmodel.ext.asyncio.session import AsyncSession

from app.orders import errors
from app.orders.ledger import Ledger, Word
from app.orders.schemas import OrderView
from app.orders.transitions import ENDED, By
from app.orders.views import is_cancel_under_way, is_cancellable, load_facts, order_view
from app.tables import Order, OrderState, Person

CANCEL_REQUESTED = "cancel_requested"


class Cancelling(Ledger):
    """What ends an order before it is delivered."""

    async def cancel(self, session: AsyncSession, person: Person, order_id: str, if_match: str) -> OrderView:
        """Cancel at once, or ask the robot that is on its way to let go; until it answers the order goes on.

        Raises UnknownOrder, OrderChanged, NotCancellable.
        """
        order, role = await self.theirs(session, person, order_id, if_match)
        if not is_cancel_under_way(order):
            if role == "recipient" or not is_cancellable(order):
                raise errors.NotCancellable(_why_not_cancellable(order, role))
            await self._cancel(session, order, Word(By(role), person_id=person.id))
        facts = (await load_facts(session, [order]))[0]
        return order_view(facts, role, person.id, self.campus, self.settings)

    async def _cancel(self, session: AsyncSession, order: Order, word: Word) -> None:
        if order.state is OrderState.QUEUED:
            await self.move(session, order.id, OrderState.CANCELLED, word)
            return
        order.cancel_requested_at = self.clock.utc()
        order.cancel_requested_by = word.by
        await self.note(session, order.id, CANCEL_REQUESTED, word)


def _why_not_cancellable(order: Order, role: str) -> str:
    if role == "recipient":
        return "Only the sender can cancel."
    if order.state in ENDED:
        return f"The order is {order.state} already."
    return f"The order is {order.state}: the mail is aboard and will be delivered."
