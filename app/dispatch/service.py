"""Gives waiting orders to robots, and tells robots what has changed for them. Woken after commits, by orders and robots
alike, and at the start of the service.

Everything it needs to know is in the database and everything it decides is one transaction, so that it can be stopped
at any moment: a mission that was decided on is in the robot's outbox and is sent until it is acknowledged.
"""

import asyncio
from collections.abc import Sequence
from typing import Final

import structlog
from sqlalchemy import bindparam
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.dispatch.charge import Charges
from app.dispatch.choice import (
    NOT_ENOUGH_FOR_IT,
    Assignment,
    WaitingOrder,
    choose_robots,
    has_enough_charge,
    lacks_charge,
    why_nobody_comes,
)
from app.dispatch.missions import begin_missions, take_along
from app.dispatch.situation import Todo, connected_robots, idle_robots, look, look_for_work, tours
from app.fleet.commands import ask, new_command_id, unanswered
from app.fleet.mission_updates import tell_mission
from app.fleet.service import Fleet
from app.orders.service import Word
from app.orders.transitions import By
from app.tables import MissionRow, Order, OrderState, RobotRow
from protocol.to_robot import Cancel

LOOK_AGAIN_S: Final = 30.0
"""Real seconds. Nothing should be missed between two wakes; if it is after all, it does not wait for ever."""
NOBODY_FREE_S: Final = 0.1
"""Real seconds. While orders wait for robots, looking more often finds nothing new and takes time from what is."""
REST: Final = 4
"""And a busy service has other things to do than to look again: so many times as long as a look has taken."""
LONGEST_REST_S: Final = 1.0
"""Real seconds. A look that had to wait for others took long without having done much."""
AT_ONCE: Final = 20
"""So many orders in one transaction: what is behind them waits no longer than that takes."""
TAKEN_ALONG_AT_ONCE: Final = 5

log = structlog.get_logger(__name__)


