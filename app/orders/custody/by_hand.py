"""Mail that a dispatcher reports as taken out of its robot by hand: the only custody that no robot has reported."""

from datetime import datetime
from typing import Final

from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import Evidence, Handover, Order
from app.orders.custody.codes import Holder
from app.orders.custody.unproven import last_handover
from protocol.parts import Purpose

BY_HAND: Final = "dispatcher"


def taken_out_by_hand(order: Order, stop_id: str, post: str, dispatcher_id: str | None, now: datetime) -> Handover:
    """Return the link of custody from the order's robot to the mailroom."""
    return Handover(
        order_id=order.id,
        stop_id=stop_id[:64],
        purpose=Purpose.RETURN,
        robot=order.robot or "",
        post=post,
        how=BY_HAND,
        evidence=Evidence.DISPATCHER,
        holder=Holder.MAILROOM.value,
        person_id=dispatcher_id,
        robot_at=now,
        at=now,
    )


async def is_taken_out_by_hand(session: AsyncSession, order: Order) -> bool:
    """Return whether the mail was taken out last by hand: the robot that had it does not know."""
    last = await last_handover(session, order.id)
    return last is not None and last.how == BY_HAND
