"""One robot's socket, from `hello` to its end. Holds no database session while it waits."""

import asyncio
import contextlib
from collections.abc import Collection, Sequence
from typing import Final

import structlog
from sqlmodel.ext.asyncio.session import AsyncSession
from starlette.websockets import WebSocket, WebSocketDisconnect

from app.models import RobotRow, RobotToken
from app.robots.alarms import raise_alarm
from app.robots.conversation.handshake import greet
from app.robots.conversation.intake import Intake, TokenRevoked
from app.robots.errors import OutOfTurn, WrongRobot
from app.robots.homes import check_home
from app.robots.link import outbox
from app.robots.link.outbox import Waiting
from app.robots.link.tokens import note_use
from protocol.both_ways import Ack, Error
from protocol.diagnostics import Diagnostics
from protocol.envelope import TO_SERVER, Envelope, Head, parse, type_of
from protocol.errors import ProtocolError
from protocol.parts import Part, sentence
from protocol.to_robot import Watch
from protocol.to_server import Hello

GREETING_LIMIT_S: Final = 10.0
MAX_UNACKNOWLEDGED: Final = 50
MAX_IN_HAND: Final = 100
"""Read and not yet on the disk: a robot that says more than that is read no further."""
OF_THE_MOMENT: Final = (Ack, Diagnostics)
"""What says nothing to the disk but what it acknowledges."""
NO_JOURNAL: Final = "none"
"""On what is said before the handshake: nothing durable, so that it is not read."""
FAILED: Final = 1011
PROTOCOL_BROKEN: Final = 4400
TOKEN_REFUSED: Final = 4401
REPLACED: Final = 4409

log = structlog.get_logger(__name__)


class Gone(Exception):
    """The socket is closed."""


