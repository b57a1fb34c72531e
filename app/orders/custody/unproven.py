"""Hand-overs that a robot claims and does not prove, and what is found of them.

Mail that a robot reports as aboard is the robot's from then on. Mail that it reports as out is the robot's still, until
a person or what follows has settled it.
"""

from datetime import datetime
from typing import Final

from sqlalchemy import ColumnElement
from sqlmodel import and_, col, or_, select, update
from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import Alarm, Evidence, Handover, Order, Settled
from protocol.parts import Purpose

CLAIMED: Final = "handover_claimed"
"""The alarm; its sentence has the order's id."""


def counts(one: Handover) -> bool:
    """Return whether the mail is where this hand-over says."""
    return one.evidence != Evidence.CLAIMED or one.settled == Settled.TRUE or (_is_open(one) and _is_load(one))


def is_open_claim_of_handing_out(one: Handover) -> bool:
    """Return whether a person still has to find out if the mail is out."""
    return one.evidence == Evidence.CLAIMED and _is_open(one) and not _is_load(one)


def _is_open(one: Handover) -> bool:
    return one.settled is None


def _is_load(one: Handover) -> bool:
    return one.purpose == Purpose.LOAD


async def last_handover(session: AsyncSession, order_id: str) -> Handover | None:
    """The newest link of the chain of custody: it tells who has the mail now."""
    newest = select(Handover).where(Handover.order_id == order_id, _COUNTS).order_by(col(Handover.id).desc()).limit(1)
    return (await session.exec(newest)).first()


async def robot_with_mail(session: AsyncSession, order: Order) -> str | None:
    """Return the robot that has the mail of an order by its chain of custody, whatever the order's state says."""
    last = await last_handover(session, order.id)
    return last.robot if last is not None and _is_load(last) else None


async def claim_of_handing_out(session: AsyncSession, order_id: str) -> Handover | None:
    """Return the newest unsettled claim of a robot that it has handed this mail out."""
    claims = await _open_claims(session, order_id)
    return next((one for one in reversed(claims) if not _is_load(one)), None)


async def settle_as_aboard(session: AsyncSession, order_id: str, now: datetime) -> None:
    """Settle all claims: the mail was in its robot until now, so it came aboard and did not go out."""
    claims = await _open_claims(session, order_id)
    for one in claims:
        one.settled = Settled.TRUE if _is_load(one) else Settled.FALSE
    if claims:
        await _clear_alarms(session, order_id, now)


async def settle_as_never_aboard(session: AsyncSession, order_id: str, now: datetime) -> bool:
    """It did not come aboard after all, so nor did it come out; False if that it came aboard was not a claim."""
    claims = await _open_claims(session, order_id)
    if not any(_is_load(one) for one in claims):
        return False
    for one in claims:
        one.settled = Settled.FALSE
    await _clear_alarms(session, order_id, now)
    return True


async def settle_as_true(session: AsyncSession, claim: Handover, now: datetime) -> None:
    """Settle a claim as true: a dispatcher has asked, and the mail is out."""
    await settle_as_aboard(session, claim.order_id, now)
    claim.settled = Settled.TRUE


async def _open_claims(session: AsyncSession, order_id: str) -> list[Handover]:
    wanted = select(Handover).where(Handover.order_id == order_id, Handover.evidence == Evidence.CLAIMED)
    wanted = wanted.where(col(Handover.settled).is_(None)).order_by(col(Handover.id))
    return list((await session.exec(wanted)).all())


async def _clear_alarms(session: AsyncSession, order_id: str, now: datetime) -> None:
    ringing = update(Alarm).where(col(Alarm.name) == CLAIMED, col(Alarm.cleared_at).is_(None))
    await session.exec(ringing.where(col(Alarm.reason).contains(order_id, autoescape=True)).values(cleared_at=now))


_COUNTS: Final[ColumnElement[bool]] = or_(
    col(Handover.evidence) != Evidence.CLAIMED,
    col(Handover.settled) == Settled.TRUE,
    and_(col(Handover.settled).is_(None), col(Handover.purpose) == Purpose.LOAD),
)
