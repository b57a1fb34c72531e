"""Cancelling: at once, when the robot on its way confirms it, or, with the mail aboard, by calling it back."""

from dataclasses import dataclass
from typing import Final

from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import Order, OrderState, Person
from app.orders import errors
from app.orders.changes.returning import Returning
from app.orders.ledger import Actor, Ledger
from app.orders.transitions import ENDED, ROBOT_COMING, By
from app.orders.views.schemas import OrderView
from app.orders.views.views import MyRole, is_cancel_under_way, is_cancellable

CANCEL_REQUESTED: Final = "cancel_requested"


@dataclass(frozen=True)
class Cancelling:
    """End an order before it is delivered."""

    ledger: Ledger
    returning: Returning

    async def cancel(self, session: AsyncSession, person: Person, order_id: str, if_match: str) -> OrderView:
        """Cancel at once, or ask the robot to let go, or to bring the mail back; until it answers the order goes on.

        Raises UnknownOrder, OrderChanged, NotCancellable.
        """
        order, role = await self.ledger.visible_order(session, person, order_id, if_match)
        if not is_cancel_under_way(order):
            if not is_cancellable(order, role):
                raise errors.NotCancellable(_why_not_cancellable(order, role))
            await self._cancel(session, order, Actor(By(role), person_id=person.id))
        return await self.ledger.view(session, order, role, person)

    async def _cancel(self, session: AsyncSession, order: Order, actor: Actor) -> None:
        if order.state is OrderState.QUEUED:
            await self.ledger.move(session, order.id, OrderState.CANCELLED, actor)
        elif order.state in ROBOT_COMING:
            order.cancel_requested_at, order.cancel_requested_by = self.ledger.clock.utc(), actor.by
            order.let_go_by = order.robot
            await self.ledger.note(session, order.id, CANCEL_REQUESTED, actor)
        else:
            await self.returning.call_back(session, order, actor)


def _why_not_cancellable(order: Order, role: MyRole) -> str:
    if role == "recipient":
        return "Only the sender can cancel."
    if order.state in ENDED:
        return f"The order is {order.state} already."
    return "The order waits for a dispatcher, who decides what becomes of it."
