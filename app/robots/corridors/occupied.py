"""Which robot holds which corridor, and what each reports to be in, as people may see it: those who look after robots
all of it, others what concerns a robot that has an order of theirs."""

from collections.abc import Iterable, Iterator
from datetime import datetime
from functools import partial

from pydantic import BaseModel
from sqlmodel import col, or_, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.database.database import after_commit
from app.models import GrantRow, OccupancyRow, Order, Person, Role
from app.orders.transitions import ENDED
from app.realtime.feed import Feed, FeedEvent
from protocol.to_server import Where

SEE_ALL = (Role.DISPATCHER, Role.MAINTAINER)


class OccupiedCorridor(BaseModel):
    """A corridor that a robot may be in, in its direction, since it was let in; until the robot says that it is out."""

    robot: str
    corridor: str
    from_post: str
    to_post: str
    since: datetime


class ReportedPlace(BaseModel):
    """What a robot reports to be wholly in, on maps with bays.

    The bay `place`, the crossing of the post `place`, or the corridor from `place` to `towards`."""

    robot: str
    kind: Where
    place: str
    towards: str | None
    at: datetime


class Traffic(BaseModel):
    """Every corridor that is taken, by robot, each robot's in the order in which it was granted them; and what each
    robot reports to be in."""

    taken: list[OccupiedCorridor]
    reported: list[ReportedPlace]


class RobotTraffic(BaseModel):
    """Every corridor that this robot holds now, and what it reports to be in: both replace what was known of it."""

    robot: str
    taken: list[OccupiedCorridor]
    reported: ReportedPlace | None


async def traffic_for(session: AsyncSession, person: Person) -> Traffic:
    """Return what this person may see of it."""
    held, reported = select(GrantRow).where(col(GrantRow.cleared_at).is_(None)), select(OccupancyRow)
    if not any(person.has_role(role) for role in SEE_ALL):
        robots = await _robots_of(session, person)
        held, reported = (
            held.where(col(GrantRow.robot).in_(robots)),
            reported.where(col(OccupancyRow.robot).in_(robots)),
        )
    rows = (await session.exec(held.order_by(col(GrantRow.robot), col(GrantRow.id)))).all()
    places = (await session.exec(reported.order_by(OccupancyRow.robot))).all()
    return Traffic(taken=list(_each_once(rows)), reported=[_reported(row) for row in places])


async def tell_of_traffic(session: AsyncSession, feed: Feed, robot: str) -> None:
    """After the commit: pages of those who may see it know what this robot holds now."""
    if not feed.is_heard:
        after_commit(session, feed.pass_over)
        return
    held = select(GrantRow).where(GrantRow.robot == robot, col(GrantRow.cleared_at).is_(None))
    rows = (await session.exec(held.order_by(col(GrantRow.id)))).all()
    place = (await session.exec(select(OccupancyRow).where(OccupancyRow.robot == robot))).one_or_none()
    news = RobotTraffic(robot=robot, taken=list(_each_once(rows)), reported=place and _reported(place))
    people = await _people_of(session, robot)
    theirs = [FeedEvent("traffic", news, person_id=person_id) for person_id in sorted(people)]
    by_role = [FeedEvent("traffic", news, role=role, except_for=people) for role in SEE_ALL]
    for happening in (*theirs, *by_role):
        after_commit(session, partial(feed.publish, happening))


def _reported(row: OccupancyRow) -> ReportedPlace:
    return ReportedPlace.model_validate(row, from_attributes=True)


async def _robots_of(session: AsyncSession, person: Person) -> set[str]:
    mine = or_(col(Order.sender_id) == person.id, col(Order.recipient_id) == person.id)
    wanted = select(Order.robot).where(mine, col(Order.state).not_in(ENDED), col(Order.robot).is_not(None))
    return {robot for robot in (await session.exec(wanted)).all() if robot is not None}


async def _people_of(session: AsyncSession, robot: str) -> frozenset[str]:
    wanted = select(Order.sender_id, Order.recipient_id).where(Order.robot == robot, col(Order.state).not_in(ENDED))
    return frozenset(person for pair in (await session.exec(wanted)).all() for person in pair)


def _each_once(rows: Iterable[GrantRow]) -> Iterator[OccupiedCorridor]:
    """A corridor that was granted again while it was held is held since the first time."""
    seen = set()
    for row in rows:
        way = (row.robot, row.from_post, row.to_post)
        if way not in seen:
            seen.add(way)
            yield OccupiedCorridor(
                robot=row.robot,
                corridor=row.corridor,
                from_post=row.from_post,
                to_post=row.to_post,
                since=row.granted_at,
            )
