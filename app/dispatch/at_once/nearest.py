"""Assignment where every corridor is granted at once: the nearest robot that is free; and what lies on a robot's
way goes along."""

from collections.abc import Sequence
from typing import Final

import structlog
from sqlalchemy import bindparam
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.dispatch.at_once.missions import begin_missions, take_along
from app.dispatch.charge_limits import Charges
from app.dispatch.choice import (
    BUSY,
    FETCHER_BUSY,
    NOT_ENOUGH_FOR_IT,
    Assignment,
    WaitingOrder,
    choose_robots,
    has_enough_charge,
    lacks_charge,
    why_nobody_comes,
)
from app.dispatch.held_up import NoRobotComes
from app.dispatch.waiting_work import connected_robots, idle_robots, look, tours
from app.dispatch.why_orders_wait import Answer
from app.dispatch.why_recorded import explain
from app.models import MissionRow, Order, OrderState, RobotRow
from app.orders.service import Actor
from app.orders.transitions import By
from app.robots.mission_updates import tell_mission
from app.robots.service import Fleet

AT_ONCE: Final = 20
"""So many orders in one transaction: what is behind them waits no longer than that takes."""
TAKEN_ALONG_AT_ONCE: Final = 5

log = structlog.get_logger(__name__)


class NearestRobots:
    """`left`: so many orders found no robot at the last look. `own`: orders that are being changed here."""

    def __init__(self, fleet: Fleet) -> None:
        self._fleet = fleet
        self._ways = fleet.orders.ledger.ways
        self._charges = Charges(self._ways, fleet.settings, fleet.spending.rates)
        self.left = 0
        self.own: set[str] = set()

    async def assign(self) -> bool:
        """Give waiting orders to robots, as many as there are robots for; whether there may be more to give."""
        now = self._fleet.clock.utc()
        try:
            async with self._fleet.database.transaction() as session:
                situation = await look(session, now)
                chosen = choose_robots(situation.waiting, situation.idle, self._ways, self._charges.may_take)
                assignments = chosen[:AT_ONCE]
                given = {one.order_id for one in assignments}
                if len(chosen) == len(situation.waiting):
                    await self._assign(session, assignments)
                else:
                    given |= await self._assign_what_can_be(session, assignments, situation.waiting)
        finally:
            self.own.clear()
        left = [order for order in situation.waiting if order.id not in given]
        if len(chosen) < len(situation.waiting):
            await self._explain(left)
        self.left = len(left)
        return bool(given) and self.left > 0

    async def _assign(self, session: AsyncSession, assignments: Sequence[Assignment], told: bool = True) -> list[str]:
        """The new missions, told unless something may still be added to them."""
        if not assignments:
            return []
        wanted = {"order_ids": [one.order_id for one in assignments]}
        orders = {order.id: order for order in (await session.exec(_ORDERS, params=wanted)).all()}
        given = [(orders[one.order_id], one.robot) for one in assignments]
        missions = await begin_missions(session, self._fleet, given, told)
        for one in assignments:
            await self._give(session, one.order_id, one.robot)
        return missions

    async def _give(self, session: AsyncSession, order_id: str, robot: str) -> None:
        self.own.add(order_id)
        await self._fleet.orders.ledger.move(session, order_id, OrderState.ASSIGNED, Actor(By.DISPATCHER, robot=robot))
        log.info("assigned", order=order_id, robot=robot)

    async def _assign_what_can_be(
        self, session: AsyncSession, assignments: Sequence[Assignment], waiting: Sequence[WaitingOrder]
    ) -> set[str]:
        """There are fewer robots than orders: what lies on a robot's way goes along. Which orders were given."""
        given = {one.order_id for one in assignments}
        busy = {one.robot for one in assignments}
        idle = [robot for robot in await idle_robots(session) if robot.name not in busy]
        is_somebody_free = any(has_enough_charge(robot) for robot in idle)
        missions = await self._assign(session, assignments, told=is_somebody_free)
        if not is_somebody_free:
            left = [order for order in waiting if order.id not in given]
            given |= await self._take_along(session, left[:TAKEN_ALONG_AT_ONCE], missions)
        return given

    async def _take_along(
        self, session: AsyncSession, orders: Sequence[WaitingOrder], missions: Sequence[str]
    ) -> set[str]:
        """Which orders go along. Robots are told of what has come on, and of these new missions."""
        taken, touched = set(), set(missions)
        under_way = await tours(session) if self._fleet.settings.robot_capacity > 1 else []
        for order in orders:
            mission = await take_along(session, self._fleet, order, under_way, self._ways)
            if mission is not None:
                await self._give(session, order.id, mission.robot)
                taken.add(order.id)
                touched.add(mission.id)
                under_way = await tours(session)
        for mission_id in sorted(touched):
            mission = await session.get_one(MissionRow, mission_id)
            robot = await session.get_one(RobotRow, mission.robot, with_for_update=True)
            await tell_mission(session, self._fleet, robot, mission)
        return taken

    async def _explain(self, waiting: Sequence[WaitingOrder]) -> None:
        async with self._fleet.database.reading() as session:
            idle, connected = await idle_robots(session), await connected_robots(session)
            held_up = None if idle else await NoRobotComes(self._fleet).why(session)
        lacking = {order.id for order in waiting if lacks_charge(order, idle, self._charges.may_take)}
        why = held_up or why_nobody_comes(idle, connected)
        takes_its_turn = why in (BUSY, FETCHER_BUSY)
        await explain(
            self._fleet,
            [
                Answer(order.id, NOT_ENOUGH_FOR_IT, has_time=False)
                if order.id in lacking
                else Answer(order.id, why, takes_its_turn)
                for order in waiting
            ],
        )


_ORDERS: Final = select(Order).where(col(Order.id).in_(bindparam("order_ids", expanding=True)))
