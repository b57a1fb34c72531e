"""One connection to the server, from `hello` to its end: who sends what when, and when something counts as received.

Order on the wire: hello → welcome → the newest snapshot (so that the page is right at once) → the backlog, flagged as
replay → what happens from then on. A message from the server is acknowledged when it is on the robot's disk, never
before.
"""

import asyncio
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, Protocol

import structlog

from protocol.both_ways import Ack, Error
from protocol.clock import Clock
from protocol.diagnostics import Diagnostics
from protocol.envelope import TO_ROBOT, Envelope, parse, type_of
from protocol.errors import ProtocolError
from protocol.parts import Part, sentence
from protocol.sequence import Reception
from protocol.to_robot import Watch, Welcome
from protocol.to_server import Hello, Snapshot, Why
from robot.core.errors import RobotError
from robot.mission.memory import Incoming, Memory
from robot.mission.outbox import Kept, Outbox

MAX_UNACKNOWLEDGED: Final = 50
"""Sent and not yet acknowledged: beyond this the backlog waits, so that a slow server is not buried."""

log = structlog.get_logger("robot.link.link")


class LinkBroken(RobotError):
    """This connection cannot go on; the next one resumes where it stopped."""


class Socket(Protocol):
    """The interface of a WebSocket that a connection needs."""

    async def send(self, message: str, /) -> None: ...
    async def recv(self) -> str | bytes: ...
    async def close(self, code: int = 1000, reason: str = "") -> None: ...


@dataclass(frozen=True)
class Rhythm:
    """Intervals and time limits of the connection.

    What concerns the network runs on the machine's own time, however fast a simulated clock runs: a ping answered after
    100 ms is no dead network, even if that was a minute in the world. What concerns the world runs on its clock, with
    a floor in real time, so that a fast clock does not flood the server.
    """

    ping_every_s: float = 2.0  # real; with the limit below, a dead network is noticed after 8 s at most
    ping_limit_s: float = 6.0  # real
    greeting_limit_s: float = 10.0  # real
    snapshot_every_s: float = 1.0  # of the clock
    snapshot_floor_s: float = 0.2  # real
    retry_first_s: float = 0.2  # of the clock
    retry_longest_s: float = 15.0  # of the clock
    retry_floor_s: float = 0.1  # real
    settled_after_s: float = 5.0  # real; a connection that lasted so long was a good one: the next try is quick again


@dataclass
class Newest:
    """Values that are never queued: a newer one replaces the older. Written by the daemon's thread, read by ours."""

    snapshot: Snapshot | None = None
    why: Why | None = None
    diagnostics: Callable[[], Diagnostics] | None = None
    """Made when its turn comes. There is room for the next once it is on its way: a slow link makes them rarer."""

    def take(self, news: Snapshot | Why) -> bool:
        """Return whether it says anything new."""
        if isinstance(news, Snapshot):
            before, self.snapshot = self.snapshot, news
            return news != before
        said, self.why = self.why, news
        return news != said


@dataclass(frozen=True)
class Ends:
    """The two ends of a connection: this robot's memory on one side, the daemon's queue on the other."""

    robot: str
    clock: Clock
    outbox: Outbox
    memory: Memory
    hello_source: Callable[[], Hello]
    newest: Newest
    deliver: Callable[[Incoming], None]
    rhythm: Rhythm
    watched: Callable[[Watch], None] = lambda _: None


