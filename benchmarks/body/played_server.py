"""A server that a test or a benchmark plays, over a real WebSocket on this machine."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime

from websockets.asyncio.server import ServerConnection, serve
from websockets.exceptions import ConnectionClosed

from protocol.envelope import TO_SERVER, Envelope, parse, type_of
from protocol.parts import Part, Received
from protocol.to_robot import Welcome
from protocol.to_server import Hello

AT = datetime(2026, 1, 5, 9, 0, tzinfo=UTC)


def from_server(message: Part, seq: int | None = None, ack: int = 0, journal: str = "server-journal") -> Envelope:
    return Envelope(type=type_of(message), robot="r1", journal=journal, seq=seq, ack=ack, at=AT, body=message)


@dataclass
class PlayedServer:
    """Remembers what robots say, greets them, and says what it is told to."""

    received: Received = field(default_factory=Received)
    journal: str = "server-journal"
    resume_from: int = 1
    home: str | None = None
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
                await self.hear(parse(text, TO_SERVER))
        except ConnectionClosed:
            pass

    async def hear(self, envelope: Envelope) -> None:
        self.heard.append(envelope)
        if isinstance(envelope.body, Hello):
            facts = {"received": self.received, "resume_from": self.resume_from, "home": self.home}
            await self.send(Welcome(server="played", at=AT, **facts))

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
