"""Estimates of orders that a robot has, renewed whenever something is learned on the way, and the reasons for which
they wait: both go to pages together. The forecast of the schedule is put right by what came of earlier ones; what is
told first of an order, and first after its mail was loaded, is kept to learn from.

The promised window is kept beside it and is not made later here: a robot that comes after that is late, and the timer
tells of it.
"""

import asyncio
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from random import Random
from typing import Final, NamedTuple

from sqlalchemy import select
from sqlmodel import col
from sqlmodel import select as select_rows
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.database.database import after_commit, connection_of
from app.core.polling import PollingLoop
from app.dispatch.forecasts import Foresight, Stop
from app.eta.records import Intervals, keep_under_way
from app.models import MissionRow, MissionState, Order, OrderState, RobotRow, StopRow
from app.orders.ledger import Expected
from app.orders.transitions import MAIL_ABOARD, ROBOT_COMING
from app.orders.views.reasons import is_held_up, why_it_waits
from app.robots.service import Fleet
from app.traffic.service import TrafficService
from fleet.eta.arrivals import Estimates
from fleet.eta.calibration import Basis
from fleet.eta.forecast import forecast
from fleet.eta.intervals import Interval
from protocol.parts import StopAction

POLL_AGAIN_S: Final = 5.0
"""Real seconds. Time alone makes a robot late."""
REST: Final = 40
"""After each piece of a look so many times as long as it has taken: forecasting is the least of what the service has to
do. With a thousand robots a look takes half a second of the processor, and is spread over twenty."""
LEAST_REST_S: Final = 0.3
LONGEST_REST_S: Final = 20.0
AT_ONCE: Final = 10
"""Orders of one transaction."""
NEWS: Final = timedelta(seconds=30)
"""An interval that begins and ends by less than this otherwise, or by less than a share of what is left, stays."""
SHARE: Final = 0.25
SHORTEST: Final = timedelta(seconds=1)
ON_ITS_WAY: Final = ROBOT_COMING | {OrderState.CARRYING}


class UnderWay(NamedTuple):
    """An order that a robot has. `why`: the reason for which it waits; `expected`: None if no time is known.
    `forecast`: as it was worked out, put right, None if none was made; `told`: what people see from now on."""

    order: Order
    why: str | None
    expected: Expected | None
    is_news: bool
    forecast: tuple[Interval, Interval] | None
    told: Expected | None

    @property
    def stage(self) -> tuple[str, bool]:
        """Of each the first that is told is kept: the order, and whether its mail is aboard."""
        return self.order.id, self.order.state is OrderState.CARRYING

    @property
    def may_be_kept(self) -> bool:
        return self.forecast is not None and self.told is not None and self.order.state in ON_ITS_WAY


@dataclass
class EtaUpdates:
    """Runs in the background of the service."""

    fleet: Fleet
    desk: TrafficService
    _rng: Random = field(default_factory=lambda: Random(0))
    _said: dict[str, str | None] = field(default_factory=dict)
    """The reason of each order, as pages have it."""
    _kept: set[tuple[str, bool]] = field(default_factory=set)
    """Of which stages it is kept what was told."""
    polling: PollingLoop = field(
        default_factory=lambda: PollingLoop(POLL_AGAIN_S, LEAST_REST_S, rest=REST, longest_rest_s=LONGEST_REST_S)
    )

    def wake(self, _changed: str = "") -> None:
        """A robot, an order or the schedule has changed."""
        self.polling.wake()

    def stop(self) -> None:
        """End `run`."""
        self.polling.stop()

    async def run(self) -> None:
        """Until stopped or cancelled."""
        async for _ in self.polling.until_stopped():
            await self.poll()

    async def poll(self) -> None:
        """Foresee all stops, and write down and tell what has changed."""
        async with self.fleet.database.reading() as session:
            pairs = (await session.exec(_UNDER_WAY)).all()
            connection = await connection_of(session)
            stops = [Stop(*row) for row in (await connection.execute(_STOPS)).all()] if pairs else []
        if not pairs:
            self._said.clear()
            self._kept.clear()
            return
        now = self.fleet.clock.utc()
        await self.polling.breathe()
        forecast = await self._forecast(stops, now)
        receive = {stop.order_id: stop.id for stop in stops if stop.action == StopAction.RECEIVE}
        estimates = self.fleet.orders.ledger.estimates
        under_way = [
            _under_way(estimates, order, robot, forecast.get(receive.get(order.id, "")), now) for order, robot in pairs
        ]
        news = [one for one in under_way if one.is_news or self._is_new(one)]
        if news:
            await self._tell(news, now)
        self._said = {one.order.id: one.why for one in under_way}
        self._kept &= {(one.order.id, is_aboard) for one in under_way for is_aboard in (False, True)}

    def _is_new(self, one: UnderWay) -> bool:
        return self._said.get(one.order.id) != one.why or (one.may_be_kept and one.stage not in self._kept)

    async def _forecast(self, stops: Sequence[Stop], now: datetime) -> Mapping[str, Interval]:
        estimates, schedule = self.fleet.orders.ledger.estimates, self.desk.schedule
        if schedule is None:
            return {}
        async with self.desk.in_turn:
            controller, now_s = schedule.controller, self.fleet.clock.now()
            network, planned = controller.network, await asyncio.to_thread(controller.tasks_and_journeys, now_s)
        sees = Foresight(estimates, network, {stop.id: stop for stop in stops}, now, now_s, self._rng)
        return await asyncio.to_thread(forecast, network, *planned, now_s, sees.chance())

    async def _tell(self, news: Sequence[UnderWay], now: datetime) -> None:
        """A few in one transaction: what robots report in that time waits for it."""
        for first in range(0, len(news), AT_ONCE):
            await self.polling.breathe()
            if self.polling.is_stopped:
                return
            await self._tell_some(news[first : first + AT_ONCE], now)

    async def _tell_some(self, news: Sequence[UnderWay], now: datetime) -> None:
        async with self.fleet.database.transaction(durable=False) as session:
            for one in sorted(news, key=lambda one: one.order.id):
                order = await self.fleet.orders.ledger.order(session, one.order.id)
                if order.version != one.order.version:
                    continue  # it has moved on, and with that was shown as it is
                if one.is_news:
                    await self.fleet.orders.ledger.expect(session, order, one.expected)
                elif self._said.get(order.id) != one.why:
                    await self.fleet.orders.ledger.show(session, order)
                await self._keep(session, one, now)

    async def _keep(self, session: AsyncSession, one: UnderWay, now: datetime) -> None:
        """The first that is told in each stage."""
        if one.forecast is None or one.told is None or not one.may_be_kept or one.stage in self._kept:
            return
        order, (order_id, is_aboard) = one.order, one.stage
        by_map = self.fleet.orders.ledger.estimates.by_map_under_way(
            order.load_post, order.to_post, is_aboard=is_aboard
        )
        intervals = _kept_of(one.forecast, one.told, by_map, now)
        await keep_under_way(session, order_id, now, intervals, is_aboard=is_aboard)
        after_commit(session, lambda: self._kept.add(one.stage))