class Conversation:
    """One open connection. It is this robot's seat in `Connections`."""

    def __init__(self, intake: Intake, token: RobotToken, socket: WebSocket) -> None:
        self._intake, self._fleet, self._socket = intake, intake.fleet, socket
        self.robot, self.token_prefix = token.robot, token.prefix
        self.journal = ""
        self.acknowledged = 0
        self._server_journal = ""
        self._received_seq = 0
        self._sent = 0
        self._wake = asyncio.Event()
        self._end: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._room = asyncio.Semaphore(MAX_IN_HAND)
        self._owes_ack = False
        self._problems: list[Error] = []
        self._look_again = True
        self._is_held_back = False
        self._knows_watching = False
        self.understands: Collection[str] = ()
        self._watch: Watch | None = None

    def wake(self) -> None:
        self._look_again = True
        self._wake.set()

    def watch(self, watch: Watch) -> bool:
        if self._knows_watching:
            whole = watch.whole or (self._watch is not None and self._watch.whole)
            self._watch = Watch(for_s=watch.for_s, whole=whole)
            self._wake.set()
        return self._knows_watching

    def give_way(self) -> None:
        if not self._end.done():
            self._end.set_result(None)

    async def run(self) -> None:
        """Until the socket closes, on whichever side, or has to give way to another."""
        try:
            await self._greet()
            await self._talk()
        except Gone:
            pass
        except TokenRevoked:
            log.warning("robot_token_revoked", robot=self.robot)
            await self._close(TOKEN_REFUSED, "token revoked")
        except ProtocolError as error:
            log.warning("robot_refused", robot=self.robot, code=error.code, sentence=str(error))
            await self._close(
                PROTOCOL_BROKEN, error.code, Error(code=error.code, message=sentence(error), seq=error.seq)
            )
        except Exception:
            # Our mistake: the robot keeps what it had to say and comes back; the reader of the log can help it.
            log.exception("conversation_failed", robot=self.robot)
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
        self.understands = hello.understands
        # Seated before the transaction, so that nothing that is told from its commit on can pass us by.
        before = fleet.connections.take(self.robot, self)
        async with fleet.database.transaction() as session:
            await note_use(session, self.token_prefix, fleet.clock.utc())
            robot = await robot_row(session, self.robot)
            if before is not None:
                await self._note_second(session, before.journal)
            refusal = await check_home(session, fleet.campus, robot, hello, fleet.clock.utc())
            if refusal is None:
                greeted = await greet(session, fleet, robot, envelope, hello)
        if refusal is not None:
            raise refusal  # after the commit: its alarm stays
        self._server_journal = greeted.server_journal
        self._received_seq = greeted.received_seq
        self.acknowledged = self._sent = greeted.acknowledged_seq
        await self._send(greeted.welcome)
        self._knows_watching = "watch" in hello.understands
        if (watch := fleet.watching.wanted_of(self.robot)) is not None:
            self.watch(watch)
        log.info("robot_online", robot=self.robot, journal=self.journal)

    async def _note_second(self, session: AsyncSession, journal_before: str) -> None:
        """With the same journal it is the same robot, back before its old connection was found to be dead."""
        log.warning("second_socket", robot=self.robot, journal=self.journal, journal_before=journal_before)
        if journal_before != self.journal:
            sentence = "a second connection with this robot's token replaced the first: has the token been copied?"
            await raise_alarm(session, self.robot, "second_socket", sentence, now=self._fleet.clock.utc())

    async def _talk(self) -> None:
        tasks = [asyncio.create_task(work) for work in (self._read(), self._write(), self._until_it_has_to_end())]
        try:
            done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
        for task in done:
            task.result()
        await self._close(REPLACED, "another connection of this robot took this one's place")

    async def _until_it_has_to_end(self) -> None:
        await self._end

    # From the robot.

    async def _next(self) -> Envelope:
        frame = await self._socket.receive()
        if frame["type"] == "websocket.disconnect":
            raise Gone
        text = frame.get("text")
        envelope = parse(text if text is not None else frame.get("bytes") or b"", TO_SERVER)
        if envelope.robot != self.robot:
            raise WrongRobot(f"signed in as {self.robot}, speaking as {envelope.robot}", envelope.seq)
        return envelope

    async def _read(self) -> None:
        while True:
            envelope = await self._next()
            if isinstance(envelope.body, Hello) or envelope.journal != self.journal:
                raise OutOfTurn("a connection has one hello and one journal", envelope.seq)
            if isinstance(envelope.body, Diagnostics):
                self._fleet.watching.show(self.robot, envelope.body, self._fleet.clock.utc())
            if isinstance(envelope.body, OF_THE_MOMENT) and envelope.ack <= self.acknowledged:
                continue
            await self._room.acquire()
            had = self.acknowledged
            self._count(envelope.ack)
            self._intake.hear(self, envelope, had)

    def _count(self, ack: int) -> None:
        """At once: what the robot has need not be known to the disk before it is told more."""
        if ack > self.acknowledged:
            self.acknowledged = ack
            if self._is_held_back:
                self.wake()

    def taken(self, envelope: Envelope, problem: Error | None) -> None:
        self._room.release()
        if envelope.seq is not None:
            # Acknowledged after the commit: a crash in between must make the robot send it again.
            self._received_seq = max(self._received_seq, envelope.seq)
            self._owes_ack = True
            if problem is not None:
                self._problems.append(problem)
        self._wake.set()

    def failed(self, error: Exception) -> None:
        if not self._end.done():
            self._end.set_exception(error)
            self._end.exception()  # if the connection has ended meanwhile, it is not asked for

    # To the robot.

    async def _write(self) -> None:
        while True:
            self._wake.clear()
            await self._answer()
            await self._send_watch()
            if self._look_again:
                self._look_again = False
                await self._send_waiting()
            await self._wake.wait()

    async def _answer(self) -> None:
        """One acknowledgement for all that has been taken meanwhile; any answer carries it."""
        problems, self._problems = self._problems, []
        if self._owes_ack and not problems:
            await self._send(Ack())
        self._owes_ack = False
        for problem in problems:
            await self._send(problem)

    async def _send_watch(self) -> None:
        watch, self._watch = self._watch, None
        if watch is not None:
            await self._send(watch)

    async def _send_waiting(self) -> None:
        room = max(0, MAX_UNACKNOWLEDGED - (self._sent - self.acknowledged))
        rows = await self._waiting(room) if room else []
        self._is_held_back = len(rows) == room
        for row in rows:
            if not row.may_hear:
                raise TokenRevoked
            await self._send_text(row.type, row.body, row.seq)
            self._sent = row.seq

    async def _waiting(self, limit: int) -> Sequence[Waiting]:
        async with self._fleet.database.reading() as session:
            return await outbox.pending(session, self.robot, self.token_prefix, self._sent, limit)

    async def _send(self, message: Part) -> None:
        await self._send_text(type_of(message), message.model_dump_json())

    async def _send_text(self, kind: str, body: str, seq: int | None = None) -> None:
        head = Head(
            type=kind,
            robot=self.robot,
            journal=self._server_journal or NO_JOURNAL,
            seq=seq,
            ack=self._received_seq,
            at=self._fleet.clock.utc(),
        )
        try:
            await self._socket.send_text(head.around(body))
        except (WebSocketDisconnect, RuntimeError):  # Starlette says RuntimeError once the close has been seen
            raise Gone from None

    async def _close(self, code: int, reason: str, last_word: Error | None = None) -> None:
        with contextlib.suppress(Gone, WebSocketDisconnect, RuntimeError):  # closed already, which is what we want
            if last_word is not None:
                await self._send(last_word)
            await self._socket.close(code, reason[:100])

    async def _leave(self) -> None:
        fleet = self._fleet
        if not fleet.connections.leave(self.robot, self):
            return
        async with fleet.database.transaction() as session:
            robot = await robot_row(session, self.robot)
            if not fleet.connections.is_seated(self.robot):
                robot.online = False
                fleet.announce(session, robot)
        log.info("robot_offline", robot=self.robot)


async def robot_row(session: AsyncSession, name: str) -> RobotRow:
    """The row of a robot that has signed in."""
    robot = await session.get(RobotRow, name, with_for_update=True)
    assert robot is not None, f"robot {name} signed in and has no row"  # noqa: S101  # its token refers to it
    return robot
