"""The real service on a real port, and a robot that the test plays over a real WebSocket."""

import asyncio
import math
import socket
import time
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from typing import Any

import pytest
import uvicorn
from fastapi import FastAPI
from sqlmodel import SQLModel, select
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

from app.composition import create_app
from app.core.http_client import HttpClient
from app.core.settings import Settings
from app.models import Order, OrderEvent
from app.orders.views.schemas import NewOrder
from app.robots.link.keepalive import AttentiveSocket
from app.robots.service import enrol
from maps.ways import Ways
from protocol.clock import Clock, SteppedClock
from protocol.envelope import DURABLE, TO_ROBOT, Envelope, parse, type_of
from protocol.parts import Battery, Part, Position, Received, Stop
from protocol.proofs import ShownCode
from protocol.to_robot import Mission, Verifiers, Welcome
from protocol.to_server import Event, HandoverReceipt, Hello, Progress, Step
from tests.app.placed import placed
from tests.plain_maps import plain_map

WAYS = Ways(plain_map("test_track"))
DRIVES_M_S = 0.2
"""As fast as our robots are let drive."""
WITHIN_S = 30.0
"""What comes at all comes at once, but on a busy machine."""


async def until(what: Callable[[], Awaitable[object]], limit_s: float = WITHIN_S) -> Any:
    """Look until there is something to see."""
    end_s = time.monotonic() + limit_s
    while not (seen := await what()):
        assert time.monotonic() < end_s, "waited in vain"
        await asyncio.sleep(0.01)
    return seen


@dataclass
class Service:
    """A service that listens."""

    app: FastAPI
    port: int

    @property
    def url(self) -> str:
        return f"ws://127.0.0.1:{self.port}/api/v1/robots/link"

    async def enrol(self, name: str) -> str:
        async with self.app.state.parts.database.transaction() as session:
            return await enrol(session, self.app.state.parts.clock, name)

    async def order(self, from_post: str = "post1", to_post: str = "post4") -> str:
        """Place an order of the sender to the recipient."""
        state = self.app.state.parts
        async with state.database.transaction() as session:
            sender = await state.sign_in_service.person(session, "sender@campus.example", state.clock.utc())
            request = NewOrder(from_post=from_post, to_post=to_post, recipient="recipient@campus.example")
            return await placed(state.orders, session, sender, request)

    async def cancel(self, order_id: str) -> None:
        state = self.app.state.parts
        async with state.database.transaction() as session:
            sender = await state.sign_in_service.person(session, "sender@campus.example", state.clock.utc())
            await state.orders.cancelling.cancel(session, sender, order_id, "")

    async def rows(self, table: type[SQLModel], **wanted: object) -> list[Any]:
        async with self.app.state.parts.database.reading() as session:
            return list((await session.exec(select(table).filter_by(**wanted))).all())

    async def row(self, table: type[SQLModel], **wanted: object) -> Any:
        (row,) = await self.rows(table, **wanted)
        return row

    async def states(self, order_id: str) -> list[str]:
        """Return the states that the order has been through."""
        events = await self.rows(OrderEvent, order_id=order_id, kind="moved")
        return [str(event.state) for event in sorted(events, key=lambda event: event.seq)]

    async def reaches(self, order_id: str, state: str) -> None:
        async def there() -> bool:
            return str((await self.row(Order, id=order_id)).state) == state

        await until(there)


@asynccontextmanager
async def serving(
    settings: Settings, clock: Clock, ping_s: float = 10.0, http_client: HttpClient | None = None
) -> AsyncIterator[Service]:
    """The service from start to stop; again with the same settings, it is a restart."""
    listening = socket.create_server(("127.0.0.1", 0))
    app = create_app(settings, clock, http_client)
    config = uvicorn.Config(
        app,
        log_config=None,
        ws=AttentiveSocket,
        ws_ping_interval=ping_s,
        ws_ping_timeout=ping_s,
        timeout_graceful_shutdown=1,
    )
    server = uvicorn.Server(config)
    task = asyncio.create_task(server.serve(sockets=[listening]))
    while not server.started:
        assert not task.done(), task.result()
        await asyncio.sleep(0.01)
    try:
        yield Service(app, listening.getsockname()[1])
    finally:
        server.should_exit = True
        await task


def at_post(post: str | None) -> Position:
    return Position(post=post)