class Dispatcher:
    """Runs in the background of the service."""

    def __init__(self, fleet: Fleet) -> None:
        self._fleet = fleet
        self._ways = fleet.orders.ways
        self._charges = Charges(self._ways, fleet.settings, fleet.spending.rates)
        self._woken = asyncio.Event()
        self._stopping = False
        self._needs_robots = True
        self._left = 0
        self._own: set[str] = set()
        fleet.on_change.append(self.wake_for_robot)
        fleet.orders.on_change.append(self.wake)

    def wake(self, changed: str = "") -> None:
        """An order has changed: look again, unless that is what was just decided here."""
        if changed in self._own:
            self._own.discard(changed)
        else:
            self._woken.set()

    def wake_for_robot(self, _changed: str = "") -> None:
        """A robot has changed: look again, if anything was left for which no robot was there."""
        if self._needs_robots:
            self._woken.set()

    def stop(self) -> None:
        """End `run` after what it is doing."""
        self._stopping = True
        self.wake()

    async def run(self) -> None:
        """Until stopped or cancelled."""
        while not self._stopping:
            self._woken.clear()
            self._needs_robots = True  # what changes from here on may come too late for this look
            begun_s = asyncio.get_running_loop().time()
            self._needs_robots = await self.look_round()
            if self._needs_robots and not self._stopping:
                took_s = asyncio.get_running_loop().time() - begun_s
                await asyncio.sleep(min(max(NOBODY_FREE_S, REST * took_s), LONGEST_REST_S))
            try:
                async with asyncio.timeout(LOOK_AGAIN_S):
                    await self._woken.wait()
            except TimeoutError:
                pass

    async def look_round(self) -> bool:
        """Do what there is to do; whether anything is left that waits for a robot."""
        async with self._fleet.database.asking() as connection:
            todo = await look_for_work(connection, self._fleet.clock.utc())
        await self._pass_on(todo)
        if todo.waits:
            while await self.assign():
                pass
        return (todo.waits and self._left > 0) or bool(todo.changed)

    # Who fetches what.

    async def assign(self) -> bool:
        """Give waiting orders to robots, as many as there are robots for; whether there may be more to give."""
        now = self._fleet.clock.utc()
        try:
            async with self._fleet.database.transaction() as session:
                situation = await look(session, now, self._fleet.settings.priority_head_start_s)
                chosen = choose_robots(situation.waiting, situation.idle, self._ways, self._charges.may_take)
                assignments = chosen[:AT_ONCE]
                given = {one.order_id for one in assignments}
                if len(chosen) == len(situation.waiting):
                    await self._assign(session, assignments)
                else:
                    given |= await self._assign_what_can_be(session, assignments, situation.waiting)
        finally:
            self._own.clear()
        left = [order for order in situation.waiting if order.id not in given]
        if len(chosen) < len(situation.waiting):
            await self._explain(left)
        self._left = len(left)
        return bool(given) and self._left > 0

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
        self._own.add(order_id)
        await self._fleet.orders.move(session, order_id, OrderState.ASSIGNED, Word(By.DISPATCHER, robot=robot))
        log.info("assigned", order=order_id, robot=robot)

    async def _assign_what_can_be(
        self, session: AsyncSession, assignments: Sequence[Assignment], waiting: Sequence[WaitingOrder]
    ) -> set[str]:
        """There are fewer robots than orders: what lies on somebody's way goes along. Which orders were given."""
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
        """Only to those who were told something else so far. It waits for no disk: what is lost is said again."""
        async with self._fleet.database.reading() as session:
            idle, connected = await idle_robots(session), await connected_robots(session)
            lacking = {order.id for order in waiting if lacks_charge(order, idle, self._charges.may_take)}
            others = [order.id for order in waiting if order.id not in lacking]
            told = [(list(lacking), NOT_ENOUGH_FOR_IT), (others, why_nobody_comes(idle, connected))]
            asked = [{"order_ids": order_ids, "why": why} for order_ids, why in told]
            asked = [one for one in asked if (await session.exec(_TOLD_OTHERWISE, params=one)).all()]
        if not asked:
            return
        async with self._fleet.database.transaction(durable=False) as session:
            for one in asked:
                for order_id in (await session.exec(_TOLD_OTHERWISE, params=one)).all():
                    await self._fleet.orders.explain(session, order_id, str(one["why"]))

    # What has changed for robots.

    async def _pass_on(self, todo: Todo) -> None:
        """Tell robots what to drop, and missions that have changed; each is told once, in a transaction of its own."""
        for order_id in todo.dropped:
            await self._tell_to_drop(order_id)
        for mission_id in todo.changed:
            await self._tell_change(mission_id)

    async def _tell_to_drop(self, order_id: str) -> None:
        async with self._fleet.database.transaction() as session:
            order = await self._fleet.orders.order(session, order_id)
            robot = await session.get(RobotRow, order.let_go_by or "", with_for_update=True)
            order.let_go_by = None
            if robot is not None:
                # What a person has taken out by hand, the robot only has to forget.
                by_hand = await self._fleet.orders.is_taken_by_hand(session, order)
                drop = Cancel(command_id=new_command_id("cancel"), order_id=order.id, by_hand=by_hand)
                await ask(session, self._fleet, robot, drop)

    async def _tell_change(self, mission_id: str) -> None:
        async with self._fleet.database.transaction() as session:
            mission = await session.get_one(MissionRow, mission_id, with_for_update=True)
            # After a recall it has no mission, until its answer has come in: an update would be a new one to it.
            if await unanswered(session, robot=mission.robot, kind="recall"):
                return
            robot = await session.get_one(RobotRow, mission.robot, with_for_update=True)
            await tell_mission(session, self._fleet, robot, mission)


_ORDERS: Final = select(Order).where(col(Order.id).in_(bindparam("order_ids", expanding=True)))
_TOLD_OTHERWISE: Final = select(Order.id).where(
    col(Order.id).in_(bindparam("order_ids", expanding=True)),
    col(Order.state) == OrderState.QUEUED,
    col(Order.why).is_distinct_from(bindparam("why")),
)
