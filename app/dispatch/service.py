"""Gives waiting orders to robots, and tells robots what has changed for them. Woken after commits, by orders and robots
alike, and at the start of the service.

Everything it needs to know is in the database and everything it decides is one transaction, so that it can be stopped
at any moment: a mission that was decided on is in the robot's outbox and is sent until it is acknowledged.
"""

import asyncio
from contextlib import suppress
from typing import Final

from app.core.polling import LONGEST_REST_S, REST
from app.dispatch.fleet_planner import FleetPlanner
from app.dispatch.waiting_work import PendingWork, read_pending_work
from app.models import MissionRow, RobotRow
from app.orders.custody.by_hand import is_taken_out_by_hand
from app.robots.commands import ask, new_command_id, unanswered
from app.robots.mission_updates import tell_mission
from app.robots.service import Fleet
from protocol.to_robot import Cancel

POLL_AGAIN_S: Final = 30.0
"""Real seconds. Nothing should be missed between two wakes; if it is after all, it does not wait for ever."""
NOBODY_FREE_S: Final = 0.1
"""Real seconds. While orders wait for robots, looking more often finds nothing new and takes time from what is."""


class Dispatcher:
    """Runs in the background of the service. `rest_s`: real seconds between two looks while orders wait for robots; of
    long looks a multiple."""

    def __init__(self, fleet: Fleet, planner: FleetPlanner) -> None:
        self._fleet = fleet
        self._planner = planner
        self.rest_s = NOBODY_FREE_S
        self._woken = asyncio.Event()
        self._stopped = asyncio.Event()
        self._needs_robots = True

    def wake(self, changed: str = "") -> None:
        """An order has changed: look again, unless that is what was just decided here."""
        if changed in self._planner.own:
            self._planner.own.discard(changed)
        else:
            self._woken.set()

    def wake_for_robot(self, _changed: str = "") -> None:
        """A robot has changed: look again, if anything was left for which no robot was there."""
        if self._needs_robots:
            self._woken.set()

    def stop(self) -> None:
        """End `run` after what it is doing."""
        self._stopped.set()
        self.wake()

    async def run(self) -> None:
        """Until stopped or cancelled."""
        while not self._stopped.is_set():
            self._woken.clear()
            self._needs_robots = True  # what changes from here on may come too late for this look
            begun_s = asyncio.get_running_loop().time()
            self._needs_robots = await self.poll()
            if self._needs_robots and not self._stopped.is_set():
                took_s = asyncio.get_running_loop().time() - begun_s
                with suppress(TimeoutError):
                    async with asyncio.timeout(max(self.rest_s, min(REST * took_s, LONGEST_REST_S))):
                        await self._stopped.wait()
            try:
                async with asyncio.timeout(POLL_AGAIN_S):
                    await self._woken.wait()
            except TimeoutError:
                pass

    async def poll(self) -> bool:
        """Do what there is to do; whether anything is left that waits for a robot."""
        async with self._fleet.database.asking() as connection:
            pending = await read_pending_work(connection, self._fleet.clock.utc())
        await self._pass_on(pending)
        if pending.waits:
            while await self._planner.assign():
                pass
        return (pending.waits and self._planner.left > 0) or bool(pending.changed)

    # What has changed for robots.

    async def _pass_on(self, pending: PendingWork) -> None:
        """Tell robots what to drop, and missions that have changed; each is told once, in a transaction of its own."""
        for order_id in pending.dropped:
            await self._tell_to_drop(order_id)
        for mission_id in pending.changed:
            await self._tell_change(mission_id)

    async def _tell_to_drop(self, order_id: str) -> None:
        async with self._fleet.database.transaction() as session:
            order = await self._fleet.orders.ledger.order(session, order_id)
            robot = await session.get(RobotRow, order.let_go_by or "", with_for_update=True)
            order.let_go_by = None
            if robot is not None:
                # What a person has taken out by hand, the robot only has to forget.
                by_hand = await is_taken_out_by_hand(session, order)
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
