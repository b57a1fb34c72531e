"""Learning from what robots say, as it happens; and again from what was kept, when the service starts.

A corridor has been driven between two posts that a robot has told of one after the other, by its own clock, so that a
time without network teaches nothing wrong. What it waited before it was let in is not counted.
"""

from collections.abc import Awaitable, Callable, Iterable
from dataclasses import dataclass, field
from datetime import datetime
from functools import partial
from typing import Any, Final, NamedTuple, Protocol

from sqlalchemy import func, or_, select
from sqlmodel import col
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.database.database import Database, after_commit, connection_of, write_all
from app.core.polling import PollingLoop
from app.eta.records import LATEST_PLACED, LATEST_UNDER_WAY, Intervals, intervals_of, told_under_way
from app.models import DurationRow, ForecastRow, ForecastUnderWayRow, Order, OrderState, RobotRow, StopRow
from fleet.eta.arrivals import Ahead, Estimates
from fleet.eta.calibration import Basis
from fleet.eta.durations import Durations, Kind, Thing
from protocol.clock import Clock
from protocol.parts import Leg, Part, Purpose, StopAction
from protocol.to_server import HandoverReceipt, Progress, Step

REMEMBERED_DURATIONS: Final = 3000
POLL_EVERY_S: Final = 30.0
"""Real seconds; sooner when an order has changed."""
REST_S: Final = 2.0
REST: Final = 100
"""Of a thousand robots a poll takes a tenth of a second, in which the service gives no answers: times as long."""
NOT_FETCHED: Final = (OrderState.QUEUED, OrderState.ASSIGNED, OrderState.TO_SENDER)
OBSERVED: Final = "observed"
"""Of a session: what was heard in it and is not written down yet."""
KIND_OF: Final = {Purpose.LOAD: Kind.LOAD, Purpose.RECEIVE: Kind.RECEIVE}


WhyNone = Callable[[AsyncSession], Awaitable[str | None]]
"""The reason for which no robot would come for an order of this moment; None if one would."""


async def _not_asked(_session: AsyncSession) -> str | None:
    return None


class Observed(NamedTuple):
    """One observed duration, and when it was over."""

    thing: Thing
    seconds: float
    at: datetime

    @property
    def row(self) -> dict[str, Any]:
        return {**self.thing._asdict(), "seconds": self.seconds, "at": self.at}


class Corrected(Protocol):
    """A robot's time as the service's clock would have said it."""

    def __call__(self, at: datetime) -> datetime: ...


