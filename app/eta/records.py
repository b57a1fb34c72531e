"""Records of promised arrivals, until their truth has come and for as long as it is learned from."""

from datetime import datetime
from typing import Any, Final

from sqlalchemy import select
from sqlmodel import col
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.database.database import write_all
from app.models import ForecastRow, ForecastUnderWayRow
from fleet.eta.arrivals import Promise
from fleet.eta.intervals import Interval

REMEMBERED: Final = 500

Intervals = tuple[Interval, Interval, Interval]
"""Worked out, told, and by the map; in seconds from when it was told."""


def promise_row(order_id: str, begins_at: datetime, promise: Promise) -> dict[str, Any]:
    """A row of `ForecastRow`: what was told with an order that was placed."""
    fetch = {"fetch_name": promise.fetch.name, "fetch_assumed_s": promise.fetch.assumed_s}
    quantiles = _columns((promise.raw, promise.told, promise.by_map))
    return {"order_id": order_id, "begins_at": begins_at, **quantiles, **fetch, "arrived_at": None}


async def keep_under_way(
    session: AsyncSession, order_id: str, told_at: datetime, intervals: Intervals, *, is_aboard: bool
) -> None:
    """Keep the promise for an order that a robot has: the first of it, and the first after its mail was loaded."""
    if await session.get(ForecastUnderWayRow, (order_id, is_aboard)) is None:
        key = {"order_id": order_id, "is_aboard": is_aboard, "told_at": told_at}
        await write_all(session, ForecastUnderWayRow, [{**key, **_columns(intervals), "arrived_at": None}])


async def told_under_way(session: AsyncSession, order_id: str) -> list[ForecastUnderWayRow]:
    """Return all promises for this order since a robot has it."""
    rows = [await session.get(ForecastUnderWayRow, (order_id, is_aboard)) for is_aboard in (False, True)]
    return [row for row in rows if row is not None]


def intervals_of(row: Any) -> Intervals:
    """Of a row of either table."""
    worked_out, told, by_map = (
        Interval(*(getattr(row, f"{whose}_{share}") for share in Interval._fields)) for whose in WHOSE
    )
    return worked_out, told, by_map


def _columns(intervals: Intervals) -> dict[str, float]:
    return {
        f"{whose}_{share}": seconds
        for whose, one in zip(WHOSE, intervals, strict=True)
        for share, seconds in one._asdict().items()
    }


WHOSE: Final = ("raw", "told", "map")
LATEST_PLACED: Final = (
    select(*ForecastRow.__table__.columns)  # type: ignore[attr-defined]
    .where(col(ForecastRow.arrived_at).is_not(None))
    .order_by(col(ForecastRow.arrived_at).desc())
    .limit(REMEMBERED)
)
LATEST_UNDER_WAY: Final = (
    select(*ForecastUnderWayRow.__table__.columns)  # type: ignore[attr-defined]
    .where(col(ForecastUnderWayRow.arrived_at).is_not(None))
    .order_by(col(ForecastUnderWayRow.arrived_at).desc(), col(ForecastUnderWayRow.is_aboard).desc())
    .limit(REMEMBERED)
)
