"""Changes by time alone: orders that wait too long expire, delays are reported, standing orders recur.

Each change is a transaction of its own that checks again before it acts, so that the service may stop at any moment.
"""

import asyncio
from contextlib import suppress
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from typing import Final

from sqlalchemy import ColumnElement, and_, or_
from sqlmodel import col, select

from app.core.database.database import Database
from app.core.errors import ServiceError
from app.core.trusted_clock import holds_on
from app.models import Order, OrderState
from app.notifications.service import tell_all
from app.orders.ledger import Actor
from app.orders.notifications import facts_of, notices_of_delay
from app.orders.service import Orders
from app.orders.standing.standing import StandingOrders
from app.orders.transitions import ENDED, By
from app.orders.views.estimate import expected_of
from app.orders.views.views import load_facts
from app.orders.window import promise

POLL_EVERY_S: Final = 1.0
"""Real seconds."""
AT_ONCE: Final = 50
NOT_FETCHED_IN_TIME: Final = "No robot has fetched it in time."
DELAYED: Final = "delayed"
NOT_ON_ITS_WAY: Final = ENDED | {OrderState.ATTENTION}
"""What waits for a dispatcher is late for a reason that its people have been told."""
DELAYED_AFTER: Final = timedelta(minutes=10)
"""An order counts as delayed so long after its window."""


@dataclass
class Timer:
    """Runs in the background of the service."""

    database: Database
    orders: Orders
    standing: StandingOrders
    _woken: asyncio.Event = field(default_factory=asyncio.Event)
    _stopping: bool = False
    _polled_at: datetime | None = None

    def stop(self) -> None:
        """End `run` after what it is doing."""
        self._stopping = True
        self._woken.set()

    async def run(self) -> None:
        """Until stopped or cancelled."""
        while not self._stopping:
            await self.tick()
            with suppress(TimeoutError):
                async with asyncio.timeout(POLL_EVERY_S):
                    await self._woken.wait()

    async def tick(self) -> None:
        """Do everything that is due now, once."""
        if holds_on(self.orders.ledger.clock):
            return  # what is done here is done for good
        now = self.orders.ledger.clock.utc()
        async with self.database.reading() as session:
            expired = (await session.exec(select(Order.id).where(self._waits_too_long(now)).limit(AT_ONCE))).all()
            late = (await session.exec(select(Order.id).where(self._is_late(now)).limit(AT_ONCE))).all()
            due = await self.standing.due(session)
            begun = (await session.exec(select(Order.id).where(self._begins(now)).limit(1))).all()
        for order_id in expired:
            await self._expire(order_id)
        for order_id in late:
            await self._report_delay(order_id)
        for standing_id in due:
            async with self.database.transaction() as session:
                await self.standing.make_next(session, standing_id)
        self._polled_at = now
        for order_id in begun:
            self.orders.ledger.changed(order_id)

    def _waits_too_long(self, now: datetime) -> ColumnElement[bool]:
        since = now - timedelta(seconds=self.orders.ledger.settings.queue_limit_s)
        begun = or_(col(Order.not_before).is_(None), col(Order.not_before) < since)
        return and_(col(Order.state) == OrderState.QUEUED, col(Order.created_at) < since, begun)

    def _is_late(self, now: datetime) -> ColumnElement[bool]:
        return and_(col(Order.window_to) < self._late_since(now), col(Order.state).not_in(NOT_ON_ITS_WAY))

    def _late_since(self, now: datetime) -> datetime:
        return now - DELAYED_AFTER

    def _begins(self, now: datetime) -> ColumnElement[bool]:
        """Select orders whose `not_before` has just passed: dispatch has to poll."""
        before = self._polled_at or now
        return and_(col(Order.state) == OrderState.QUEUED, col(Order.not_before) > before, col(Order.not_before) <= now)

    async def _expire(self, order_id: str) -> None:
        async with self.database.transaction() as session:
            order = await self.orders.ledger.order(session, order_id)
            if order.state is OrderState.QUEUED:  # else a robot has come after all
                await self.orders.ledger.move(
                    session, order_id, OrderState.EXPIRED, Actor(By.TIMER, reason=NOT_FETCHED_IN_TIME)
                )

    async def _report_delay(self, order_id: str) -> None:
        """Report a delay with the window expected now.

        Without a newer estimate, as if it were fetched from here on: rather too late than wrong again. Where no time is
        known, without one: the next known is a new promise.
        """
        async with self.database.transaction() as session:
            order = await self.orders.ledger.order(session, order_id)
            now = self.orders.ledger.clock.utc()
            if order.state in NOT_ON_ITS_WAY or order.window_to is None or order.window_to >= self._late_since(now):
                return  # it has moved on, or another process has told of it
            self._renew_promise(order, now)
            order.delayed_at = now
            await self.orders.ledger.note(session, order_id, DELAYED, Actor(By.TIMER))
            facts = (await load_facts(session, [order]))[0]
            gaps = facts_of(order, facts.people, self.orders.ledger.campus, self.orders.ledger.settings, now)
            await tell_all(session, notices_of_delay(order, gaps, facts.events))

    def _renew_promise(self, order: Order, now: datetime) -> None:
        expected = expected_of(order, now)
        if expected is not None or order.expected_to is None:
            order.window_from, order.window_to = expected or (None, None)
            return
        promise(order, None, now)
        with suppress(ServiceError):  # a post that the map has lost since: nothing is known any more
            promise(order, self.orders.placing.window(order.load_post, order.to_post), now)