def _kept_of(forecast: tuple[Interval, Interval], told: Expected, by_map: Interval, now: datetime) -> Intervals:
    """With the ends that people see, which are not moved for a few seconds."""
    raw, corrected = forecast
    begins_s, ends_s = (max(0.0, (at - now).total_seconds()) for at in told)
    middle_s = min(max(begins_s, corrected.p50_s), ends_s)
    return raw, Interval(begins_s, middle_s, ends_s), by_map


def _under_way(estimates: Estimates, order: Order, robot: RobotRow, raw: Interval | None, now: datetime) -> UnderWay:
    corrected = None if raw is None else estimates.told[Basis.UNDER_WAY].corrected(raw)
    before = None
    if order.expected_from is not None and order.expected_to is not None:
        before = order.expected_from, order.expected_to
    expected = None if is_held_up(robot) else interval_from(corrected, now) if corrected else before
    is_news = order.state in ON_ITS_WAY and is_otherwise(before, expected, now)
    forecast = None if raw is None or corrected is None else (raw, corrected)
    told = expected if is_news else before
    return UnderWay(order, why_it_waits(order, robot), expected, is_news, forecast, told)


def interval_from(forecast: Interval, now: datetime) -> Expected:
    """From p10 to p90; never over."""
    begins_at, ends_at = (now + timedelta(seconds=seconds) for seconds in (forecast.p10_s, forecast.p90_s))
    return begins_at, max(ends_at, now + SHORTEST)


def is_otherwise(before: Expected | None, expected: Expected | None, now: datetime) -> bool:
    """Tell if people should hear of it: known at last, no longer known, soon over, or by enough otherwise."""
    if before is None or expected is None:
        return before is not expected
    enough = min(NEWS, max(SHORTEST, SHARE * (expected[1] - now)))
    off = max(abs(was - becomes) for was, becomes in zip(before, expected, strict=True))
    return off >= enough or (before[1] <= now + enough and before != expected)


_UNDER_WAY: Final = (
    select_rows(Order, RobotRow)
    .join(RobotRow, col(RobotRow.name) == col(Order.robot))
    .where(col(Order.state).in_((*ROBOT_COMING, *MAIL_ABOARD)))
)
_STOPS: Final = (
    select(
        *(col(StopRow.id), col(StopRow.action), col(StopRow.post), col(StopRow.order_id), col(MissionRow.robot)),
        col(StopRow.arrived_at),
    )
    .join(MissionRow, col(MissionRow.id) == col(StopRow.mission_id))
    .where(col(MissionRow.state) == MissionState.ACTIVE)
    .where(col(StopRow.done_at).is_(None), col(StopRow.gave_up_at).is_(None), col(StopRow.dropped_at).is_(None))
    .order_by(col(MissionRow.created_at), col(StopRow.position))
)
