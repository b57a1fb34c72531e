"""Intake of robots' messages, for all of them together: one transaction for whatever has come meanwhile.

The messages of one robot keep their order, and each connection hears of them after the commit alone. If anything in a
transaction fails, all of it is undone and each robot's messages are taken by themselves, so that a mistake in one of
them costs the others nothing but time.
"""

import asyncio
from collections import deque
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any, Final, Protocol

from sqlalchemy import bindparam, update
from sqlalchemy.orm.attributes import set_committed_value
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.database.database import connection_of, savepoint
from app.core.errors import ServiceError
from app.models import RobotRow
from app.robots.alarms import raise_alarm
from app.robots.conversation.prefetch import prefetch
from app.robots.errors import FleetError, MessageGap
from app.robots.link import inbox, outbox
from app.robots.link.clocks import compare_again, has_been_set
from app.robots.link.tokens import Known, still_good
from app.robots.service import Fleet
from protocol.both_ways import Ack, Error
from protocol.envelope import Envelope
from protocol.to_server import Claim, Snapshot, Why, Withdraw

GATHER_S: Final = 0.01
"""Real seconds for which the first message waits for others: a transaction costs more than what is in it."""
AT_ONCE: Final = 200
"""Messages in one transaction, so that the first of them does not wait long for the last."""
ACKNOWLEDGED_S: Final = 0.25
"""Real seconds that acknowledgements may wait for something to be taken in with them: a crash until then has messages
sent again that the robot knows already."""
OF_THE_ROBOT: Final = (Snapshot, Why, Claim, Withdraw)
"""What changes the row of the robot itself."""
UNSEEN: Final = frozenset({"heard_at", "last_seq"})
"""What may change of a robot without anything to tell pages."""


class TokenRevoked(Exception):
    """The token that opened this connection is worthless by now."""


class Speaker(Protocol):
    """One robot's connection, as far as it is listened to. Neither call waits."""

    robot: str
    token_prefix: str
    acknowledged: int

    def taken(self, envelope: Envelope, problem: Error | None) -> None:
        """On the disk, with what could not be followed of it."""
        ...

    def failed(self, error: Exception) -> None:
        """Not on the disk, nor anything after it: this connection cannot go on."""
        ...


@dataclass
class Said:
    """One message of one connection, and what has become of it."""

    speaker: Speaker
    envelope: Envelope
    had: int
    """What the robot had acknowledged before."""
    problem: Error | None = None
    failure: Exception | None = None


