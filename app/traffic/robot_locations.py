"""Where every robot is and what it wishes, as the database has it: all that the schedule is made from."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from sqlmodel import and_, case, col, func, select, tuple_
from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import ClaimRow, GrantRow, MissionRow, MissionState, OccupancyRow, RobotRow, StopRow
from app.robots.corridors.closures import closed_names
from app.traffic.lent_docks import with_lent_docks
from app.traffic.snapshot import OF_ITS_OWN, Hold, Occupied, ReservationRequest, RobotLocation, Stop, TrafficSnapshot
from fleet.charging.curve import FULL
from maps import CampusMap
from protocol.parts import Activity, StopAction


async def read_traffic(session: AsyncSession, campus: CampusMap) -> TrafficSnapshot:
    """Five questions, whatever the number of robots. On a map with bays no place is known but by the robot's report."""
    has_bays = campus.track is not campus
    placed = select(RobotRow).where(col(RobotRow.post).is_not(None), col(RobotRow.taken_out_at).is_(None))
    rows = (await session.exec(placed.order_by(RobotRow.name))).all()
    holds, wishes, goals = await _holds(session), await _requests(session, campus), await _goals(session)
    occupied = await _occupied(session, campus.track)
    closed = await closed_names(session)
    robots = {
        row.name: _robot_location(
            campus,
            row,
            tuple(holds.get(row.name, ())),
            wishes.get(row.name),
            tuple(goals.get(row.name, ())),
            occupied.get(row.name),
        )
        for row in rows
        if row.post in campus.posts and (not has_bays or row.name in occupied)
    }
    return TrafficSnapshot(with_lent_docks(campus.track, robots), closed)


async def where_they_left(session: AsyncSession, snapshot: TrafficSnapshot) -> TrafficSnapshot:
    """Robots that have left a corridor since they were last seen stand where they left it. For a schedule that is made
    anew: one that was there at the time has heard of it."""
    left = {row.robot: row for row in (await session.exec(_LAST_LEFT)).all()}
    robots = {name: _where_it_left(one, left.get(name)) for name, one in snapshot.robots.items()}
    return replace(snapshot, robots=robots)


def _where_it_left(one: RobotLocation, last: GrantRow | None) -> RobotLocation:
    if last is None or last.left_at is None or last.cleared_at is None:
        return one
    is_news = one.seen_at is None or one.seen_at < last.cleared_at
    return replace(one, post=last.left_at) if is_news else one


async def left_at(session: AsyncSession, grant_ids: Sequence[int]) -> dict[int, str]:
    """Where robots stood when they were clear of these."""
    rows = (await session.exec(select(GrantRow).where(col(GrantRow.id).in_(grant_ids)))).all() if grant_ids else ()
    return {row.id or 0: row.left_at or row.to_post for row in rows}


def _robot_location(
    campus: CampusMap,
    row: RobotRow,
    holds: tuple[Hold, ...],
    request: ReservationRequest | None,
    goals: tuple[Stop, ...],
    occupies: Occupied | None,
) -> RobotLocation:
    post = row.post or ""
    named = campus.address_of(row.home_bay) if row.home_bay else row.home
    home = named if named in campus.posts else next((dock.name for dock in campus.docks()), None)
    rests = row.activity in (Activity.IDLE, Activity.CHARGING)
    docked = rests if row.docked is None else row.docked
    return RobotLocation(
        robot=row.name,
        post=post,
        seen_at=row.seen_at,
        home=home,
        at_home=docked and post == home if occupies is None else occupies.place == row.home_bay,
        online=row.online,
        holds=holds,
        goals=_with_its_own(campus, row, request, goals),
        request=request,
        stopped=row.activity == Activity.STOPPED,
        heard_at=row.heard_at,
        occupies=occupies,
        home_bay=row.home_bay,
        battery_ratio=row.battery_ratio,
    )


