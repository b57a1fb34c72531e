"""Robots: enrol one, tell one something, take in what one says, show them all."""

import re
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial

from sqlmodel import col, select, update
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.database.database import Database, after_commit
from app.core.settings import Settings
from app.eta.learning import Learning
from app.models import RobotRow, RobotToken
from app.orders.service import Orders
from app.orders.views.robot_view import RobotView, robot_view
from app.realtime.feed import Feed, FeedEvent
from app.robots.battery import BatteryDiary
from app.robots.corridors import reservations
from app.robots.corridors.closed_corridors import WAY_BLOCKED
from app.robots.corridors.closures import tell_of_closed
from app.robots.corridors.occupancies import note_occupancy
from app.robots.corridors.occupied import tell_of_traffic
from app.robots.diagnostics import LiveDiagnostics
from app.robots.energy_use import EnergyUse
from app.robots.errors import RobotExists, RobotNameInvalid, UnknownRobot
from app.robots.link import outbox
from app.robots.link.clocks import put_right
from app.robots.link.connections import Connections
from app.robots.link.tokens import Known, make_token
from app.robots.progress.progress import Report, follow
from maps import CampusMap
from protocol.clock import Clock
from protocol.ids import new_uuid
from protocol.parts import Activity, Battery, Part, Position
from protocol.to_server import Claim, Clear, Event, Fault, Occupancy, Snapshot, Why, Withdraw

_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,63}")


def check_name(name: str) -> None:
    """Raises RobotNameInvalid."""
    if not _NAME.fullmatch(name):
        raise RobotNameInvalid(f"{name!r} is no name for a robot: letters, digits, - and _, at most 64.")


async def known_robot(session: AsyncSession, name: str, *, to_change: bool = False) -> RobotRow:
    """The row of an enrolled robot, locked if it is to be changed. Raises UnknownRobot."""
    robot = await session.get(RobotRow, name, with_for_update=to_change or None)
    if robot is None:
        raise UnknownRobot(f"No robot named {name!r} is enrolled.")
    return robot


async def enrol(session: AsyncSession, clock: Clock, name: str) -> str:
    """Make a robot known; returns its token, which is shown once. Raises RobotNameInvalid, RobotExists."""
    check_name(name)
    if await session.get(RobotRow, name) is not None:
        raise RobotExists(f"A robot named {name!r} is enrolled already. Revoke its token for a new one.")
    session.add(RobotRow(name=name, enrolled_at=clock.utc(), server_journal=new_uuid()))
    await session.flush()
    return await new_token(session, clock, name)


async def new_token(session: AsyncSession, clock: Clock, name: str) -> str:
    """Another token for an enrolled robot; the ones it had are revoked. Raises UnknownRobot."""
    robot = await known_robot(session, name)
    robot.proves_since = None  # it may be another machine, or have been given older software
    await revoke_tokens(session, clock, name)
    token = make_token()
    session.add(RobotToken(prefix=token.prefix, secret_hash=token.secret_hash, robot=name, created_at=clock.utc()))
    return token.text


async def revoke_tokens(session: AsyncSession, clock: Clock, name: str, prefix: str | None = None) -> int:
    """Make a robot's tokens worthless, or the one with this prefix; how many that were. Raises UnknownRobot."""
    await known_robot(session, name)
    theirs = update(RobotToken).where(col(RobotToken.robot) == name, col(RobotToken.revoked_at).is_(None))
    if prefix is not None:
        theirs = theirs.where(col(RobotToken.prefix) == prefix)
    return (await session.exec(theirs.values(revoked_at=clock.utc()))).rowcount


