"""Gives waiting orders to robots, and tells robots what has changed for them. Woken after commits, by orders and robots
alike, and at the start of the service.

Everything it needs to know is in the database and everything it decides is one transaction, so that it can be stopped
at any moment: a mission that was decided on is in the robot's outbox and is sent until it is acknowledged.
"""

import asyncio
from collections.abc import Sequence
from typing import Final

import structlog
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession
from sqlmodel.sql.expression import SelectOfScalar

from app.dispatch.choice import Assignment, choose_robots, has_enough_charge, why_nobody_comes
from app.dispatch.missions import begin_mission, take_along
from app.dispatch.situation import Situation, anything_waits, look, tours
from app.fleet.commands import ask, new_command_id, unanswered
from app.fleet.mission_updates import tell_mission
from app.fleet.service import Fleet
from app.orders.service import Word
from app.orders.transitions import By
from app.tables import MissionRow, MissionState, Order, OrderState, RobotRow
from maps.ways import Ways
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
        self._ways = Ways(fleet.campus)
        self._woken = asyncio.Event()
        self._stopping = False
        self._needs_robots = True
        self._left = 0
        fleet.on_change.append(self.wake_for_robot)
        fleet.orders.on_change.append(self.wake)

    def wake(self, _changed: str = "") -> None:
        """An order has changed: look again."""
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
        async with self._fleet.database.reading() as session:
            dropped = (await session.exec(select(Order.id).where(col(Order.let_go_by).is_not(None)))).all()
            changed = (await session.exec(_changed_missions())).all()
            waits = await anything_waits(session, self._fleet.clock.utc())
        await self._pass_on(dropped, changed)
        if waits:
            while await self.assign():
                pass
        return (waits and self._left > 0) or bool(changed)

    # Who fetches what.

    async def assign(self) -> bool:
        """Give waiting orders to robots, as many as there are robots for; whether there may be more to give."""
        now = self._fleet.clock.utc()
        async with self._fleet.database.transaction() as session:
            situation = await look(session, now, self._fleet.settings.priority_head_start_s)
            assignments = choose_robots(situation.waiting, situation.idle, self._ways)[:AT_ONCE]
            touched = [await self._assign(session, one) for one in assignments]
            given = {one.order_id for one in assignments}
            if sum(has_enough_charge(robot) for robot in situation.idle) <= len(assignments):
                given |= await self._take_along(session, situation, given, touched)
            await self._tell(session, touched)
            await self._explain(session, situation, given)
        self._left = len(situation.waiting) - len(given)
        return bool(given) and self._left > 0

    async def _assign(self, session: AsyncSession, assignment: Assignment) -> MissionRow:
        order = await session.get_one(Order, assignment.order_id)
        mission = await begin_mission(session, self._fleet, order, assignment.robot)
        await self._give(session, order, assignment.robot)
        return mission

    async def _give(self, session: AsyncSession, order: Order, robot: str) -> None:
        await self._fleet.orders.move(session, order.id, OrderState.ASSIGNED, Word(By.DISPATCHER, robot=robot))
        log.info("assigned", order=order.id, robot=robot)

    async def _take_along(
        self, session: AsyncSession, situation: Situation, given: set[str], touched: list[MissionRow]
    ) -> set[str]:
        """Nobody is free any more: what lies on the way of a robot under way goes with it."""
        taken: set[str] = set()
        under_way = await tours(session) if self._fleet.settings.robot_capacity > 1 else []
        for order in [one for one in situation.waiting if one.id not in given][:TAKEN_ALONG_AT_ONCE]:
            mission = await take_along(session, self._fleet, order, under_way, self._ways)
            if mission is not None:
                await self._give(session, await session.get_one(Order, order.id), mission.robot)
                taken.add(order.id)
                touched[:] = [*(one for one in touched if one.id != mission.id), mission]
                under_way = await tours(session)
        return taken

    async def _tell(self, session: AsyncSession, missions: list[MissionRow]) -> None:
        for mission in missions:
            robot = await session.get_one(RobotRow, mission.robot, with_for_update=True)
            await tell_mission(session, self._fleet, robot, mission)

    async def _explain(self, session: AsyncSession, situation: Situation, given: set[str]) -> None:
        """Only to those who were told something else so far."""
        waiting = [order.id for order in situation.waiting if order.id not in given]
        if waiting:
            why = why_nobody_comes(situation.idle, situation.connected)
            told = select(Order.id).where(col(Order.id).in_(waiting), col(Order.why).is_distinct_from(why))
            for order_id in (await session.exec(told)).all():
                await self._fleet.orders.explain(session, order_id, why)

    # What has changed for robots.

    async def _pass_on(self, dropped: Sequence[str], changed: Sequence[str]) -> None:
        """Tell robots what to drop, and missions that have changed; each is told once, in a transaction of its own."""
        for order_id in dropped:
            await self._tell_to_drop(order_id)
        for mission_id in changed:
            await self._tell_change(mission_id)

    async def _tell_to_drop(self, order_id: str) -> None:
        async with self._fleet.database.transaction() as session:
            order = await self._fleet.orders.order(session, order_id)
            robot = await session.get(RobotRow, order.let_go_by or "", with_for_update=True)
            order.let_go_by = None
            if robot is not None:
                # What a person has taken out by hand, the robot only has to forget.
                by_hand = order.state is OrderState.HELD
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


def _changed_missions() -> SelectOfScalar[str]:
    return select(MissionRow.id).where(
        MissionRow.state == MissionState.ACTIVE, col(MissionRow.told_update) < col(MissionRow.update_number)
    )
