"""Windows of orders that a robot has, from the timetable: carried out many times with durations as they were learned.

What people were promised is not made later here: whoever comes after that is late, and the timer tells of it.
"""

import asyncio
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from random import Random
from typing import Any, Final, NamedTuple

from sqlalchemy import bindparam, or_, select
from sqlmodel import col

from app.estimates.arrivals import Estimates
from app.estimates.durations import Kind
from app.estimates.forecast import Chance, forecast
from app.estimates.intervals import Interval
from app.fleet.service import Fleet
from app.fleet.traffic_desk import TrafficDesk
from app.orders.transitions import ROBOT_COMING
from app.tables import ForecastRow, Order, OrderState, StopRow
from app.traffic.controller import TrafficController
from app.traffic.journey import Goal
from app.traffic.network import Lane, Network
from protocol.parts import StopAction

LOOK_EVERY_S: Final = 20.0
"""Real seconds."""
NEWS: Final = timedelta(seconds=30)
"""A window that begins and ends by less than this otherwise is left as it is."""
ON_ITS_WAY: Final = ROBOT_COMING | {OrderState.CARRYING}
KIND_OF: Final[Mapping[str, Kind]] = {
    StopAction.LOAD: Kind.LOAD,
    StopAction.RECEIVE: Kind.RECEIVE,
    StopAction.RETURN: Kind.RECEIVE,
}


class Planned(NamedTuple):
    """A stop that is a goal of the timetable. `promised_to`: the end of the window that people were told at first."""

    action: str
    arrived_at: datetime | None
    order_id: str | None
    promised_to: datetime | None


@dataclass(frozen=True)
class Foresight:
    """What is drawn of each goal and corridor, as it stands at one moment."""

    estimates: Estimates
    network: Network
    stops: Mapping[str, Planned]
    now: datetime
    now_s: float
    rng: Random

    def chance(self) -> Chance:
        return Chance(self._travel_s, self._handling_s, self._arrives_s)

    def _travel_s(self, _robot: str, lane: Lane) -> float:
        return self._draw_s(lane, 0.0)

    def _arrives_s(self, _robot: str, lane: Lane, entered_s: float) -> float:
        return entered_s + self._draw_s(lane, max(0.0, self.now_s - entered_s))

    def _draw_s(self, lane: Lane, over_s: float) -> float:
        posts = self.network.posts
        thing = self.estimates.corridor(posts[lane.start], posts[lane.end])
        return lane.travel_s if thing is None else self.estimates.durations.draw_s(thing, self.rng, over_s)

    def _handling_s(self, goal: Goal) -> float:
        stop = self.stops.get(goal.key)
        kind = KIND_OF.get(stop.action) if stop is not None else None
        if stop is None or kind is None:
            return goal.handling_s
        thing = self.estimates.stop(kind, stop.arrived_at or self.now)
        over_s = max(0.0, (self.now - stop.arrived_at).total_seconds()) if stop.arrived_at else 0.0
        return self.estimates.durations.draw_s(thing, self.rng, over_s) - over_s


@dataclass
class Foreseen:
    """Runs in the background of the service, beside the desk whose timetable it looks at."""

    fleet: Fleet
    desk: TrafficDesk
    _rng: Random = field(default_factory=lambda: Random(0))
    _stopped: asyncio.Event = field(default_factory=asyncio.Event)

    def stop(self) -> None:
        """End `run`."""
        self._stopped.set()

    async def run(self) -> None:
        """Until stopped or cancelled."""
        while not self._stopped.is_set():
            with suppress(TimeoutError):
                async with asyncio.timeout(LOOK_EVERY_S):
                    await self._stopped.wait()
            if not self._stopped.is_set():
                await self.look()

    async def look(self) -> None:
        """Foresee all goals, and write down what has changed. Nothing is told before enough was learned."""
        timetable = self.desk.timetable
        if timetable is None or self.fleet.orders.estimates.is_assumed:
            return
        now = self.fleet.clock.utc()
        stops = await self._stops([goal.key for name in timetable.known for goal in timetable.controller.goals(name)])
        expected = await self._expected(timetable.controller, stops, now) if stops else {}
        news = [
            (stop.order_id, window)
            for key, stop in stops.items()
            if stop.order_id and key in expected and (window := window_of(expected[key], stop.promised_to, now))
        ]
        if news:
            await self._tell(news)

    async def _expected(
        self, controller: TrafficController, stops: Mapping[str, Planned], now: datetime
    ) -> dict[str, Interval]:
        now_s = self.fleet.clock.now()
        network, tasks, journeys = controller.network, controller.tasks(now_s), controller.journeys(now_s)
        sees = Foresight(self.fleet.orders.estimates, network, stops, now, now_s, self._rng)
        return await asyncio.to_thread(forecast, network, tasks, journeys, now_s, sees.chance())

    async def _stops(self, keys: list[str]) -> dict[str, Planned]:
        if not keys:
            return {}
        async with self.fleet.database.asking() as connection:
            rows = (await connection.execute(_STOPS, {"keys": keys})).all()
        return {row.id: Planned(row.action, row.arrived_at, _to_tell(row), _promised_to(row)) for row in rows}

    async def _tell(self, news: list[tuple[str, tuple[datetime, datetime]]]) -> None:
        async with self.fleet.database.transaction(durable=False) as session:
            for order_id, (begins_at, ends_at) in sorted(news):
                order = await self.fleet.orders.order(session, order_id)
                if order.state in ON_ITS_WAY and _is_news(order, begins_at, ends_at):
                    await self.fleet.orders.expect(session, order, begins_at, ends_at)


def window_of(expected: Interval, promised_to: datetime | None, now: datetime) -> tuple[datetime, datetime] | None:
    """None, if it will be late: of that people are told aloud."""
    begins_at, ends_at = (now + timedelta(seconds=seconds) for seconds in (expected.p10_s, expected.p90_s))
    if promised_to is None:
        return begins_at, ends_at
    return (begins_at, min(ends_at, promised_to)) if begins_at < promised_to else None


def _to_tell(row: Any) -> str | None:
    """The order whose recipient waits at this stop."""
    return row.order_id if row.action == StopAction.RECEIVE else None


def _promised_to(row: Any) -> datetime | None:
    """None if its delay was told, or it was passed on: then the first promise is past."""
    if row.is_told_otherwise or row.begins_at is None:
        return None
    promised_to: datetime = row.begins_at + timedelta(seconds=row.told_p90_s)
    return promised_to


def _is_news(order: Order, begins_at: datetime, ends_at: datetime) -> bool:
    if order.window_from is None or order.window_to is None:
        return True
    return max(abs(order.window_from - begins_at), abs(order.window_to - ends_at)) >= NEWS


_STOPS: Final = (
    select(
        col(StopRow.id),
        col(StopRow.action),
        col(StopRow.arrived_at),
        col(StopRow.order_id),
        or_(col(Order.delayed_at).is_not(None), col(Order.passed_on_at_post).is_not(None)).label("is_told_otherwise"),
        col(ForecastRow.begins_at),
        col(ForecastRow.told_p90_s),
    )
    .join(Order, col(Order.id) == col(StopRow.order_id))
    .outerjoin(ForecastRow, col(ForecastRow.order_id) == col(StopRow.order_id))
    .where(col(StopRow.id).in_(bindparam("keys", expanding=True)))
)
