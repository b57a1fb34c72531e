"""Who may enter which corridor. Thin: everything is granted, and recorded as it will be when it is not.

A grant holds until the robot reports the corridor clear; no time-out ever frees one.
"""

from collections.abc import Sequence
from datetime import datetime

from sqlmodel import col, select, update
from sqlmodel.ext.asyncio.session import AsyncSession

from app.fleet.errors import UnknownCorridor
from app.tables import ClaimRow, GrantRow
from maps import CampusMap, CampusMapError, corridor_name
from protocol.parts import Leg
from protocol.to_robot import Deny, Grant
from protocol.to_server import Claim, Clear


async def answer(
    session: AsyncSession, campus: CampusMap, robot: str, claim: Claim, now: datetime
) -> Grant | Deny | None:
    """Grant a claim, or deny what the map does not have; None if this claim was answered before."""
    if await session.get(ClaimRow, (robot, claim.claim_id)) is not None:
        return None
    unknown = _unknown(campus, claim.legs)
    reason = f"the map {campus.name} has no corridor {_name(unknown)}" if unknown else None
    legs = [leg.model_dump() for leg in claim.legs]
    session.add(
        ClaimRow(robot=robot, claim_id=claim.claim_id, legs=legs, at=now, granted=unknown is None, reason=reason)
    )
    if unknown is not None:
        return Deny(claim_id=claim.claim_id, avoid=(unknown,), reason=reason or "")
    session.add_all(_grant(robot, claim.claim_id, leg, now) for leg in claim.legs)
    return Grant(claim_id=claim.claim_id, legs=claim.legs)


async def clear(session: AsyncSession, campus: CampusMap, robot: str, message: Clear, now: datetime) -> None:
    """The robot has left a corridor. Raises UnknownCorridor for one that the map does not have."""
    if _unknown(campus, (message.leg,)):
        raise UnknownCorridor(f"the map {campus.name} has no corridor {_name(message.leg)}")
    held = update(GrantRow).where(
        col(GrantRow.robot) == robot,
        col(GrantRow.corridor) == _name(message.leg),
        col(GrantRow.from_post) == message.leg.from_post,
        col(GrantRow.cleared_at).is_(None),
    )
    await session.exec(held.values(cleared_at=now))


async def held_by(session: AsyncSession, robot: str) -> tuple[Leg, ...]:
    """The corridors that a robot may be in, in the order in which it was granted them."""
    held = select(GrantRow).where(GrantRow.robot == robot, col(GrantRow.cleared_at).is_(None))
    rows = (await session.exec(held.order_by(col(GrantRow.id)))).all()
    legs = (Leg(from_post=row.from_post, to_post=row.to_post) for row in rows)
    return tuple(dict.fromkeys(legs))


def _grant(robot: str, claim_id: str, leg: Leg, now: datetime) -> GrantRow:
    return GrantRow(
        robot=robot,
        claim_id=claim_id,
        corridor=_name(leg),
        from_post=leg.from_post,
        to_post=leg.to_post,
        granted_at=now,
    )


def _unknown(campus: CampusMap, legs: Sequence[Leg]) -> Leg | None:
    for leg in legs:
        try:
            campus.corridor(leg.from_post, leg.to_post)
        except CampusMapError:
            return leg
    return None


def _name(leg: Leg) -> str:
    return corridor_name(leg.from_post, leg.to_post)
