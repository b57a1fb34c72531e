"""Sends robots that have nothing to do and no dock of their own to a dock, and calls them away again for work.

Who goes where is decided in `fleet.charging`. Here is one look at the database, and one transaction for each robot that
is sent. No robot is sent to an occupied dock: another stands in it or is on its way to it, or it is a robot's own.
A robot that could leave one is sent to park (`dock_room`).
"""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from typing import Final

import structlog
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.charging.dock_room import leaving, parking
from app.charging.errands import send_on_errand
from app.charging.free_docks import UNTIL_RATIO, docks_of, driving_there, shared_docks, taken_docks
from app.core.polling import PollingLoop
from app.dispatch.charge_limits import LEAVES_DOCK, THRESHOLDS, Charges
from app.dispatch.open_work import OpenWork, RobotNow, StopNow, read_open_work
from app.models import MissionRow, MissionState, Order, RobotRow, StopRow
from app.robots.energy_use import usual_rates
from app.robots.mission_updates import tell_mission
from app.robots.service import Fleet, known_robot
from fleet.charging.curve import ASSUMED
from fleet.charging.demand import Demand
from fleet.charging.docks import Need, plan_docks
from fleet.charging.energy import Use
from fleet.charging.going_on import Charge
from fleet.charging.top_ups import Move, TopUpPolicy, top_ups
from protocol.ids import new_id
from protocol.parts import StopAction

POLL_EVERY_S: Final = 5.0
"""Real seconds: charges change slowly."""
REST_S: Final = 0.5
"""Real seconds, between two polls: a robot that is called away has a way to drive."""
LEARNED_FROM: Final = timedelta(days=28)
_HOUR: Final = timedelta(hours=1)

log = structlog.get_logger(__name__)


