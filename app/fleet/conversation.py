"""One robot's socket, from `hello` to its end. Holds no database session while it waits."""

import asyncio
import contextlib
import json
from collections.abc import Coroutine, Sequence
from typing import Any, Final, TypeVar

import structlog
from sqlmodel.ext.asyncio.session import AsyncSession
from starlette.websockets import WebSocket, WebSocketDisconnect

from app.fleet import outbox
from app.fleet.alarms import raise_alarm
from app.fleet.errors import OutOfTurn, WrongRobot
from app.fleet.greeting import greet
from app.fleet.service import Fleet
from app.fleet.tokens import is_revoked
from app.tables import MessageToRobot, RobotRow, RobotToken
from protocol.both_ways import Ack, Error
from protocol.envelope import TO_ROBOT, TO_SERVER, Envelope, parse, type_of
from protocol.errors import ProtocolError
from protocol.parts import Part
from protocol.to_server import Hello, Snapshot, Why

T = TypeVar("T")

GREETING_LIMIT_S: Final = 10.0
MAX_UNACKNOWLEDGED: Final = 50
NO_JOURNAL: Final = "none"
"""On what is said before the greeting: nothing durable, so that nobody looks at it."""
FAILED: Final = 1011
PROTOCOL_BROKEN: Final = 4400
TOKEN_REFUSED: Final = 4401
REPLACED: Final = 4409

log = structlog.get_logger(__name__)


class Gone(Exception):
    """The socket is closed."""


class TokenRevoked(Exception):
    """The token that opened this connection is worthless by now."""


