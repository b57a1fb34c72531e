"""`/metrics` for Prometheus: figures of orders, robots, notices and requests. Gathered on request.

Never open: it answers programs on this machine, or, once a token is set, those that bring that token.
"""

import hmac
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from typing import Annotated, Any, Final

from fastapi import APIRouter, Depends, Header
from fastapi.responses import Response
from prometheus_client import CollectorRegistry, Counter, Gauge, Histogram, generate_latest
from prometheus_client.exposition import CONTENT_TYPE_PLAIN_0_0_4
from sqlmodel import col, func, select
from sqlmodel.ext.asyncio.session import AsyncSession
from starlette.requests import HTTPConnection

from app.core.database.database import ReadingDep
from app.core.errors import Forbidden, problems
from app.core.parts import find_part
from app.core.settings import ClockDep, Settings, SettingsDep
from app.core.trusted_clock import TrustedClock, holds_on
from app.models import Alarm, Order, OrderState, RobotRow
from app.notifications.lag import outbox_lag
from fleet.eta.arrivals import Estimates
from protocol.clock import Clock

router = APIRouter(tags=["health"])

MINUTES: Final = tuple(60.0 * minute for minute in (1, 2, 5, 10, 15, 20, 30, 60))
LONGEST_LIFE: Final = timedelta(days=14)
"""Orders older than that are not looked through for deliveries; it is an index that finds the younger ones."""
FORWARDED: Final = ("x-forwarded-for", "x-forwarded-proto", "forwarded", "via")
THIS_MACHINE: Final = ("127.0.0.1", "::1")


class NotForYou(Forbidden):
    """Metrics are for programs on this machine, or for those that bring the token that the operator has set."""

    code = "metrics_not_for_you"


@dataclass
class Metrics:
    """The figures of one service, in a registry of its own."""

    started_at: datetime
    registry: CollectorRegistry = field(default_factory=CollectorRegistry)

    def __post_init__(self) -> None:
        self._orders = self._gauge("orders", "Orders by state.", "state")
        self._waits = self._gauge("oldest_wait_seconds", "How long the oldest order has been in this state.", "state")
        self._heard = self._gauge("robot_heard_seconds", "Since this robot was last heard.", "robot")
        self._online = self._gauge("robot_online", "1 while its socket is open.", "robot")
        self._battery = self._gauge("robot_battery_ratio", "Charge as it last said.", "robot")
        self._waiting = self._gauge("notices_waiting", "Notices that a channel still owes.", "channel")
        self._given_up = self._gauge("notices_given_up", "Notices that a channel has given up.", "channel")
        self._lag = self._gauge("notices_lag_seconds", "Age of the oldest notice that is still owed.")
        self._alarms = self._gauge("alarms", "Alarms that are not over, by name.", "name")
        self._scored = self._gauge("estimates_scored", "Latest arrivals by which estimates are judged.", "basis")
        inside = "Share of them that came between p10 and p90; 0.8 is meant."
        middle, quantiles = "How far the middle was off, by whose estimate.", "Mean loss of p10, p50 and p90, by whose."
        self._inside = self._gauge("estimates_inside_ratio", inside, "basis")
        self._off = self._gauge("estimates_median_error_ratio", middle, "basis", "by")
        self._loss = self._gauge("estimates_pinball_seconds", quantiles, "basis", "by")
        off = "How far it was delivered from the middle of the window that was told last."
        late = "Delivered after the end of the window that was told last."
        name, registry = "campus_mail_estimate_error_seconds", self.registry
        self._leapt = self._gauge("clock_leapt_seconds", "How far the machine's clock has leapt, until it is believed.")
        self._holds = self._gauge("clock_holds_on", "1 while nothing is done by time that cannot be undone.")
        self._error = Histogram(name, off, buckets=MINUTES, registry=registry)
        self._late = Counter("campus_mail_deliveries_late", late, registry=registry)
        self._looked_at = self.started_at

    def _gauge(self, name: str, help_text: str, *labels: str) -> Gauge:
        return Gauge(f"campus_mail_{name}", help_text, labels, registry=self.registry)

    async def gather(self, session: AsyncSession, now: datetime) -> bytes:
        """Look everything up and write it out."""
        await self._gather_orders(session, now)
        await self._gather_robots(session, now)
        lag = await outbox_lag(session, now)
        self._lag.set(lag.oldest_s)
        _set_all(self._waiting, {**lag.waiting, "none yet": lag.not_routed})
        _set_all(self._given_up, lag.given_up)
        names = select(Alarm.name, func.count()).where(col(Alarm.cleared_at).is_(None)).group_by(Alarm.name)
        _set_all(self._alarms, dict((await session.exec(names)).all()))
        await self._gather_errors(session, now)
        return generate_latest(self.registry)

    def judge(self, estimates: Estimates) -> None:
        """Record the accuracy of the latest estimates on each basis, beside what lengths on the map alone would have
        told."""
        for basis, told in estimates.told.items():
            if (score := told.score()) is not None:
                self._scored.labels(basis).set(score.count)
                self._inside.labels(basis).set(score.inside)
                self._off.labels(basis, "told").set(score.median_error)
                self._off.labels(basis, "map").set(score.median_error_by_map)
                self._loss.labels(basis, "told").set(score.pinball_s)
                self._loss.labels(basis, "map").set(score.pinball_by_map_s)

    def look_at(self, clock: Clock) -> None:
        """Record if the machine's clock goes on as it went."""
        self._leapt.set(clock.leapt_s if isinstance(clock, TrustedClock) else 0.0)
        self._holds.set(holds_on(clock))

    async def _gather_orders(self, session: AsyncSession, now: datetime) -> None:
        since = func.min(func.coalesce(col(Order.not_before), col(Order.updated_at)))
        rows = (await session.exec(select(Order.state, func.count(), since).group_by(col(Order.state)))).all()
        _set_all(self._orders, {state: count for state, count, _ in rows})
        open_since = {state: at for state, _, at in rows if state not in ENDED}
        _set_all(self._waits, {state: max(0.0, (now - at).total_seconds()) for state, at in open_since.items()})

    async def _gather_robots(self, session: AsyncSession, now: datetime) -> None:
        robots = (await session.exec(select(RobotRow))).all()
        _set_all(self._heard, {r.name: (now - r.heard_at).total_seconds() for r in robots if r.heard_at})
        _set_all(self._online, {robot.name: float(robot.online) for robot in robots})
        _set_all(self._battery, {r.name: r.battery_ratio for r in robots if r.battery_ratio is not None})

    async def _gather_errors(self, session: AsyncSession, now: datetime) -> None:
        """Of the deliveries since the last look."""
        new = select(Order.updated_at, Order.window_from, Order.window_to).where(
            col(Order.created_at) > self._looked_at - LONGEST_LIFE,
            col(Order.state) == OrderState.DELIVERED,
            col(Order.updated_at) > self._looked_at,
            col(Order.updated_at) <= now,
        )
        for at, begins, ends in (await session.exec(new)).all():
            if begins is not None and ends is not None:
                self._error.observe(abs((at - (begins + (ends - begins) / 2)).total_seconds()))
                self._late.inc(at > ends)
        self._looked_at = now