@dataclass
class ChargingService:
    """Runs in the background of the service, if traffic goes by the schedule."""

    fleet: Fleet
    _demand: Demand = field(default_factory=Demand)
    _learned_at: datetime | None = None
    polling: PollingLoop = field(default_factory=lambda: PollingLoop(POLL_EVERY_S, REST_S))

    def wake(self, _changed: str = "") -> None:
        """Poll soon: an order has changed, so that a robot may be needed elsewhere."""
        self.polling.wake()

    def stop(self) -> None:
        """End `run` after what it is doing."""
        self.polling.stop()

    async def run(self) -> None:
        """Until stopped or cancelled."""
        async for _ in self.polling.until_stopped():
            await self.poll()

    async def poll(self) -> None:
        """Call away who is wanted, and send who has nothing to do."""
        now = self.fleet.clock.utc()
        async with self.fleet.database.reading() as session:
            await self._learn(session, now)
            work = await read_open_work(session, now)
        for stop in self._in_the_way(work):
            await self._call_away(stop)
        for stop in self._awaited(work):
            await self._let_leave_sooner(stop)
        moves, leave = self._moves(work, now)
        for move in moves:
            await self._send(move, now)
        for robot in leave:
            await self._park(robot, now)

    async def _learn(self, session: AsyncSession, now: datetime) -> None:
        """Once an hour, when orders come."""
        hour = now.replace(minute=0, second=0, microsecond=0)
        if self._learned_at == hour:
            return
        self._demand, self._learned_at = Demand(), hour
        recent = select(Order.created_at).where(col(Order.created_at) >= hour - LEARNED_FROM)
        came = Counter(
            at.replace(minute=0, second=0, microsecond=0) for at in (await session.exec(recent)).all() if at < hour
        )
        at = min(came, default=hour)
        while at < hour:
            self._demand.learn(self._local(at), came[at])
            at += _HOUR

    # What is decided.

    def _moves(self, work: OpenWork, now: datetime) -> tuple[list[Move], set[str]]:
        """To docks that are free; and who leaves one."""
        docks = shared_docks(self.fleet.orders.ledger.ways, work)
        needs = {robot.name: self._need(robot, work, docks) for robot in work.robots.values() if _needs_one(robot)}
        resting = [need for name, need in needs.items() if self._may_be_sent(work.robots[name], work)]
        low = driving_there(self.fleet.orders.ledger.ways, work)
        plan = plan_docks(list(needs.values()), docks, ASSUMED, THRESHOLDS, self.fleet.clock.now())
        here = self._local(now)
        policy = TopUpPolicy(self._demand.is_quiet(here), round(self._demand.expected(here)))
        in_docks = {need.dock: need.robot for need in resting if need.dock is not None}
        awaited = {dock for name, dock in low.items() if needs.get(name) not in resting}
        taken = {dock: in_docks.get(dock) for dock in (*taken_docks(work), *awaited)}
        found = top_ups(resting, plan, taken, THRESHOLDS, policy, self.fleet.clock.now())
        leave = leaving([move for move in found if move.dock in taken], needs, in_docks, low.values())
        return [move for move in found if move.dock not in taken], set(leave)

    def _local(self, moment: datetime) -> datetime:
        """Hours of the week are those of the people who send mail."""
        return moment.astimezone(self.fleet.settings.zone)

    def _need(self, robot: RobotNow, work: OpenWork, docks: list[str]) -> Need:
        speed_m_s, length_m = self.fleet.settings.assumed_speed_m_s, self.fleet.orders.ledger.ways.length_m
        rates = self.fleet.spending.rates.get(robot.name, usual_rates())
        way_m = {dock: length_m(robot.post, dock) for dock in docks if length_m(robot.post, dock) < float("inf")}
        ways = {dock: Use(way, way / speed_m_s) for dock, way in way_m.items()}
        dock = next((one for one in docks_of(robot, work) if one in docks), None)
        charge = Charge(robot.battery_ratio or 0.0, rates)
        return Need(robot.name, charge, self.fleet.clock.now(), ways, dock, THRESHOLDS.begin + THRESHOLDS.hysteresis)

    def _may_be_sent(self, robot: RobotNow, work: OpenWork) -> bool:
        is_free = robot.takes_work and robot.name not in work.missions
        return is_free and self.fleet.connections.understands(robot.name, UNTIL_RATIO)

    def _in_the_way(self, work: OpenWork) -> Iterator[StopNow]:
        """Stops to charge or to park at, of robots that have got work meanwhile and have enough for it."""
        charges = Charges(self.fleet.orders.ledger.ways, self.fleet.settings, self.fleet.spending.rates)
        for name, stops in work.stops.items():
            posts, robot = [stop.post for stop in stops if stop.order_id], work.robots[name]
            if posts and (robot.battery_ratio or 0.0) >= charges.needed(robot, posts):
                yield from (stop for stop in stops if stop.order_id is None)

    def _awaited(self, work: OpenWork) -> Iterator[StopNow]:
        """Charges in docks to which a robot drives that has hardly anything left, occupied or not."""
        docks = set(driving_there(self.fleet.orders.ledger.ways, work).values())
        for name, stops in work.stops.items():
            robot = work.robots[name]
            if robot.docked and robot.post in docks:
                yield from (stop for stop in stops[:1] if stop.action == StopAction.DOCK and stop.post == robot.post)

    # How it is written.

    async def _send(self, move: Move, now: datetime) -> None:
        until = THRESHOLDS.full if self._demand.is_quiet(self._local(now)) else THRESHOLDS.sufficient
        async with self.fleet.database.transaction() as session:
            robot = await known_robot(session, move.robot, to_change=True)
            work = await read_open_work(session, now)
            if self._may_be_sent(work.robots[move.robot], work) and move.dock not in taken_docks(work):
                stop = StopRow(id=new_id(), mission_id=new_id(), position=0, post=move.dock, action=StopAction.DOCK)
                stop.until_ratio = until
                await send_on_errand(session, self.fleet, robot, stop)
                log.info("sent_to_charge", robot=move.robot, dock=move.dock, until_ratio=until)

    async def _park(self, name: str, now: datetime) -> None:
        async with self.fleet.database.transaction() as session:
            robot = await known_robot(session, name, to_change=True)
            work = await read_open_work(session, now)
            post = self._place_to_park(robot, work)
            if post is not None and self._may_be_sent(work.robots[name], work) and robot.docked:
                stop = StopRow(id=new_id(), mission_id=new_id(), position=0, post=post, action=StopAction.PARK)
                await send_on_errand(session, self.fleet, robot, stop)
                log.info("makes_room_in_dock", robot=name, dock=robot.post, post=post)

    def _place_to_park(self, robot: RobotRow, work: OpenWork) -> str | None:
        if robot.home_bay is not None:
            return self.fleet.campus.address_of(robot.home_bay)
        return parking(self.fleet.campus, work, work.robots[robot.name], self.fleet.orders.ledger.ways)

    async def _let_leave_sooner(self, stop: StopNow) -> None:
        """With half a charge it can come again later."""
        async with self.fleet.database.transaction() as session:
            robot = await known_robot(session, stop.robot, to_change=True)
            row = await session.get_one(StopRow, stop.id, with_for_update=True)
            mission = await session.get_one(MissionRow, stop.mission_id, with_for_update=True)
            is_over = row.done_at is not None or row.dropped_at is not None or mission.state != MissionState.ACTIVE
            if is_over or row.until_ratio is None or row.until_ratio <= LEAVES_DOCK:
                return
            row.until_ratio = LEAVES_DOCK
            mission.update_number += 1
            await session.flush()
            await tell_mission(session, self.fleet, robot, mission)
            log.info("leaves_dock_sooner", robot=stop.robot, dock=stop.post)

    async def _call_away(self, stop: StopNow) -> None:
        """Work was given only where there is the charge for it: it does not wait for more."""
        async with self.fleet.database.transaction() as session:
            robot = await known_robot(session, stop.robot, to_change=True)
            row = await session.get_one(StopRow, stop.id, with_for_update=True)
            mission = await session.get_one(MissionRow, stop.mission_id, with_for_update=True)
            still = list(self._in_the_way(await read_open_work(session, self.fleet.clock.utc())))
            if all(one.id != stop.id for one in still):
                return
            row.dropped_at = self.fleet.clock.utc()
            mission.update_number += 1
            await session.flush()
            await tell_mission(session, self.fleet, robot, mission)
            log.info("called_away", robot=stop.robot, post=stop.post)


def _needs_one(robot: RobotNow) -> bool:
    """One with a dock of its own needs no other, but may stand in one."""
    stays_out = robot.home is None or (robot.docked and robot.post != robot.home)
    return bool(robot.is_there and stays_out and robot.post is not None and robot.battery_ratio is not None)
