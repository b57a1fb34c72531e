"""One report of one robot, and how an order comes along with what it says."""

from dataclasses import dataclass
from datetime import datetime, timedelta

from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import Order, OrderState
from app.orders.custody.unproven import claim_of_handing_out
from app.orders.service import Actor, Orders
from app.orders.transitions import By, is_old_news
from app.robots.link.clocks import put_right


@dataclass(frozen=True)
class Report:
    """One event of one robot, and the time of the service."""

    session: AsyncSession
    orders: Orders
    robot: str
    now: datetime
    clock_off_s: float = 0.0
    """How far the robot's clock is ahead."""

    def when(self, at: datetime) -> datetime:
        """A time that the robot tells, by the service's clock."""
        return put_right(at, self.clock_off_s)

    def actor(self, robot_at: datetime, post: str | None, reason: str | None = None) -> Actor:
        return Actor(By.ROBOT, robot=self.robot, robot_at=self.when(robot_at), post=post, reason=reason)

    def until(self, since: datetime, limit_s: float) -> datetime:
        """When a wait ends that the robot says began at `since`; its clock may be wrong, but nothing began later."""
        return min(self.when(since), self.now) + timedelta(seconds=limit_s)

    async def aboard(self, *states: OrderState) -> list[Order]:
        """The orders of this robot in one of these states, but for those whose mail it says it has not any more."""
        wanted = select(Order).where(Order.robot == self.robot, col(Order.state).in_(states)).order_by(col(Order.id))
        orders = (await self.session.exec(wanted)).all()
        return [order for order in orders if not await self._says_it_is_out(order)]

    async def _says_it_is_out(self, order: Order) -> bool:
        waits = order.state is OrderState.ATTENTION
        return waits and await claim_of_handing_out(self.session, order.id) is not None

    async def along(
        self,
        order_id: str,
        states: tuple[OrderState, ...],
        actor: Actor,
        wait_until: datetime | None = None,
        *,
        quietly: bool = False,
    ) -> None:
        """Take an order through `states`, from wherever it is among them. Raises TransitionRefused.

        A robot that was given up on and goes on by itself takes its order out of attention: what it does is the truth.
        People have been told of where that was, and are now told of what it has come to. But for mail that it says it
        has not any more: what becomes of that is for the person to say who has asked. `quietly`: no person is told of
        the last state.
        """
        order = await self.orders.ledger.order(self.session, order_id)
        before = order.state_before_attention
        if before is not None and await claim_of_handing_out(self.session, order_id):
            return
        goes_on = order.state not in states and states and not is_old_news(order.state, states[-1], before)
        if before is not None and goes_on:
            await self.orders.ledger.move(self.session, order_id, before, actor, quietly=before is not states[-1])
        if order.state in states:
            states = states[states.index(order.state) :]
        for state in states:
            last = state is states[-1]
            until = wait_until if last else None
            await self.orders.ledger.move(self.session, order_id, state, actor, until, quietly=quietly and last)
