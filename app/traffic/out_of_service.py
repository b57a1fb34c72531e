"""A person has looked where a robot was: its corridors are given to others, and it takes no part in the traffic.

It is one of them again when it has heard so, and then knows where it is. Until it has heard, `taken_out_at` says so;
after that it has no place until it has found one.
"""

import structlog
from sqlmodel import col, update
from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import GrantRow, Person, RobotCommand, RobotRow
from app.robots.alarms import VANISHED, clear_alarms
from app.robots.commands import REVOKE, ask, new_command_id, note
from app.robots.corridors.occupancies import forget_occupancy
from app.robots.corridors.occupied import tell_of_traffic
from app.robots.corridors.reservations import forget_what_waits
from app.robots.errors import RobotGoesOn, RobotTooOld
from app.robots.service import Fleet
from protocol.parts import Activity
from protocol.to_robot import Revoke

log = structlog.get_logger(__name__)


async def take_out(session: AsyncSession, fleet: Fleet, robot: RobotRow, reason: str, by: Person) -> RobotCommand:
    """Free whatever it holds, and tell it so, now or when it is back. Raises RobotGoesOn, RobotTooOld."""
    _check(fleet, robot)
    now = fleet.clock.utc()
    request = Revoke(command_id=new_command_id(REVOKE), reason=reason)
    tell = fleet.connections.is_seated(robot.name)
    row = await ask(session, fleet, robot, request, by.id) if tell else note(session, fleet, robot, request, by.id)
    held = update(GrantRow).where(col(GrantRow.robot) == robot.name, col(GrantRow.cleared_at).is_(None))
    freed = await session.exec(held.values(cleared_at=now, freed_by=request.command_id))
    await forget_what_waits(session, robot.name, "a person has given its corridors to others")
    await forget_occupancy(session, robot.name)
    robot.taken_out_at, robot.waits_for = now, None
    await clear_alarms(session, robot.name, VANISHED, now)
    await session.flush()
    await tell_of_traffic(session, fleet.feed, robot.name)
    fleet.announce(session, robot)
    log.info("robot_taken_out", robot=robot.name, by=by.id, reason=reason, corridors=freed.rowcount)
    return row


def _check(fleet: Fleet, robot: RobotRow) -> None:
    if not fleet.connections.is_seated(robot.name):
        return
    if robot.activity != Activity.STOPPED:
        raise RobotGoesOn(f"Robot {robot.name} is there and may drive. Stop it at once first.")
    if not fleet.connections.understands(robot.name, REVOKE):
        raise RobotTooOld(f"The software of robot {robot.name} is too old to be told so. Switch it off first.")