@dataclass
class PlayedRobot:
    """Speaks the protocol as a robot does; acknowledges only when told to."""

    clock: Clock
    name: str = "r1"
    journal: str = "journal-1"
    received: Received = field(default_factory=Received)
    seq: int = 0
    heard: list[Envelope] = field(default_factory=list)
    socket: ClientConnection | None = None
    token: str = ""
    handed_over_at: tuple[str, float] | None = None
    receipts: int = 0
    late_s: float = 120.0

    @asynccontextmanager
    async def connected(self, url: str, token: str) -> AsyncIterator["PlayedRobot"]:
        headers = {"Authorization": f"Bearer {token}"}
        # A busy machine may take its time to let a robot in: none of these tests is about that.
        patient = connect(url, additional_headers=headers, proxy=None, open_timeout=60, close_timeout=0.5)
        async with patient as self.socket:
            yield self

    async def say(self, message: Part, seq: int | None = None, **envelope: Any) -> int:
        """Send; a durable message gets the next number unless one is given."""
        if type_of(message) in DURABLE and seq is None:
            self.seq += 1
            seq = self.seq
        facts: dict[str, Any] = {"type": type_of(message), "robot": self.name, "journal": self.journal, "seq": seq}
        facts |= {"ack": self.received.seq, "at": self.clock.utc(), "body": message}
        await self.say_text(Envelope(**{**facts, **envelope}).to_text())
        return seq or 0

    async def say_text(self, text: str) -> None:
        assert self.socket is not None
        await self.socket.send(text)

    async def hear(self, kind: str, limit_s: float = WITHIN_S) -> Envelope:
        """The next message of this type; what else comes is remembered in `heard`."""
        assert self.socket is not None
        async with asyncio.timeout(limit_s):
            while True:
                envelope = parse(await self.socket.recv(), TO_ROBOT)
                self.heard.append(envelope)
                if envelope.seq is not None:
                    self.received = Received(journal=envelope.journal, seq=envelope.seq)
                if envelope.type == kind:
                    return envelope

    async def close_code(self) -> int | None:
        """Wait until the other side closes; what it said before is in `heard`."""
        with pytest.raises(ConnectionClosed):
            await self.hear("nothing of the kind")
        assert self.socket is not None
        return self.socket.close_code

    async def greet(self, post: str | None = "post5", **facts: Any) -> Welcome:
        hello: dict[str, Any] = {
            "received": self.received,
            "position": at_post(post),
            "battery": Battery(ratio=0.9),
            "software": "0.1.0",
            "map_version": "m",
        }
        await self.say(Hello(**{**hello, **facts}))
        welcome = (await self.hear("welcome")).body
        assert isinstance(welcome, Welcome)
        return welcome

    async def mission(self) -> Mission:
        mission = (await self.hear("mission")).body
        assert isinstance(mission, Mission)
        return mission

    async def report(self, mission: Mission, step: Step, stop: Stop | None = None, **facts: Any) -> int:
        return await self.say(self.progress(mission, step, stop, **facts))

    def progress(self, mission: Mission, step: Step, stop: Stop | None = None, **facts: Any) -> Event:
        place = {"stop_id": stop.id, "order_id": stop.order_id, "post": stop.post} if stop else {}
        happened = Progress(step=step, happened_at=self.clock.utc(), mission_id=mission.id, **{**place, **facts})
        return Event(happened=happened)

    def receipt(self, stop: Stop, **facts: Any) -> Event:
        """Mail changed hands there, as a robot tells that is older than proofs: for the code that the server has told
        of; for none, a button was pressed."""
        self._drive_to(stop.post)
        receipt = {
            "purpose": stop.action.value,
            "order_id": stop.order_id,
            "stop_id": stop.id,
            "post": stop.post,
            "happened_at": self._handed_over_at(),
            "code_sha256": next(iter(self.codes(stop)), None),
        }
        return Event(happened=HandoverReceipt.model_validate({**receipt, **facts}))

    def proved_receipt(self, mission: Mission, stop: Stop, code: str, **facts: Any) -> Event:
        """The same by a robot of today, which has read this code."""
        self.receipts += 1
        shown = ShownCode.of(code)
        told = {"code_sha256": shown.sha256, "mission_id": mission.id, "number": self.receipts, **facts}
        receipt = self.receipt(stop, **told).happened
        assert isinstance(receipt, HandoverReceipt)
        return Event(happened=receipt.model_copy(update={"proof": receipt.proved_with(shown.key)}))

    def _drive_to(self, post: str) -> None:
        """It takes the time that a robot needs, where the test says when time passes and has not let so much pass; on a
        real clock it tells late what it did before."""
        before, since_s = self.handed_over_at or (post, 0.0)
        way_m = WAYS.length_m(before, post)
        needs_s = way_m / DRIVES_M_S if math.isfinite(way_m) else 0.0
        if isinstance(self.clock, SteppedClock):
            self.clock.advance(max(0.0, since_s + needs_s - self.clock.now()))
        else:
            self.late_s = max(0.0, self.late_s - needs_s)
        self.handed_over_at = (post, self.clock.now())

    def _handed_over_at(self) -> datetime:
        late_s = 0.0 if isinstance(self.clock, SteppedClock) else self.late_s
        return self.clock.utc() - timedelta(seconds=late_s)

    def codes(self, stop: Stop) -> list[str]:
        """Return the codes that open at this stop, as the server has told."""
        for told in reversed([one.body for one in self.heard if isinstance(one.body, Verifiers)]):
            known = [one for one in told.verifiers if one.order_id == stop.order_id]
            if known:
                return [one.sha256 for one in known if one.purpose == stop.action.value]
        return []

    async def ends(self, seq: int) -> None:
        """Wait until everything up to `seq` is acknowledged."""
        while (await self.hear("ack")).ack < seq:
            pass
