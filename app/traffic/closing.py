"""Corridors that people close for all robots, and open again: a wet floor, builders, a line that is taped anew."""

import structlog
from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import Alarm, ClosedCorridor, Person
from app.robots.corridors.closures import ClosedCorridors, found_closed, tell_of_closed
from app.robots.errors import RobotAway, RobotTooOld
from app.robots.service import Fleet, known_robot
from app.traffic.reopening import corridor_on, open_way

log = structlog.get_logger(__name__)


async def close(session: AsyncSession, fleet: Fleet, name: str, reason: str, by: Person) -> ClosedCorridors:
    """Let no robot in any more; one that is in there drives on. Closed again it has another reason. Raises
    NoSuchCorridor."""
    corridor = corridor_on(fleet.campus, name).name
    row = await session.get(ClosedCorridor, corridor)
    if row is None:
        row = ClosedCorridor(corridor=corridor, closed_at=fleet.clock.utc(), closed_by_id=by.id, reason=reason)
        session.add(row)
    row.reason = reason
    log.info("corridor_closed", corridor=corridor, by=by.id)
    return await _told(session, fleet)


async def open_again(session: AsyncSession, fleet: Fleet, name: str, by: Person) -> ClosedCorridors:
    """Robots are let in; one that is open stays so. Raises NoSuchCorridor.

    A robot that turned back there is told so, and its own word ends that: it may have turned back again since. One that
    cannot be told goes round it for its ten minutes, but no other does.
    """
    corridor = corridor_on(fleet.campus, name).name
    row = await session.get(ClosedCorridor, corridor)
    if row is not None:
        await session.delete(row)
    for alarm in (await found_closed(session)).get(corridor, []):
        await _tell(session, fleet, alarm, corridor, by)
    log.info("corridor_opened", corridor=corridor, by=by.id)
    return await _told(session, fleet)


async def _tell(session: AsyncSession, fleet: Fleet, alarm: Alarm, corridor: str, by: Person) -> None:
    robot = await known_robot(session, alarm.robot, to_change=True)
    try:
        await open_way(session, fleet, robot, corridor, by)
    except (RobotAway, RobotTooOld):
        alarm.cleared_at = fleet.clock.utc()


async def _told(session: AsyncSession, fleet: Fleet) -> ClosedCorridors:
    """After the commit: pages see it, and who decides on traffic looks again."""
    closed = await tell_of_closed(session, fleet.feed)
    fleet.have_spoken(session, [""])
    return closed