@dataclass(frozen=True)
class Fleet:
    """The robots of one campus. `on_change` is called with a robot's name after the commit of each change."""

    database: Database
    campus: CampusMap
    settings: Settings
    clock: Clock
    feed: Feed
    orders: Orders
    connections: Connections = field(default_factory=Connections)
    on_change: list[Callable[[str], None]] = field(default_factory=list)
    batteries: BatteryDiary = field(default_factory=BatteryDiary)

    @cached_property
    def learning(self) -> Learning:
        """Return what is learned from robots of how long things take."""
        return Learning(self.database, self.orders.ledger.estimates, self.clock)

    @cached_property
    def spending(self) -> EnergyUse:
        """Return what is learned from robots of how much charge they need."""
        return EnergyUse(self.database, self.campus)

    @cached_property
    def watching(self) -> LiveDiagnostics:
        """Return the watchers of robots."""
        return LiveDiagnostics(self.connections, self.feed, time.monotonic)

    async def begin(self) -> None:
        """At the start of the service no robot is connected yet, whatever the last run has left behind."""
        async with self.database.transaction() as session:
            await session.exec(update(RobotRow).values(online=False))

    async def tell(self, session: AsyncSession, robot: RobotRow, message: Part) -> int:
        """Keep a durable message for a robot; it goes out after the commit, now or when the robot comes back."""
        seq = await outbox.keep(session, robot, message, self.clock.utc())
        after_commit(session, lambda: self.connections.wake(robot.name))
        return seq

    async def follow(self, session: AsyncSession, robot: RobotRow | Known, message: Part) -> None:
        """Do what follows from a durable message. Raises FleetError or ServiceError; undo what it has done then."""
        now = self.clock.utc()
        match message:
            case Event():
                report = Report(session, self.orders, robot.name, now, robot.clock_off_s)
                await follow(report, message)
                if isinstance(message.happened, Fault) and message.happened.name == WAY_BLOCKED:
                    await tell_of_closed(session, self.feed)
                await self.learning.hear(session, robot.name, message.happened, report.when)
            case Claim() if isinstance(robot, RobotRow):
                denied = await reservations.answer(session, self.campus, robot.name, message, now)
                if denied is not None:
                    await self.tell(session, robot, denied)
                    await tell_of_traffic(session, self.feed, robot.name)
            case Withdraw() if isinstance(robot, RobotRow):
                if await reservations.withdraw(session, robot, message):
                    self.announce(session, robot)
            case Clear():
                await reservations.clear(session, self.campus, robot.name, message, now)
                await tell_of_traffic(session, self.feed, robot.name)
            case Occupancy():
                at = put_right(message.happened_at, robot.clock_off_s)
                await note_occupancy(session, self.campus, robot.name, message, at)
                await tell_of_traffic(session, self.feed, robot.name)

    def note(self, robot: RobotRow, message: Snapshot | Why) -> None:
        """Take over what a robot says of its present state."""
        if isinstance(message, Why):
            robot.why = message.sentence
        else:
            note_state(robot, self.campus, message.position, message.battery)
            robot.activity = message.activity

    def announce(self, session: AsyncSession, robot: RobotRow, is_seen: bool = True) -> None:
        """After the commit: workers that wait for robots poll again, and pages see it as it is now, if that is news."""
        tell = self._news_of(robot) if is_seen else None

        def say() -> None:
            if tell is not None:
                tell()
            for call in self.on_change:
                call(robot.name)

        after_commit(session, say)

    def _news_of(self, robot: RobotRow) -> Callable[[], None]:
        """As it is now: what goes out after the commit must not be what was written later. Put together for listeners
        alone, since a fleet reports more often than anybody looks."""
        if not self.feed.is_heard:
            return self.feed.pass_over
        return partial(self.feed.publish, FeedEvent("robot", self.view_of(robot)))

    def have_spoken(self, session: AsyncSession, robots: Iterable[str]) -> None:
        """After the commit: these robots are as pages know them, but workers that wait for robots poll again."""

        def say() -> None:
            for robot in robots:
                for call in self.on_change:
                    call(robot)

        after_commit(session, say)

    async def views(self, session: AsyncSession) -> Sequence[RobotView]:
        """Return all robots, by name."""
        robots = (await session.exec(select(RobotRow).order_by(col(RobotRow.name)))).all()
        return [self.view_of(robot) for robot in robots]

    def view_of(self, robot: RobotRow) -> RobotView:
        """A robot as it is now."""
        return robot_view(robot, self.campus, self.settings, self.clock.utc())


def note_state(robot: RobotRow, campus: CampusMap, position: Position, battery: Battery) -> None:
    """Take over what `hello` and `snapshot` share. People know posts: a robot in a bay is at its post."""
    post, previous, towards = (
        place and campus.address_of(place) for place in (position.post, position.previous, position.towards)
    )
    robot.post, robot.towards = post, None if towards == post and position.towards != position.post else towards
    robot.previous = previous if previous != post else robot.previous
    robot.seen_at = position.seen_at and put_right(position.seen_at, robot.clock_off_s)
    robot.battery_ratio, robot.charging, robot.docked = battery.ratio, battery.charging, battery.docked
    if battery.charging:
        robot.activity = Activity.CHARGING