class Connection:
    """Runs over one open socket until that breaks; raises LinkBroken, ProtocolError or what the socket raises."""

    def __init__(self, socket: Socket, ends: Ends, wake: asyncio.Event, room: asyncio.Event) -> None:
        self._socket = socket
        self._ends = ends
        self._wake = wake
        self._room = room
        self._received_seq = 0
        self._acknowledged = 0
        self._sent = 0
        self._backlog_until = 0
        self._sent_snapshot: Snapshot | None = None
        self._sent_why: Why | None = None
        self._snapshot_due_s = 0.0

    async def greet(self) -> None:
        """Hello, welcome, and both sides know where the other stands."""
        ends = self._ends
        ends.newest.diagnostics = None  # earlier thoughts are no news to a client that watches now
        received = ends.memory.received()
        facts = {"received": received, "resume_from": ends.outbox.resume_from()}
        await self._send(ends.hello_source().model_copy(update=facts))
        async with asyncio.timeout(ends.rhythm.greeting_limit_s):
            envelope = await self._next()
        if isinstance(envelope.body, Error):
            raise LinkBroken(f"the server refused the greeting: {envelope.body.message} ({envelope.body.code})")
        if not isinstance(envelope.body, Welcome):
            raise LinkBroken(f"the server began with {envelope.type} and not with welcome")
        self._take_up(envelope, envelope.body)

    def _take_up(self, envelope: Envelope, welcome: Welcome) -> None:
        outbox, memory = self._ends.outbox, self._ends.memory
        if welcome.received.journal == outbox.journal and welcome.received.seq > outbox.last_seq():
            # Our disk was put back from an older copy: the server would take our next news for old.
            outbox.renew_journal()
            raise LinkBroken("the server knows later messages of this robot than the robot does: a new journal begins")
        if welcome.home is not None and welcome.home != memory.home():
            memory.keep_home(welcome.home)
            self._ends.deliver(Incoming(welcome, envelope.journal))  # what is held has changed
        lost = memory.resume(envelope.journal, welcome.resume_from)
        if lost:
            log.error("messages_from_server_lost", count=lost, journal=envelope.journal)
        self._received_seq = memory.received().seq
        if welcome.received.journal == outbox.journal:
            self._note_acknowledged(welcome.received.seq)
        self._sent = self._acknowledged
        self._backlog_until = outbox.last_seq()

    async def run(self) -> None:
        """Talk until the connection ends; call `greet` first."""
        tasks = [asyncio.create_task(self._read()), asyncio.create_task(self._write())]
        try:
            done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
        for task in done:
            task.result()

    # From the server.

    async def _read(self) -> None:
        while True:
            await self._room.wait()  # back-pressure: the daemon has not taken what came before
            await self._take(await self._next())

    async def _next(self) -> Envelope:
        text = await self._socket.recv()
        try:
            return parse(text, TO_ROBOT)
        except ProtocolError as error:
            # A message that we cannot read must be known to those who can update one side or the other.
            await self._send(Error(code=error.code, message=sentence(error), seq=error.seq))
            await self._socket.close(4400, error.code)
            raise

    async def _take(self, envelope: Envelope) -> None:
        self._note_acknowledged(envelope.ack)
        if envelope.seq is not None:
            await self._take_durable(envelope, envelope.seq)
        elif isinstance(envelope.body, Error):
            log.error("server_reports_error", code=envelope.body.code, sentence=envelope.body.message)
            self._ends.deliver(Incoming(envelope.body, envelope.journal))
        elif isinstance(envelope.body, Watch):
            self._ends.watched(envelope.body)

    async def _take_durable(self, envelope: Envelope, seq: int) -> None:
        taken = self._ends.memory.receive(envelope)
        if taken.reception is Reception.GAP:
            raise LinkBroken(f"message {seq} came from the server, {self._received_seq + 1} was next")
        self._received_seq = max(self._received_seq, seq)
        if taken.reception is Reception.NEW and taken.refusal is None:
            # Before anything is sent: if the connection breaks just now, it would not be delivered until the next
            # start.
            self._ends.deliver(Incoming(envelope.body, envelope.journal, seq))
        # Acknowledged after it is on the disk: a crash in between must make the server send it again.
        await self._send(Ack())
        if taken.refusal is not None:
            log.error("message_refused", seq=seq, reason=str(taken.refusal))
            await self._send(Error(code=taken.refusal.code, message=str(taken.refusal), seq=seq))

    def _note_acknowledged(self, seq: int) -> None:
        if seq > self._acknowledged:
            self._ends.outbox.acknowledged(seq)
            self._acknowledged = seq
            self._wake.set()

    # To the server.

    async def _write(self) -> None:
        while True:
            self._wake.clear()
            await self._send_newest()
            await self._send_kept()
            await self._send_diagnostics()
            try:
                async with asyncio.timeout(self._until_snapshot_s()):
                    await self._wake.wait()
            except TimeoutError:
                pass  # the next snapshot is due

    async def _send_newest(self) -> None:
        snapshot, why = self._ends.newest.snapshot, self._ends.newest.why
        if snapshot is not None and snapshot != self._sent_snapshot and self._now_s() >= self._snapshot_due_s:
            await self._send(snapshot)
            self._sent_snapshot = snapshot
            self._snapshot_due_s = self._now_s() + self._snapshot_gap_s()
        if why is not None and why != self._sent_why:
            await self._send(why)
            self._sent_why = why

    async def _send_kept(self) -> None:
        room = MAX_UNACKNOWLEDGED - (self._sent - self._acknowledged)
        for kept in self._ends.outbox.pending(after=self._sent, limit=max(0, room)):
            await self._send_numbered(kept)
            self._sent = kept.seq

    async def _send_diagnostics(self) -> None:
        """Last of all. The socket takes no more while the network does not: then there is no room for the next one."""
        diagnostics = self._ends.newest.diagnostics
        if diagnostics is not None:
            await self._send(diagnostics())
            self._ends.newest.diagnostics = None

    def _snapshot_gap_s(self) -> float:
        rhythm = self._ends.rhythm
        return max(rhythm.snapshot_floor_s, self._ends.clock.real_s(rhythm.snapshot_every_s))

    def _until_snapshot_s(self) -> float | None:
        if self._ends.newest.snapshot == self._sent_snapshot:
            return None
        return max(0.0, self._snapshot_due_s - self._now_s())

    def _now_s(self) -> float:
        return asyncio.get_running_loop().time()

    async def _send_numbered(self, kept: Kept) -> None:
        await self._send(kept.message, kept.seq, replay=kept.seq <= self._backlog_until)

    async def _send(self, message: Part, seq: int | None = None, replay: bool = False) -> None:
        envelope = Envelope(
            type=type_of(message),
            robot=self._ends.robot,
            journal=self._ends.outbox.journal,
            seq=seq,
            ack=self._received_seq,
            at=self._ends.clock.utc(),
            replay=replay,
            body=message,
        )
        await self._socket.send(envelope.to_text())
