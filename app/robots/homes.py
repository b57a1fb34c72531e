"""Homes: each dock or bay is the home of one robot, since no robot sees that another stands in it.

On a map with bays the service gives them: a robot keeps the one that it has, or gets the one that it names or stands
in, if that is free, or the first that is free; where none is left it is refused with the reason. A robot that is older
than that, and every robot on a map without bays, names its home itself. It belongs to the robot that named it first:
another one is refused, and the alarm `same_home` rings until it names another (decision 0088). A robot with work under
way is let in to finish it, and gets no new orders.
"""

from collections.abc import Sequence
from datetime import datetime
from typing import Final

from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import Alarm, RobotRow, RobotToken
from app.orders.stops import active_mission
from app.robots.alarms import clear_alarms, raise_alarm
from app.robots.corridors import reservations
from app.robots.errors import NoHomeLeft, SameHome
from maps import CampusMap
from protocol.to_server import Hello

SAME_HOME: Final = "same_home"

WITHOUT_A_HOME: Final = select(Alarm.robot).where(Alarm.name == SAME_HOME, col(Alarm.cleared_at).is_(None))
"""The robots whose home is another's."""
GIVEN: Final = "home"
"""In `hello.understands`: the robot takes its home from the service."""


async def check_home(
    session: AsyncSession, campus: CampusMap, robot: RobotRow, hello: Hello, now: datetime
) -> SameHome | NoHomeLeft | None:
    """Return why this robot is not let in, if so. It is returned, not raised, so that the alarm is committed."""
    if campus.track.home_bays and GIVEN in hello.understands:
        given = await free_home(session, campus, robot.name, _wanted(robot, hello))
        refusal = _no_home_left(campus) if given is None else None
        return None if refusal and await _is_at_work(session, robot.name, hello) else refusal
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


async def note_home(session: AsyncSession, campus: CampusMap, robot: RobotRow, hello: Hello) -> str | None:
    """Write down its home; return it if the service gives it. One without a dock is a home for the traffic alone: a
    robot does not charge there."""
    given = None
    if campus.track.home_bays and GIVEN in hello.understands:
        given = await free_home(session, campus, robot.name, _wanted(robot, hello))
    home = given or hello.home
    place = campus.track.posts.get(home or "")
    if place is not None and place.bay_of:
        robot.home_bay, robot.home = place.name, place.bay_of if place.dock else None
    else:
        robot.home_bay, robot.home = None, home
    return given


def _wanted(robot: RobotRow, hello: Hello) -> tuple[str | None, ...]:
    """The home that it has, the one that it names, and the bay in which it stands, if it can be one."""
    return robot.home_bay, hello.home, hello.position.post


async def free_home(session: AsyncSession, campus: CampusMap, robot: str, wanted: Sequence[str | None]) -> str | None:
    """The first of the wanted homes that is no other robot's, else any; None if every one is."""
    may_come = select(RobotToken.robot).where(col(RobotToken.revoked_at).is_(None))
    theirs = select(RobotRow.home_bay).where(RobotRow.name != robot, col(RobotRow.name).in_(may_come))
    taken = set((await session.exec(theirs)).all())
    free = [home.name for home in campus.track.home_bays if home.name not in taken]
    return next((home for home in wanted if home in free), free[0] if free else None)


async def no_room(session: AsyncSession, campus: CampusMap, robot: str) -> str | None:
    """The reason why a robot cannot be enrolled, if the map has no home for it."""
    if not campus.track.home_bays or await free_home(session, campus, robot, ()):
        return None
    reason = str(_no_home_left(campus))
    return f"{reason[0].upper()}{reason[1:]}."


def _no_home_left(campus: CampusMap) -> NoHomeLeft:
    homes = len(campus.track.home_bays)
    return NoHomeLeft(
        f"the map {campus.name} has {homes} home{'s' if homes > 1 else ''}, and each is another robot's: add a bay "
        "with home = true, or take back the token of a robot that does not come any more"
    )


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