class Conversation:
    """What one open connection knows. It is this robot's seat in `Connections`."""

    def __init__(self, fleet: Fleet, token: RobotToken, socket: WebSocket) -> None:
        self._fleet, self._robot, self._socket = fleet, token.robot, socket
        self._token_prefix = token.prefix
        self._wake = asyncio.Event()
        self._giving_way = asyncio.Event()
        self._sending = asyncio.Lock()
        self.journal = ""
        self._server_journal = ""
        self._received_seq = 0
        self._acknowledged = 0
        self._sent = 0

    def wake(self) -> None:
        self._wake.set()

    def give_way(self) -> None:
        self._giving_way.set()

    async def run(self) -> None:
        """Until the socket closes, on whichever side, or has to give way to another."""
        try:
            await self._greet()
            await self._talk()
        except Gone:
            pass
        except TokenRevoked:
            log.warning("robot_token_revoked", robot=self._robot)
            await self._close(TOKEN_REFUSED, "token revoked")
        except ProtocolError as error:
            log.warning("robot_refused", robot=self._robot, code=error.code, sentence=str(error))
            await self._close(PROTOCOL_BROKEN, error.code, Error(code=error.code, message=said(error), seq=error.seq))
        except Exception:
            # Our mistake: the robot keeps what it had to say and comes back; whoever reads the log can help it.
            log.exception("conversation_failed", robot=self._robot)
            await self._close(FAILED, "the service has failed")
        finally:
            await self._leave()

    async def _greet(self) -> None:
        try:
            async with asyncio.timeout(GREETING_LIMIT_S):
                envelope = await self._next()
        except TimeoutError:
            raise OutOfTurn(f"no hello within {GREETING_LIMIT_S:.0f} s") from None
        if not isinstance(envelope.body, Hello):
            raise OutOfTurn(f"a connection begins with hello, not with {envelope.type}", envelope.seq)
        self.journal = envelope.journal
        await self._take_seat(envelope, envelope.body)

    async def _take_seat(self, envelope: Envelope, hello: Hello) -> None:
        fleet = self._fleet
        # Seated before the transaction, so that nothing that is told from its commit on can pass us by.
        before = fleet.connections.take(self._robot, self)
        async with fleet.database.transaction() as session:
            robot = await robot_row(session, self._robot)
            if before is not None:
                await self._note_second(session, before.journal)
            greeted = await greet(session, fleet, robot, envelope, hello)
        self._server_journal = greeted.server_journal
        self._received_seq = greeted.received_seq
        self._acknowledged = self._sent = greeted.acknowledged_seq
        await self._send(greeted.welcome)
        log.info("robot_online", robot=self._robot, journal=self.journal)

    async def _note_second(self, session: AsyncSession, journal_before: str) -> None:
        """With the same journal it is the same robot, back before its old connection was found to be dead."""
        log.warning("second_socket", robot=self._robot, journal=self.journal, journal_before=journal_before)
        if journal_before != self.journal:
            sentence = "a second connection with this robot's token replaced the first: has the token been copied?"
            await raise_alarm(session, self._robot, "second_socket", sentence, now=self._fleet.clock.utc())

    async def _talk(self) -> None:
        tasks = [asyncio.create_task(work) for work in (self._read(), self._write(), self._until_giving_way())]
        try:
            done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
        for task in done:
            task.result()
        await self._close(REPLACED, "another connection of this robot took this one's place")

    async def _until_giving_way(self) -> None:
        await self._giving_way.wait()

    # From the robot.

    async def _next(self) -> Envelope:
        frame = await self._socket.receive()
        if frame["type"] == "websocket.disconnect":
            raise Gone
        text = frame.get("text")
        envelope = parse(text if text is not None else frame.get("bytes") or b"", TO_SERVER)
        if envelope.robot != self._robot:
            raise WrongRobot(f"signed in as {self._robot}, speaking as {envelope.robot}", envelope.seq)
        return envelope

    async def _read(self) -> None:
        while True:
            envelope = await self._next()
            if isinstance(envelope.body, Hello) or envelope.journal != self.journal:
                raise OutOfTurn("a connection has one hello and one journal", envelope.seq)
            await self._handle(envelope)

    async def _handle(self, envelope: Envelope) -> None:
        if isinstance(envelope.body, Ack) and envelope.ack <= self._acknowledged:
            return
        problem = await unbroken(self._take(envelope))
        if envelope.ack > self._acknowledged:
            self._acknowledged = envelope.ack
            self._wake.set()
        if envelope.seq is not None:
            # Acknowledged after the commit: a crash in between must make the robot send it again.
            self._received_seq = max(self._received_seq, envelope.seq)
            await self._send(problem or Ack())

    async def _take(self, envelope: Envelope) -> Error | None:
        async with self._fleet.database.transaction() as session:
            return await self._take_in(session, envelope)

    async def _take_in(self, session: AsyncSession, envelope: Envelope) -> Error | None:
        fleet = self._fleet
        await self._check_token(session)
        robot = await robot_row(session, self._robot)
        robot.heard_at = fleet.clock.utc()
        if envelope.ack > self._acknowledged:
            await outbox.acknowledged(session, self._robot, envelope.ack, fleet.clock.utc())
        match envelope.body:
            case Snapshot() | Why():
                fleet.note(session, robot, envelope.body)
            case Error(code=code, message=message):
                sentence = f"{code}: {message}"
                await raise_alarm(session, self._robot, "robot_reports_error", sentence, now=robot.heard_at)
            case Ack():
                pass
            case _:
                return await fleet.take(session, robot, envelope)
        return None

    # To the robot.

    async def _write(self) -> None:
        while True:
            self._wake.clear()
            room = MAX_UNACKNOWLEDGED - (self._sent - self._acknowledged)
            for row in await unbroken(self._pending(max(0, room))):
                await self._send(TO_ROBOT[row.type].model_validate_json(json.dumps(row.body)), row.seq)
                self._sent = row.seq
            await self._wake.wait()

    async def _pending(self, limit: int) -> Sequence[MessageToRobot]:
        async with self._fleet.database.reading() as session:
            await self._check_token(session)
            return await outbox.pending(session, self._robot, self._sent, limit)

    async def _check_token(self, session: AsyncSession) -> None:
        """With every message: what was stolen must not go on being heard, or told, once it is found out."""
        if await is_revoked(session, self._token_prefix):
            raise TokenRevoked

    async def _send(self, message: Part, seq: int | None = None) -> None:
        envelope = Envelope(
            type=type_of(message),
            robot=self._robot,
            journal=self._server_journal or NO_JOURNAL,
            seq=seq,
            ack=self._received_seq,
            at=self._fleet.clock.utc(),
            body=message,
        )
        try:
            async with self._sending:
                await self._socket.send_text(envelope.to_text())
        except (WebSocketDisconnect, RuntimeError):  # Starlette says RuntimeError once the close has been seen
            raise Gone from None

    async def _close(self, code: int, reason: str, last_word: Error | None = None) -> None:
        with contextlib.suppress(Gone, WebSocketDisconnect, RuntimeError):  # closed already, which is what we want
            if last_word is not None:
                await self._send(last_word)
            await self._socket.close(code, reason[:100])

    async def _leave(self) -> None:
        fleet = self._fleet
        if not fleet.connections.leave(self._robot, self):
            return
        async with fleet.database.transaction() as session:
            robot = await robot_row(session, self._robot)
            if not fleet.connections.is_seated(self._robot):
                robot.online = False
                fleet.announce(session, robot)
        log.info("robot_offline", robot=self._robot)


async def unbroken(work: Coroutine[Any, Any, T]) -> T:
    """Do it to its end, even if the connection ends meanwhile.

    A transaction that is cancelled half-way may be committed all the same, and then nobody would be told: what it put
    into the outbox would wait until something else happened.
    """
    task = asyncio.create_task(work)
    try:
        return await asyncio.shield(task)
    except asyncio.CancelledError:
        await asyncio.wait([task])
        if not task.cancelled() and (error := task.exception()):
            log.warning("last_work_failed", error=repr(error))
        raise


def said(error: Exception) -> str:
    """An error's sentence, no longer than a message may carry."""
    return str(error)[:500]


async def robot_row(session: AsyncSession, name: str) -> RobotRow:
    """The row of a robot that has signed in."""
    robot = await session.get(RobotRow, name, with_for_update=True)
    assert robot is not None, f"robot {name} signed in and has no row"  # noqa: S101  # its token refers to it
    return robot
