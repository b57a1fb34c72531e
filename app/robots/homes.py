"""Homes: each dock or bay is the home of one robot, since no robot sees that another stands in it.

It belongs to the robot that named it first. Another one that names it is refused, and the alarm `same_home` rings
until it names another (decision 0088). A robot with work under way is let in to finish it, and gets no new orders.
"""

from datetime import datetime
from typing import Final

from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import Alarm, RobotRow, RobotToken
from app.orders.stops import active_mission
from app.robots.alarms import clear_alarms, raise_alarm
from app.robots.corridors import reservations
from app.robots.errors import SameHome
from maps import CampusMap
from protocol.to_server import Hello

SAME_HOME: Final = "same_home"

WITHOUT_A_HOME: Final = select(Alarm.robot).where(Alarm.name == SAME_HOME, col(Alarm.cleared_at).is_(None))
"""The robots whose home is another's."""


async def check_home(
    session: AsyncSession, campus: CampusMap, robot: RobotRow, hello: Hello, now: datetime
) -> SameHome | None:
    """Return why this robot is not let in, if so. It is returned, not raised, so that the alarm is committed."""
    owner = await _owner(session, campus, robot.name, hello.home)
    if owner is None:
        await clear_alarms(session, robot.name, SAME_HOME, now)
        return None
    sentence = (
        f"its home {hello.home} is that of {owner}, too: give it another in its settings, "
        "or take back the other robot's token"
    )
    await raise_alarm(session, robot.name, SAME_HOME, sentence, now=now)
    return None if await _is_at_work(session, robot.name, hello) else SameHome(sentence)


def note_home(robot: RobotRow, campus: CampusMap, hello: Hello) -> None:
    """Take over what it says. A bay is at home at its post for everybody but the traffic."""
    robot.home = hello.home and campus.address_of(hello.home)
    robot.home_bay = hello.home if hello.home != robot.home else None


async def _owner(session: AsyncSession, campus: CampusMap, robot: str, home: str | None) -> str | None:
    """The other robot whose home this is. One without a valid token does not come any more."""
    if campus.track.home_at(home) != home or home is None:
        return None
    may_come = select(RobotToken.robot).where(col(RobotToken.revoked_at).is_(None))
    named = RobotRow.home if campus.address_of(home) == home else RobotRow.home_bay
    others = select(RobotRow.name).where(named == home, RobotRow.name != robot)
    owners = others.where(col(RobotRow.name).in_(may_come), col(RobotRow.name).not_in(WITHOUT_A_HOME))
    return (await session.exec(owners.order_by(RobotRow.name))).first()


async def _is_at_work(session: AsyncSession, robot: str, hello: Hello) -> bool:
    """Mail, stops or corridors that no other robot can take over while this one is not heard."""
    if hello.cargo or hello.mission is not None:
        return True
    return await active_mission(session, robot) is not None or bool(await reservations.held_by(session, robot))
