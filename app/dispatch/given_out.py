"""A decision of the planner as missions: what each robot is to do now, in one transaction, and robots are told.

It was made by a look that is past. What it changes must still be as it was then; else nothing of it is written.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Final

import structlog
from sqlmodel.ext.asyncio.session import AsyncSession

from app.dispatch.open_work import OpenWork, OrderNow, StopNow, read_part
from app.models import MissionRow, OrderState, RobotRow, StopRow
from app.orders.changes.intervening import REASSIGNED
from app.orders.service import Actor
from app.orders.stops import stops_left
from app.orders.transitions import By
from app.robots.mission_updates import tell_mission
from app.robots.service import Fleet, known_robot
from fleet.assignment.deciding import Decision
from protocol.ids import new_id
from protocol.parts import StopAction

ACTIONS: Final = {1: StopAction.LOAD, -1: StopAction.RECEIVE}

log = structlog.get_logger(__name__)


@dataclass(frozen=True)
class NewStop:
    """One that is written down with the order."""

    action: StopAction
    order: OrderNow

    @property
    def post(self) -> str:
        return self.order.from_post if self.action is StopAction.LOAD else self.order.to_post


@dataclass(frozen=True)
class Changes:
    """The changes of a decision. `routes`: the ids of all stops of a robot, in their order; `new`: those of them that
    are not written down yet; `given`: orders that waited, to robots; `taken`: orders that are to leave their robots."""

    work: OpenWork
    routes: Mapping[str, Sequence[str]]
    new: Mapping[str, NewStop]
    given: Mapping[str, str]
    taken: Sequence[str]

    def __bool__(self) -> bool:
        return bool(self.routes or self.taken)

    async def still_hold(self, session: AsyncSession, now: datetime) -> bool:
        """Tell if all that they begin with is as it was."""
        then = self.work
        names = {*self.routes, *(then.orders[order].robot or "" for order in self.taken)}
        theirs = (order.id for order in then.orders.values() if order.robot in names)
        work = await read_part(session, now, names, {*self.given, *theirs})
        are_there = all(work.orders.get(order) == then.orders[order] for order in self.given)
        return are_there and all(_before(work, name) == _before(then, name) for name in names)


def _before(work: OpenWork, name: str) -> tuple[object, ...]:
    """Return all that counts of a robot and of what it has before it."""
    robot = work.robots.get(name)
    may = None if robot is None else (robot.takes_work, robot.gives_away)
    orders = {order.id: order for order in work.orders.values() if order.robot == name}
    return may, work.missions.get(name), work.stops.get(name), orders


def changes_of(work: OpenWork, decision: Decision) -> Changes:
    """Return the changes of this decision. An order that another robot has is taken from that one first, and given
    anew once it waits again: a robot out of network must not load what another fetches."""
    robot_of = decision.robot_of()
    given = {order.id: robot_of[order.id] for order in work.waiting if order.id in robot_of}
    taken = [
        order
        for order, robot in robot_of.items()
        if order not in given and work.orders[order].robot not in (robot, None)
    ]
    new = {
        stop.goal.key: NewStop(ACTIONS[stop.change], work.orders[stop.order])
        for route in decision.routes.values()
        for stop in route
        if stop.order in given
    }
    routes = {}
    for name, route in decision.routes.items():
        had = work.stops.get(name, ())
        wanted = _reordered(had, [stop.goal.key for stop in route], new)
        if wanted != [stop.id for stop in had]:
            routes[name] = wanted
    return Changes(work, routes, new, given, taken)


def _reordered(had: Sequence[StopNow], planned: Sequence[str], new: Mapping[str, NewStop]) -> list[str]:
    """Return the ids of a robot's stops: what was planned, then the others in the order that they had.

    An order of which only one stop was planned (no way leads to the other) counts as not planned: else its mail would
    be given before it is loaded.
    """
    split = {stop.order_id for stop in had if stop.id not in planned} - {None}
    movable = {stop.id for stop in had if stop.order_id not in split}
    wanted = [key for key in planned if key in new or key in movable]
    return wanted + [stop.id for stop in had if stop.id not in wanted]


async def give_out(session: AsyncSession, fleet: Fleet, changes: Changes, own: set[str]) -> bool:
    """Write it down, and tell robots; False if it does not hold any more. `own`: orders that are given here."""
    # Locked before the read: no other writer gives them a mission between the two.
    robots = [await known_robot(session, name, to_change=True) for name in sorted(changes.routes)]
    if not await changes.still_hold(session, fleet.clock.utc()):
        return False
    by_robot = _by_robot(changes.given)
    for robot in robots:
        await _change_mission(session, fleet, changes, robot, by_robot.get(robot.name, ()), own)
    for order_id in changes.taken:
        await _take(session, fleet, order_id)
    return True


async def _change_mission(
    session: AsyncSession, fleet: Fleet, changes: Changes, robot: RobotRow, given: Iterable[str], own: set[str]
) -> None:
    name = robot.name
    mission = await _mission(session, fleet, name, changes.work.missions.get(name))
    left = {stop.id: stop for stop in await stops_left(session, mission.id)}
    for position, key in enumerate(changes.routes[name]):
        if key in left:
            left[key].position = position
        else:
            session.add(_stop(mission, changes.new[key], key, position, fleet.settings.wait_limit_s))
    await session.flush()
    for order_id in given:
        own.add(order_id)
        await fleet.orders.ledger.move(session, order_id, OrderState.ASSIGNED, Actor(By.DISPATCHER, robot=name))
        log.info("assigned", order=order_id, robot=name)
    await tell_mission(session, fleet, robot, mission)


async def _mission(session: AsyncSession, fleet: Fleet, robot: str, mission_id: str | None) -> MissionRow:
    if mission_id is None:
        mission = MissionRow(id=new_id(), robot=robot, created_at=fleet.clock.utc())
        session.add(mission)
        await session.flush()
        return mission
    mission = await session.get_one(MissionRow, mission_id)
    if mission.told_update:
        mission.update_number += 1
    return mission


def _stop(mission: MissionRow, new: NewStop, key: str, position: int, wait_limit_s: float) -> StopRow:
    return StopRow(
        id=key,
        mission_id=mission.id,
        position=position,
        post=new.post,
        action=new.action,
        order_id=new.order.id,
        wait_limit_s=wait_limit_s,
        since_update=mission.update_number,
    )


async def _take(session: AsyncSession, fleet: Fleet, order_id: str) -> None:
    """Its robot is told to let it go, and answers; until then no other robot fetches it."""
    order = await fleet.orders.ledger.order(session, order_id)
    order.reassign_requested_at, order.let_go_by = fleet.clock.utc(), order.robot
    log.info("taken_from", order=order_id, robot=order.robot)
    await fleet.orders.ledger.note(session, order_id, REASSIGNED, Actor(By.DISPATCHER))


def _by_robot(given: Mapping[str, str]) -> dict[str, list[str]]:
    by_robot: dict[str, list[str]] = {}
    for order_id, robot in given.items():
        by_robot.setdefault(robot, []).append(order_id)
    return by_robot
