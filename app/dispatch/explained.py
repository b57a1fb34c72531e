"""Telling people why their orders wait."""

from collections.abc import Mapping, Sequence
from typing import Final

from sqlalchemy import bindparam
from sqlmodel import col, select

from app.fleet.service import Fleet
from app.tables import Order, OrderState


async def explain(fleet: Fleet, whys: Mapping[str, Sequence[str]]) -> None:
    """Each sentence to its orders, by their ids, if they were told something else so far. It waits for no disk: what is
    lost is said again."""
    asked = [{"order_ids": order_ids, "why": why} for why, order_ids in whys.items()]
    async with fleet.database.reading() as session:
        asked = [one for one in asked if (await session.exec(_TOLD_OTHERWISE, params=one)).all()]
    if not asked:
        return
    async with fleet.database.transaction(durable=False) as session:
        for one in asked:
            for order_id in (await session.exec(_TOLD_OTHERWISE, params=one)).all():
                await fleet.orders.explain(session, order_id, str(one["why"]))


_TOLD_OTHERWISE: Final = select(Order.id).where(
    col(Order.id).in_(bindparam("order_ids", expanding=True)),
    col(Order.state) == OrderState.QUEUED,
    col(Order.why).is_distinct_from(bindparam("why")),
)
