"""A dispatcher has looked: a corridor that a robot took for closed is free again."""

from typing import Final

from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import Person, RobotCommand, RobotRow
from app.robots.commands import ask, new_command_id
from app.robots.errors import NoSuchCorridor, RobotAway, RobotTooOld
from app.robots.link.clocks import by_its_clock
from app.robots.service import Fleet
from maps import CampusMap, Corridor, UnknownCorridor
from protocol.to_robot import OpenWay

OPEN_WAY: Final = "open_way"
BY_ITSELF: Final = "It tries the corridor again by itself, ten minutes after it turned back there."


def corridor_on(campus: CampusMap, name: str) -> Corridor:
    """Raises NoSuchCorridor."""
    try:
        return campus.track.corridor_named(name)
    except UnknownCorridor as problem:
        raise NoSuchCorridor(f"{problem}.") from None


async def open_way(
    session: AsyncSession, fleet: Fleet, robot: RobotRow, corridor: str, dispatcher: Person
) -> RobotCommand:
    """Tell the robot so. Raises NoSuchCorridor, RobotAway, RobotTooOld."""
    way = corridor_on(fleet.campus, corridor)
    if not fleet.connections.is_seated(robot.name):
        raise RobotAway(f"Robot {robot.name} has no network just now. {BY_ITSELF}")
    if not fleet.connections.understands(robot.name, OPEN_WAY):
        raise RobotTooOld(f"The software of robot {robot.name} is too old to be told so. {BY_ITSELF}")
    request = OpenWay(
        command_id=new_command_id("open-way"),
        ends=(way.a, way.b),
        # It is the robot that judges whether it knows better.
        looked_at=by_its_clock(fleet.clock.utc(), robot.clock_off_s),
    )
    return await ask(session, fleet, robot, request, dispatcher.id)