@dataclass
class Intake:
    """Takes what has come since the last transaction, for as long as anything comes."""

    fleet: Fleet
    _waiting: deque[Said] = field(default_factory=deque)
    _over: set[Speaker] = field(default_factory=set)
    _work: asyncio.Task[None] | None = None
    _later: asyncio.TimerHandle | None = None

    def hear(self, speaker: Speaker, envelope: Envelope, had: int | None = None) -> None:
        """Take this message in, soon; the speaker is told when it is done. `had`: what it had acknowledged before, if
        it counts this message's acknowledgement already."""
        self._waiting.append(Said(speaker, envelope, speaker.acknowledged if had is None else had))
        if not isinstance(envelope.body, Ack):
            self._begin()
        elif self._later is None:
            self._later = asyncio.get_running_loop().call_later(ACKNOWLEDGED_S, self._begin)

    def _begin(self) -> None:
        if self._later is not None:
            self._later.cancel()
            self._later = None
        if self._work is None or self._work.done():
            self._work = asyncio.create_task(self._take_all())

    async def _take_all(self) -> None:
        while self._waiting:
            if len(self._waiting) < AT_ONCE:
                await asyncio.sleep(GATHER_S)
            some = [self._waiting.popleft() for _ in range(min(AT_ONCE, len(self._waiting)))]
            await self._take(some)
        self._over.clear()

    async def _take(self, some: Sequence[Said]) -> None:
        # Nothing after a failure is taken: there would be a gap.
        said = [one for one in some if one.speaker not in self._over]
        try:
            await self._in_one_transaction(said)
        except Exception:
            await asyncio.gather(*(self._by_itself(theirs) for theirs in _by_speaker(said)))
        for one in said:
            self._tell(one)

    async def _in_one_transaction(self, said: Sequence[Said], careful: bool = False) -> None:
        for one in said:
            one.problem = one.failure = None
        is_durable = any(_must_last(one.envelope) for one in said)
        async with self.fleet.database.transaction(durable=is_durable) as session:
            await self._take_in(session, said, careful)

    async def _by_itself(self, theirs: Sequence[Said]) -> None:
        for number, one in enumerate(theirs):
            try:
                await self._in_one_transaction([one], careful=True)
            except Exception as error:
                one.failure = error
            if one.failure is not None:
                for later in theirs[number:]:
                    later.failure = one.failure
                return

    def _tell(self, one: Said) -> None:
        if one.speaker in self._over:
            return
        if one.failure is None:
            one.speaker.taken(one.envelope, one.problem)
        else:
            self._over.add(one.speaker)
            one.speaker.failed(one.failure)

    # In the transaction.

    async def _take_in(self, session: AsyncSession, said: Sequence[Said], careful: bool) -> None:
        now = self.fleet.clock.utc()
        good = await still_good(session, {one.speaker.token_prefix for one in said})
        said = _from_good_tokens(said, good)
        rows = await _rows(session, {one.speaker.robot for one in said if _is_of_its_row(one, good, now)})
        robots: dict[str, RobotRow | Known] = {known.name: known for known in good.values()} | rows
        before = {name: _seen(robot) for name, robot in rows.items()}
        await self._note_acknowledged(session, said)
        durable = [one for one in said if one.envelope.seq is not None]
        verdicts = await inbox.write_down(session, [one.envelope for one in durable], now)
        new = {id(one) for one, verdict in zip(durable, verdicts, strict=True) if verdict is True}
        for one, verdict in zip(durable, verdicts, strict=True):
            one.failure = verdict if isinstance(verdict, MessageGap) else None
        # Kept until the end: the session forgets rows without a reference.
        ahead = await prefetch(session, [one.envelope.body for one in durable if id(one) in new])
        for one in said:
            if one.envelope.seq is None or id(one) in new:
                robot = robots[one.speaker.robot]
                if isinstance(robot, RobotRow):
                    await compare_again(session, robot, one.envelope.at, now)
                one.problem = await self._follow(session, robot, one.envelope, careful)
        await self.fleet.learning.write_down(session)
        await self.fleet.batteries.note(session, rows.values(), now)
        await _heard(session, robots, rows, now)
        for name, row in rows.items():
            self.fleet.announce(session, row, is_seen=_seen(row) != before[name])
        # What it has received is no news of a robot: it wakes no worker.
        telling = {one.speaker.robot for one in said if not isinstance(one.envelope.body, Ack)}
        self.fleet.have_spoken(session, (robots.keys() - rows.keys()) & telling)
        del ahead

    async def _note_acknowledged(self, session: AsyncSession, said: Sequence[Said]) -> None:
        news: dict[str, tuple[int, int]] = {}
        for one in said:
            had, has = news.get(one.speaker.robot, (one.had, one.had))
            if one.envelope.ack > has:
                news[one.speaker.robot] = (had, one.envelope.ack)
        if news:
            await outbox.acknowledged_by(session, news, self.fleet.clock.utc())

    async def _follow(
        self, session: AsyncSession, robot: RobotRow | Known, envelope: Envelope, careful: bool
    ) -> Error | None:
        """Do what follows. What cannot be followed is written down all the same, or it would come again for ever:
        people get an alarm, the robot the returned error."""
        match envelope.body:
            case Snapshot() | Why() as news if isinstance(robot, RobotRow):
                self.fleet.note(robot, news)
            case Error(message=message):
                sentence = f"The robot could not take a message of the service: {message.rstrip('.')}."
                now = self.fleet.clock.utc()
                await raise_alarm(session, robot.name, "robot_reports_error", sentence, now=now)
            case body if envelope.seq is not None and not careful:
                await self.fleet.follow(session, robot, body)
            case body if envelope.seq is not None:
                return await self._follow_carefully(session, robot, envelope)
        return None

    async def _follow_carefully(
        self, session: AsyncSession, robot: RobotRow | Known, envelope: Envelope
    ) -> Error | None:
        try:
            async with savepoint(session):
                await self.fleet.follow(session, robot, envelope.body)
        except (FleetError, ServiceError) as problem:
            sentence = f"The service could not follow a report of this robot: {str(problem).rstrip('.')}."
            await raise_alarm(session, robot.name, problem.code, sentence, now=self.fleet.clock.utc())
            return Error(code=problem.code, message=str(problem)[:500], seq=envelope.seq)
        return None


def _must_last(envelope: Envelope) -> bool:
    """Tell if it must survive a power cut: what is not numbered would only be said again. But for errors, which ring
    an alarm."""
    return envelope.seq is not None or isinstance(envelope.body, Error)


def _by_speaker(said: Iterable[Said]) -> Iterable[Sequence[Said]]:
    theirs: dict[Speaker, list[Said]] = {}
    for one in said:
        theirs.setdefault(one.speaker, []).append(one)
    return theirs.values()


def _from_good_tokens(said: Sequence[Said], good: Mapping[str, Known]) -> Sequence[Said]:
    """With every message: what was stolen must not go on being heard once it is found out."""
    for one in said:
        one.failure = None if one.speaker.token_prefix in good else TokenRevoked()
    return [one for one in said if one.failure is None]


def _is_of_its_row(one: Said, good: Mapping[str, Known], now: datetime) -> bool:
    """Tell if the message changes what is known of its robot; most tell only of missions and orders."""
    off_s = (one.envelope.at - now).total_seconds()
    return isinstance(one.envelope.body, OF_THE_ROBOT) or has_been_set(
        good[one.speaker.token_prefix].clock_off_s, off_s
    )


async def _rows(session: AsyncSession, names: set[str]) -> dict[str, RobotRow]:
    if not names:
        return {}
    return {row.name: row for row in (await session.exec(_ROBOTS, params={"names": list(names)})).all()}


# In the order of their names: two transactions that lock the same rows never wait for each other.
_ROBOTS: Final = (
    select(RobotRow)
    .where(col(RobotRow.name).in_(bindparam("names", expanding=True)))
    .order_by(col(RobotRow.name))
    .with_for_update()
)
_HEARD: Final = update(RobotRow).where(col(RobotRow.name) == bindparam("of")).values(heard_at=bindparam("at"))


def _seen(robot: RobotRow) -> dict[str, Any]:
    return {name: value for name, value in robot.__dict__.items() if name not in UNSEEN and name[0] != "_"}


async def _heard(session: AsyncSession, names: Iterable[str], rows: Mapping[str, RobotRow], now: datetime) -> None:
    """One statement for all of them."""
    heard = [{"of": name, "at": now} for name in sorted(names)]
    if heard:
        await (await connection_of(session)).execute(_HEARD, heard)
    for row in rows.values():
        set_committed_value(row, "heard_at", now)
