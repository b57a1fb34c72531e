"""Gives waiting orders to robots. Woken after commits, by orders and robots alike, and at the start of the service.

Everything it needs to know is in the database and everything it decides is one transaction, so that it can be stopped
at any moment: a mission that was decided on is in the robot's outbox and is sent until it is acknowledged.
"""

import asyncio
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import structlog
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.dispatch.choice import Assignment, IdleRobot, WaitingOrder, choose_robot, why_nobody_comes
from app.fleet.commands import ask, new_command_id
from app.fleet.greeting import stop_of
from app.fleet.service import Fleet
from app.orders.service import Word
from app.orders.transitions import MAIL_ABOARD, ROBOT_COMING, By
from app.people.service import new_id
from app.tables import MissionRow, MissionState, Order, OrderState, RobotCommand, RobotRow, StopRow
from protocol.parts import StopAction
from protocol.to_robot import Cancel, Mission, Verifiers

LOOK_AGAIN_S: Final = 30.0
"""Real seconds. Nothing should be missed between two wakes; if it is after all, it does not wait for ever."""

log = structlog.get_logger(__name__)


@dataclass(frozen=True)
class Situation:
    """What dispatch looks at."""

    waiting: Sequence[Order]
    idle: Sequence[IdleRobot]
    connected: int


class Dispatcher:
    """Runs in the background of the service."""

    def __init__(self, fleet: Fleet) -> None:
        self._fleet = fleet
        self._woken = asyncio.Event()
        self._stopping = False
        fleet.on_change.append(self.wake)
        fleet.orders.on_change.append(self.wake)

    def wake(self, _changed: str = "") -> None:
        """An order or a robot has changed: look again."""
        self._woken.set()

    def stop(self) -> None:
        """End `run` after what it is doing."""
        self._stopping = True
        self.wake()

    async def run(self) -> None:
        """Until stopped or cancelled."""
        while not self._stopping:
            self._woken.clear()
            while await self.assign_next():
                pass
            await self.pass_on_cancels()
            try:
                async with asyncio.timeout(LOOK_AGAIN_S):
                    await self._woken.wait()
            except TimeoutError:
                pass

    async def assign_next(self) -> bool:
        """Give one waiting order to a robot, if there are both; False if not."""
        if not await self._anything_waits():
            return False
        async with self._fleet.database.transaction() as session:
            situation = await _look(session)
            waiting = [WaitingOrder(order.id, order.from_post) for order in situation.waiting]
            assignment = choose_robot(waiting, situation.idle, self._fleet.campus)
            if assignment is None:
                await self._explain(session, situation)
                return False
            await self._assign(session, assignment)
        log.info("assigned", order=assignment.order_id, robot=assignment.robot)
        return True

    async def _anything_waits(self) -> bool:
        async with self._fleet.database.reading() as session:
            queued = select(Order.id).where(Order.state == OrderState.QUEUED)
            return (await session.exec(queued.limit(1))).first() is not None

    async def _explain(self, session: AsyncSession, situation: Situation) -> None:
        why = why_nobody_comes(situation.idle, situation.connected)
        for order in situation.waiting:
            await self._fleet.orders.explain(session, order.id, why)

    async def _assign(self, session: AsyncSession, assignment: Assignment) -> None:
        order = await session.get_one(Order, assignment.order_id)
        robot = await session.get_one(RobotRow, assignment.robot)
        mission = await self._write_mission(session, order, robot)
        word = Word(By.DISPATCHER, robot=robot.name)
        await self._fleet.orders.move(session, order.id, OrderState.ASSIGNED, word)
        # First what codes are checked against: the mission must not begin without.
        await self._fleet.tell(session, robot, Verifiers(verifiers=await self._fleet.orders.verifiers(session, order)))
        await self._fleet.tell(session, robot, mission)

    async def _write_mission(self, session: AsyncSession, order: Order, robot: RobotRow) -> Mission:
        row = MissionRow(id=new_id(), robot=robot.name, created_at=self._fleet.clock.utc())
        session.add(row)
        await session.flush()
        places = ((StopAction.LOAD, order.from_post), (StopAction.RECEIVE, order.to_post))
        stops = [
            StopRow(id=new_id(), mission_id=row.id, position=position, post=post, action=action, order_id=order.id)
            for position, (action, post) in enumerate(places)
        ]
        session.add_all(stops)
        await session.flush()
        return Mission(id=row.id, update=row.update_number, stops=tuple(stop_of(stop) for stop in stops))

    async def pass_on_cancels(self) -> None:
        """Ask robots to drop the orders that somebody wants to cancel; each is asked once and answers by an event."""
        async with self._fleet.database.reading() as session:
            orders = [order for order in await _to_cancel(session) if not await _was_told(session, order)]
        for order in orders:
            async with self._fleet.database.transaction() as session:
                robot = await session.get_one(RobotRow, order.robot)
                message = Cancel(command_id=new_command_id("cancel"), order_id=order.id)
                await ask(session, self._fleet, robot, message)


async def _look(session: AsyncSession) -> Situation:
    queued = select(Order).where(Order.state == OrderState.QUEUED).order_by(col(Order.created_at), col(Order.id))
    waiting = (await session.exec(queued)).all()
    connected = (await session.exec(select(RobotRow).where(col(RobotRow.online)))).all()
    on_mission = await session.exec(select(MissionRow.robot).where(MissionRow.state == MissionState.ACTIVE))
    # A robot that has mail aboard and no mission any more is no free robot: its mail comes first.
    carrying = await session.exec(select(Order.robot).where(col(Order.state).in_(MAIL_ABOARD)))
    busy = {*on_mission.all(), *carrying.all()}
    idle = [IdleRobot(row.name, row.post, row.battery_ratio) for row in connected if row.name not in busy]
    return Situation(waiting, idle, len(connected))


async def _to_cancel(session: AsyncSession) -> Sequence[Order]:
    wanted = select(Order).where(col(Order.cancel_requested_at).is_not(None), col(Order.state).in_(ROBOT_COMING))
    return (await session.exec(wanted.where(col(Order.robot).is_not(None)))).all()


async def _was_told(session: AsyncSession, order: Order) -> bool:
    told = select(RobotCommand.command_id).filter_by(kind="cancel", order_id=order.id, robot=order.robot)
    return (await session.exec(told)).first() is not None