ENDED: Final = frozenset(
    {OrderState.DELIVERED, OrderState.RETURNED, OrderState.HELD, OrderState.EXPIRED, OrderState.CANCELLED}
)


def _set_all(gauge: Gauge, values: Mapping[Any, float | int | None]) -> None:
    """Set all values; what is no longer there disappears, instead of staying at its last value for ever."""
    gauge.clear()
    for label, value in values.items():
        gauge.labels(str(label)).set(value or 0)


def _is_let_in(connection: HTTPConnection, settings: Settings, authorization: str) -> bool:
    token = settings.metrics_token.get_secret_value()
    if token:
        return hmac.compare_digest(authorization.encode(), f"Bearer {token}".encode())
    # Through a proxy everybody would seem to come from this machine.
    came_by_proxy = any(name in connection.headers for name in FORWARDED)
    return not came_by_proxy and connection.client is not None and connection.client.host in THIS_MACHINE


async def _door(
    connection: HTTPConnection, settings: SettingsDep, authorization: Annotated[str, Header(max_length=300)] = ""
) -> None:
    if not _is_let_in(connection, settings, authorization):
        raise NotForYou("Metrics are for this machine, or for programs that bring CAMPUS_MAIL_METRICS_TOKEN.")


@router.get(
    "/metrics", response_class=Response, dependencies=[Depends(_door, scope="function")], responses=problems(NotForYou)
)
async def metrics(connection: HTTPConnection, session: ReadingDep, clock: ClockDep) -> Response:
    """Figures for Prometheus, in its text format; for this machine alone, or by the operator's token."""
    gathered = find_part(connection, Metrics)
    gathered.look_at(clock)
    gathered.judge(find_part(connection, Estimates))
    content = await gathered.gather(session, clock.utc())
    return Response(content, headers={"Content-Type": CONTENT_TYPE_PLAIN_0_0_4})
