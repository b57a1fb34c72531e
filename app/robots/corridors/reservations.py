"""Reservation requests, as robots send them. A request waits here for `app.traffic.service`.

A grant holds until the robot reports the corridor clear; no time-out ever frees one.
"""

from collections.abc import Sequence
from datetime import datetime
from typing import Final

from sqlmodel import col, select, update
from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import ClaimRow, GrantRow, RobotRow
from app.robots.errors import UnknownCorridor
from maps import CampusMap, CampusMapError, corridor_name
from protocol.parts import Leg
from protocol.to_robot import Deny
from protocol.to_server import Claim, Clear, Withdraw

ASKED_ANEW: Final = "the robot has asked for another way since"
WITHDRAWN: Final = "the robot wants it no longer"
GONE_ON: Final = "the robot is not where this way begins any more"


async def answer(session: AsyncSession, campus: CampusMap, robot: str, claim: Claim, now: datetime) -> Deny | None:
    """Let a claim wait, and deny what the map does not have; None if it waits, or was answered before."""
    if await session.get(ClaimRow, (robot, claim.claim_id)) is not None:
        return None
    unknown = _unknown(campus.track, claim.legs)
    reason = f"the map {campus.name} has no corridor {_name(unknown)}" if unknown else None
    legs = [leg.model_dump() for leg in claim.legs]
    row = ClaimRow(robot=robot, claim_id=claim.claim_id, legs=legs, at=now, goal=claim.goal, reason=reason)
    row.granted = False if unknown else None
    await forget_what_waits(session, robot, ASKED_ANEW)
    session.add(row)
    return Deny(claim_id=claim.claim_id, avoid=(unknown,), reason=reason or "") if unknown is not None else None


async def withdraw(session: AsyncSession, robot: RobotRow, message: Withdraw) -> bool:
    """Withdraw a request; True if the robot waited for it. What has been answered meanwhile it gives back itself."""
    waiting = update(ClaimRow).where(
        col(ClaimRow.robot) == robot.name,
        col(ClaimRow.claim_id) == message.claim_id,
        col(ClaimRow.granted).is_(None),
    )
    if (await session.exec(waiting.values(granted=False, reason=WITHDRAWN))).rowcount == 0:
        return False
    robot.waits_for = None
    return True


async def clear(session: AsyncSession, campus: CampusMap, robot: str, message: Clear, now: datetime) -> None:
    """The robot has left a corridor. Raises UnknownCorridor for one that the map does not have."""
    if _unknown(campus.track, (message.leg,)):
        raise UnknownCorridor(f"the map {campus.name} has no corridor {_name(message.leg)}")
    held = update(GrantRow).where(
        col(GrantRow.robot) == robot,
        col(GrantRow.corridor) == _name(message.leg),
        col(GrantRow.from_post) == message.leg.from_post,
        col(GrantRow.cleared_at).is_(None),
    )
    await session.exec(held.values(cleared_at=now, left_at=message.post))
    if message.post is not None:
        await _forget_what_begins_elsewhere(session, robot, message.post)


async def _forget_what_begins_elsewhere(session: AsyncSession, robot: str, post: str) -> None:
    """Drop what it asked for before it got here some other way: nothing that it could enter. While it is inside a
    corridor it may be asking for what comes after that."""
    waiting = select(ClaimRow).where(ClaimRow.robot == robot, col(ClaimRow.granted).is_(None))
    for claim in (await session.exec(waiting)).all():
        if claim.legs[0]["from_post"] != post and not await held_by(session, robot):
            claim.granted, claim.reason = False, GONE_ON


async def forget_what_waits(session: AsyncSession, robot: str, reason: str) -> None:
    """A robot wishes for one way at a time: what it asks for now is what it wants."""
    waiting = update(ClaimRow).where(col(ClaimRow.robot) == robot, col(ClaimRow.granted).is_(None))
    await session.exec(waiting.values(granted=False, reason=reason))


async def held_by(session: AsyncSession, robot: str) -> tuple[Leg, ...]:
    """The corridors that a robot may be in, in the order in which it was granted them."""
    held = select(GrantRow).where(GrantRow.robot == robot, col(GrantRow.cleared_at).is_(None))
    rows = (await session.exec(held.order_by(col(GrantRow.id)))).all()
    legs = (Leg(from_post=row.from_post, to_post=row.to_post) for row in rows)
    return tuple(dict.fromkeys(legs))


def _unknown(track: CampusMap, legs: Sequence[Leg]) -> Leg | None:
    for leg in legs:
        try:
            track.corridor(leg.from_post, leg.to_post)
        except CampusMapError:
            return leg
    return None


def _name(leg: Leg) -> str:
    return corridor_name(leg.from_post, leg.to_post)