def _with_its_own(
    campus: CampusMap, row: RobotRow, request: ReservationRequest | None, goals: tuple[Stop, ...]
) -> tuple[Stop, ...]:
    """Put first what it goes to now, whatever its mission says: the robot knows best when it has to charge, and what it
    does in a dock."""
    if request is None:
        charges = row.activity == Activity.CHARGING and goals and goals[0].charges_to is None
        return (Stop(OF_ITS_OWN, row.post or "", FULL), *goals) if charges else goals
    if request.is_for_later or (goals and goals[0].post == request.goal):
        return goals
    place = campus.track.posts.get(request.place)
    return (Stop(OF_ITS_OWN, request.goal, FULL if place is not None and place.dock else None), *goals)


async def _holds(session: AsyncSession) -> dict[str, list[Hold]]:
    held: dict[str, list[Hold]] = {}
    asked = and_(col(ClaimRow.robot) == col(GrantRow.robot), col(ClaimRow.claim_id) == col(GrantRow.claim_id))
    granted = select(GrantRow, ClaimRow.goal).outerjoin(ClaimRow, asked).where(col(GrantRow.cleared_at).is_(None))
    for row, goal in (await session.exec(granted.order_by(col(GrantRow.id)))).all():
        known = held.setdefault(row.robot, [])
        if all((one.from_post, one.to_post) != (row.from_post, row.to_post) for one in known):
            known.append(Hold(row.from_post, row.to_post, row.id or 0, goal))
    return held


async def _occupied(session: AsyncSession, track: CampusMap) -> dict[str, Occupied]:
    """What was reported on another map says nothing on this one."""
    rows = (await session.exec(select(OccupancyRow))).all()
    known = (row for row in rows if {row.place, row.towards or row.place} <= track.posts.keys())
    return {row.robot: Occupied(row.kind, row.place, row.towards) for row in known}


async def _requests(session: AsyncSession, campus: CampusMap) -> dict[str, ReservationRequest]:
    rows = (
        await session.exec(select(ClaimRow).where(col(ClaimRow.granted).is_(None)).order_by(col(ClaimRow.at)))
    ).all()
    return {row.robot: _request(row, campus) for row in rows}


def _request(row: ClaimRow, campus: CampusMap) -> ReservationRequest:
    legs = [(str(leg["from_post"]), str(leg["to_post"])) for leg in row.legs]
    here = legs[0][0]
    first = legs[:1]
    for leg in legs[1:]:
        if leg[0] != here or leg in first:
            break
        first.append(leg)
    place = row.goal or legs[-1][1]
    goal = campus.address_of(place)
    to_goal = next((number for number, leg in enumerate(legs, start=1) if leg[1] == goal), len(legs))
    then = tuple(legs[1:to_goal]) if len(first) == 1 else ()
    comes_in = here == goal and campus.address_of(legs[0][1]) == goal
    return ReservationRequest(row.claim_id, tuple(first), goal, then, tuple(legs), place, comes_in)


_LAST_LEFT: Final = (
    select(GrantRow)
    .where(
        tuple_(col(GrantRow.robot), col(GrantRow.cleared_at)).in_(
            select(GrantRow.robot, func.max(GrantRow.cleared_at)).group_by(col(GrantRow.robot))
        )
    )
    .order_by(col(GrantRow.id))
)
"""Not the one that was granted last: what a robot may enter besides its way is cleared first."""


async def _goals(session: AsyncSession) -> dict[str, list[Stop]]:
    over = (StopRow.done_at, StopRow.gave_up_at, StopRow.dropped_at)
    charges_to = case((col(StopRow.action) == StopAction.DOCK, func.coalesce(StopRow.until_ratio, FULL)))
    left = (
        select(MissionRow.robot, StopRow.id, StopRow.post, charges_to)
        .where(col(StopRow.mission_id) == col(MissionRow.id), col(MissionRow.state) == MissionState.ACTIVE)
        .where(*(col(at).is_(None) for at in over))
        .order_by(col(MissionRow.created_at), col(StopRow.position))
    )
    goals: dict[str, list[Stop]] = {}
    for robot, stop, post, ratio in (await session.exec(left)).all():
        if post:
            goals.setdefault(robot, []).append(Stop(stop, post, ratio))
    return goals