@dataclass
class Learning:
    """Hears what robots tell, and looks now and then how many orders wait."""

    database: Database
    estimates: Estimates
    clock: Clock
    why_none: WhyNone = _not_asked
    """Dispatch sets it."""
    _on_way: dict[str, tuple[str, datetime]] = field(default_factory=dict)
    """The post that each robot passed last, and when, by its clock put right."""
    _let_in: dict[tuple[str, str, str], datetime] = field(default_factory=dict)
    polling: PollingLoop = field(
        default_factory=lambda: PollingLoop(
            POLL_EVERY_S, REST_S, rest=REST, longest_rest_s=POLL_EVERY_S, waits_first=True
        )
    )

    # At the start, and now and then.

    async def begin(self) -> None:
        """Load what is remembered of earlier days, oldest first."""
        async with self.database.asking() as connection:
            durations = (await connection.execute(_LATEST_DURATIONS)).all()
            placed = (await connection.execute(LATEST_PLACED)).all()
            under_way = (await connection.execute(LATEST_UNDER_WAY)).all()
        for kind, name, assumed_s, seconds in reversed(durations):
            self._learn(Thing(Kind(kind), name, assumed_s), seconds)
        for row in reversed(placed):
            self._arrived(Basis.PLACED, intervals_of(row), row.begins_at, row.arrived_at)
        for row in reversed(under_way):
            self._arrived(Basis.UNDER_WAY, intervals_of(row), row.told_at, row.arrived_at)
        await self.poll()

    def wake(self, _changed: str = "") -> None:
        """An order or a robot has changed."""
        self.polling.wake()

    def stop(self) -> None:
        """End `run`."""
        self.polling.stop()

    async def run(self) -> None:
        """Until stopped or cancelled."""
        async for _ in self.polling.until_stopped():
            await self.poll()

    async def poll(self) -> None:
        """Count the orders that wait and the robots they wait for, and find out if one of these could come."""
        async with self.database.reading() as session:
            connection = await connection_of(session)
            now = self.clock.utc()
            due = or_(col(Order.not_before).is_(None), col(Order.not_before) <= now)
            waiting = select(func.count()).select_from(Order).where(col(Order.state).in_(NOT_FETCHED), due)
            there = select(func.count()).select_from(RobotRow).where(col(RobotRow.online))
            orders, robots = [(await connection.execute(counted)).scalar_one() for counted in (waiting, there)]
            reason = await self.why_none(session)
        self.estimates.ahead = Ahead(orders, robots, reason)

    # What robots say, in the transaction that writes it down.

    async def hear(self, session: AsyncSession, robot: str, happened: Part, corrected: Corrected) -> None:
        """One event, after what follows from it; `write_down` comes later.

        A second time it is not told: each message is taken once."""
        found: list[Observed | None] = []
        if isinstance(happened, HandoverReceipt):
            found.append(await self._handed_over(session, happened, corrected))
        elif isinstance(happened, Progress):
            at = corrected(happened.happened_at)
            found.append(self._drove(robot, happened, at))
            if happened.step is Step.ARRIVED and happened.order_id is not None:
                stop = await session.get(StopRow, happened.stop_id)
                found.append(await self._came(session, happened.order_id, stop, at))
        plausible = [one for one in found if one is not None and Durations.is_plausible(one.seconds)]
        session.info.setdefault(OBSERVED, []).extend(plausible)

    async def write_down(self, session: AsyncSession) -> None:
        """Write down what was heard in this transaction, in one statement."""
        observed: list[Observed] = session.info.pop(OBSERVED, [])
        await write_all(session, DurationRow, [one.row for one in observed])
        for one in observed:
            after_commit(session, partial(self._learn, one.thing, one.seconds))

    def let_in(self, robot: str, legs: Iterable[Leg], now: datetime) -> None:
        """These corridors may be entered from now on: what it waited before was no driving."""
        self._let_in.update({(robot, leg.from_post, leg.to_post): now for leg in legs})

    def _drove(self, robot: str, progress: Progress, at: datetime) -> Observed | None:
        before = self._on_way.pop(robot, None)
        if progress.post is None or progress.step not in ON_ITS_WAY:
            return None
        if progress.step is not Step.ARRIVED:
            self._on_way[robot] = (progress.post, at)
        if before is None or progress.step is Step.DEPARTED or before[0] not in self.estimates.ways.campus.posts:
            return None
        thing = self.estimates.corridor(before[0], progress.post)
        entered_at = max(before[1], self._let_in.pop((robot, before[0], progress.post), before[1]))
        return None if thing is None else _observed(thing, entered_at, at)

    async def _came(self, session: AsyncSession, order_id: str, stop: StopRow | None, at: datetime) -> Observed | None:
        placed = await session.get(ForecastRow, order_id)
        if stop is not None and stop.action == StopAction.LOAD and placed is not None and placed.arrived_at is None:
            if stop.post != (await session.get_one(Order, order_id)).from_post:
                return None  # passed on: it was fetched before
            fetch = Thing(Kind.FETCH, placed.fetch_name, placed.fetch_assumed_s)
            return _observed(fetch, placed.begins_at, at)
        if stop is not None and stop.action == StopAction.RECEIVE:
            if placed is not None:
                self._note_arrival(session, Basis.PLACED, placed, placed.begins_at, at)
            for row in await told_under_way(session, order_id):
                self._note_arrival(session, Basis.UNDER_WAY, row, row.told_at, at)
        return None

    def _note_arrival(
        self, session: AsyncSession, basis: Basis, row: ForecastRow | ForecastUnderWayRow, since: datetime, at: datetime
    ) -> None:
        if row.arrived_at is None and at > since:
            row.arrived_at = at
            after_commit(session, partial(self._arrived, basis, intervals_of(row), since, at))

    async def _handed_over(
        self, session: AsyncSession, receipt: HandoverReceipt, corrected: Corrected
    ) -> Observed | None:
        stop, kind = await session.get(StopRow, receipt.stop_id), KIND_OF.get(receipt.purpose)
        if stop is None or stop.arrived_at is None or kind is None:
            return None
        arrived_at = corrected(stop.arrived_at)
        return _observed(self.estimates.stop(kind, arrived_at), arrived_at, corrected(receipt.happened_at))

    def _learn(self, thing: Thing, seconds: float) -> None:
        self.estimates.durations.observe(thing, seconds)

    def _arrived(self, basis: Basis, intervals: Intervals, told_at: datetime, at: datetime) -> None:
        self.estimates.told[basis].arrived(*intervals, (at - told_at).total_seconds())


def _observed(thing: Thing, since: datetime, until: datetime) -> Observed:
    return Observed(thing, (until - since).total_seconds(), until)


ON_ITS_WAY: Final = frozenset({Step.DEPARTED, Step.PASSED, Step.ARRIVED})
_LATEST_DURATIONS: Final = (
    select(col(DurationRow.kind), col(DurationRow.name), col(DurationRow.assumed_s), col(DurationRow.seconds))
    .where(col(DurationRow.kind).in_([str(kind) for kind in Kind]))
    .order_by(col(DurationRow.id).desc())
    .limit(REMEMBERED_DURATIONS)
)
