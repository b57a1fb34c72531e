"""Errands of a robot without work: a mission of one stop, to charge or to park."""

from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import MissionRow, RobotRow, StopRow
from app.robots.mission_updates import tell_mission
from app.robots.service import Fleet


async def send_on_errand(session: AsyncSession, fleet: Fleet, robot: RobotRow, stop: StopRow) -> None:
    """Give the robot a mission of this one stop, under the stop's `mission_id`."""
    mission = MissionRow(id=stop.mission_id, robot=robot.name, created_at=fleet.clock.utc())
    session.add(mission)
    await session.flush()
    session.add(stop)
    await session.flush()
    await tell_mission(session, fleet, robot, mission)
