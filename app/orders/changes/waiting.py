"""Longer waits: the person whom the robot waits for may ask for a little more, a dispatcher for any time."""

from dataclasses import dataclass
from datetime import timedelta
from typing import Final

from sqlmodel import col, func, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import Order, OrderEvent, OrderState, Person
from app.orders import errors
from app.orders.ledger import Actor, Ledger
from app.orders.stops import restart_wait, stops_of_order
from app.orders.transitions import By
from app.orders.views.schemas import OrderView
from app.orders.views.views import MyRole

WAIT_EXTENDED: Final = "wait_extended"
WAITS_FOR: Final = {
    OrderState.AT_SENDER: "sender",
    OrderState.AT_RECIPIENT: "recipient",
    OrderState.AT_RETURN: "sender",
}
EXTENSION_S: Final = 300.0
"""The person that the robot waits for may ask for so much more at once."""
EXTENSIONS: Final = 2
"""And so often."""


@dataclass(frozen=True)
class Waiting:
    """Prolong a wait."""

    ledger: Ledger

    async def extend_wait(
        self, session: AsyncSession, person: Person, order_id: str, extend_s: float | None, if_match: str = ""
    ) -> OrderView:
        """Let the robot wait longer where it is. Raises UnknownOrder, OrderChanged, NotWaiting, WaitedLongEnough."""
        order, role = await self.ledger.visible_order(session, person, order_id, if_match)
        if WAITS_FOR.get(order.state) != role and role != "dispatcher":
            raise errors.NotWaiting(f"The order is {order.state}: the robot is not waiting for you.")
        await self._check_share(session, order, role, extend_s)
        await self._extend(session, order, extend_s or EXTENSION_S)
        await self.ledger.note(session, order.id, WAIT_EXTENDED, Actor(By(role), person_id=person.id))
        return await self.ledger.view(session, order, role, person)

    async def _check_share(self, session: AsyncSession, order: Order, role: MyRole, extend_s: float | None) -> None:
        if role == "dispatcher":
            return
        if extend_s is not None and extend_s > EXTENSION_S:
            limit_min = EXTENSION_S / 60
            raise errors.WaitedLongEnough(f"You can ask for at most {limit_min:.0f} minutes at a time.")
        asked = select(func.count()).where(
            col(OrderEvent.order_id) == order.id,
            col(OrderEvent.kind) == WAIT_EXTENDED,
            col(OrderEvent.state) == order.state,
            col(OrderEvent.by) == role,
        )
        if (await session.exec(asked)).one() >= EXTENSIONS:
            raise errors.WaitedLongEnough("You have asked for more time as often as is possible. Ask the dispatcher.")

    async def _extend(self, session: AsyncSession, order: Order, extend_s: float) -> None:
        waiting = await stops_of_order(session, order.id, order.robot or "")
        if order.wait_until is None or not waiting or waiting[0].arrived_at is None:
            raise errors.NotWaiting(f"The order is {order.state}: no robot is waiting.")
        now = self.ledger.clock.utc()
        order.wait_until = max(order.wait_until, now) + timedelta(seconds=extend_s)
        await restart_wait(session, waiting[0], (order.wait_until - now).total_seconds())
