"""A server that a test plays, and what the daemon has in its hands at the other end of the link."""

import asyncio
import time
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime

from websockets.asyncio.server import ServerConnection, serve
from websockets.exceptions import ConnectionClosed

from protocol.clock import RealClock
from protocol.envelope import TO_SERVER, Envelope, parse, type_of
from protocol.parts import Activity, Battery, Leg, Part, Position, Received, Stop, StopAction
from protocol.to_robot import Mission, Welcome
from protocol.to_server import Clear, Hello, Snapshot
from robot.connection import Rhythm
from robot.link import Link
from robot.memory import Memory
from robot.outbox import Outbox
from robot.store import Store

AT = datetime(2026, 1, 5, 9, 0, tzinfo=UTC)
QUICK = Rhythm(ping_limit_s=20.0, retry_longest_s=0.2, snapshot_every_s=0.3)
IMPATIENT = Rhythm(ping_every_s=0.3, ping_limit_s=0.5, retry_longest_s=0.2)
MISSION = Mission(id="m1", update=1, stops=(Stop(id="s1", post="post1", action=StopAction.LOAD, order_id="o1"),))


def from_server(message: Part, seq: int | None = None, ack: int = 0, journal: str = "server-journal") -> Envelope:
    return Envelope(type=type_of(message), robot="r1", journal=journal, seq=seq, ack=ack, at=AT, body=message)


@dataclass
class PlayedServer:
    """Remembers what robots say and says what the test wants."""

    received: Received = field(default_factory=Received)
    journal: str = "server-journal"
    resume_from: int = 1
    heard: list[Envelope] = field(default_factory=list)
    sockets: list[ServerConnection] = field(default_factory=list)
    tokens: list[str | None] = field(default_factory=list)
    url: str = ""

    async def serve_one(self, socket: ServerConnection) -> None:
        assert socket.request is not None
        self.tokens.append(socket.request.headers.get("Authorization"))
        self.sockets.append(socket)
        try:
            async for text in socket:
                envelope = parse(text, TO_SERVER)
                self.heard.append(envelope)
                if isinstance(envelope.body, Hello):
                    welcome = Welcome(received=self.received, resume_from=self.resume_from, server="played", at=AT)
                    await self.send(welcome)
        except ConnectionClosed:
            pass

    async def send(self, message: Part, seq: int | None = None, ack: int = 0) -> None:
        await self.sockets[-1].send(from_server(message, seq, ack, self.journal).to_text())

    def types(self) -> list[str]:
        return [envelope.type for envelope in self.heard]

    def numbers(self) -> list[int]:
        return [envelope.seq for envelope in self.heard if envelope.seq is not None]


@asynccontextmanager
async def playing(port: int = 0, server: PlayedServer | None = None) -> AsyncIterator[PlayedServer]:
    server = server or PlayedServer()
    async with serve(server.serve_one, "127.0.0.1", port) as listening:
        server.url = f"ws://127.0.0.1:{listening.sockets[0].getsockname()[1]}"
        yield server


@dataclass
class Robot:
    """What the daemon has in its hands."""

    store: Store
    outbox: Outbox
    memory: Memory

    @asynccontextmanager
    async def linked(self, url: str, rhythm: Rhythm = QUICK) -> AsyncIterator[Link]:
        link = Link(
            url=url,
            token="cmr_a_b",
            robot="r1",
            clock=RealClock(),
            outbox=self.outbox,
            memory=self.memory,
            hello_source=lambda: Hello(
                position=self.memory.position(),
                cargo=self.memory.cargo(),
                mission=self.memory.mission_held(),
                battery=Battery(ratio=0.8),
                software="0.1.0",
                map_version="m1",
            ),
            rhythm=rhythm,
        )
        link.start()
        try:
            yield link
        finally:
            await asyncio.to_thread(link.stop)


async def until(what: Callable[[], object], limit_s: float = 5.0) -> None:
    end_s = time.monotonic() + limit_s
    while not what():
        assert time.monotonic() < end_s, "waited in vain"
        await asyncio.sleep(0.01)


def cleared(post: str = "post2") -> Clear:
    return Clear(leg=Leg(from_post="post1", to_post=post))


def a_snapshot(post: str) -> Snapshot:
    return Snapshot(position=Position(post=post), activity=Activity.DRIVING, battery=Battery(ratio=0.7))
