"""The robot's real link and the real service, over a wire that breaks: every message once, in order, both ways."""

import asyncio
import contextlib
import random
import socket
import time
from collections.abc import AsyncIterator, Awaitable, Callable, Iterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest
import uvicorn
from fastapi import FastAPI
from sqlmodel import select

from app.composition import create_app
from app.core.database.database import Database
from app.core.settings import Settings
from app.models import ClaimRow, MessageToRobot, RobotMessage, RobotRow
from app.robots.service import enrol
from maps import builtin_map
from protocol.clock import RealClock
from protocol.parts import Battery, Leg, Received
from protocol.to_robot import Deny
from protocol.to_server import Claim, Clear, Hello
from robot.link.connection import Rhythm
from robot.link.link import Link, LinkState
from robot.mission.memory import Memory
from robot.mission.outbox import Outbox
from robot.mission.store import Store

pytestmark = pytest.mark.system

TRACK = builtin_map("test_track")
LEGS = [Leg(from_post=a, to_post=b) for c in TRACK.corridors for a, b in ((c.a, c.b), (c.b, c.a))]
NO_LEG = Leg(from_post=TRACK.corridors[0].a, to_post="nowhere")
EAGER = Rhythm(retry_first_s=0.05, retry_longest_s=0.1, retry_floor_s=0.02)


class BreakingWire:
    """TCP from a port of its own to the service; every connection breaks after some bytes, or when told to."""

    def __init__(self, target_port: int, chance: random.Random) -> None:
        self.target_port, self._chance = target_port, chance
        self.breaks = True
        self.connections = 0
        self._open: set[asyncio.StreamWriter] = set()

    async def __aenter__(self) -> "BreakingWire":
        self._server = await asyncio.start_server(self._serve, "127.0.0.1", 0)
        self.port = self._server.sockets[0].getsockname()[1]
        return self

    async def __aexit__(self, *_: object) -> None:
        self._server.close()
        self.cut()

    def cut(self) -> None:
        for writer in self._open:
            writer.transport.abort()

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self.connections += 1
        try:
            far_reader, far_writer = await asyncio.open_connection("127.0.0.1", self.target_port)
        except OSError:
            writer.transport.abort()
            return
        both = {writer, far_writer}
        self._open |= both
        left = [self._chance.randrange(600, 12_000)]
        copies = (self._copy(reader, far_writer, left), self._copy(far_reader, writer, left))
        await asyncio.gather(*copies)
        self._open -= both
        for end in both:
            end.transport.abort()

    async def _copy(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter, left: list[int]) -> None:
        with contextlib.suppress(OSError):
            while data := await reader.read(256):
                left[0] -= len(data)
                if self.breaks and left[0] < 0:  # somewhere in the middle of a message
                    writer.write(data[: len(data) // 2])
                    break
                writer.write(data)
                await writer.drain()
        writer.transport.abort()


async def until(what: Callable[[], Awaitable[object]], limit_s: float = 60.0) -> Any:
    end_s = time.monotonic() + limit_s
    while not (seen := await what()):
        assert time.monotonic() < end_s, "waited in vain"
        await asyncio.sleep(0.02)
    return seen


@asynccontextmanager
async def serving(settings: Settings, port: int = 0) -> AsyncIterator[tuple[FastAPI, int]]:
    listening = socket.create_server(("127.0.0.1", port), reuse_port=False)
    app = create_app(settings, RealClock())
    server = uvicorn.Server(uvicorn.Config(app, log_config=None, ws="websockets-sansio", timeout_graceful_shutdown=1))
    task = asyncio.create_task(server.serve(sockets=[listening]))
    while not server.started:
        assert not task.done(), task.result()
        await asyncio.sleep(0.01)
    try:
        yield app, listening.getsockname()[1]
    finally:
        server.should_exit = True
        await task


@pytest.fixture
def settings(tmp_path: Path) -> Settings:
    pages = tmp_path / "pages"
    for part in ("public", "src"):
        (pages / part).mkdir(parents=True)
    (pages / "public/index.html").write_text('<script type="importmap">{"imports": {}}</script>')
    return Settings(data=tmp_path / "service", pages=pages)


@pytest.fixture
def store(tmp_path: Path) -> Iterator[Store]:
    with Store(tmp_path / "robot.db") as store:
        yield store


@asynccontextmanager
async def linked(store: Store, outbox: Outbox, memory: Memory, port: int, token: str) -> AsyncIterator[Link]:
    link = Link(
        url=f"ws://127.0.0.1:{port}/api/v1/robots/link",
        token=token,
        robot="r1",
        clock=RealClock(),
        outbox=outbox,
        memory=memory,
        hello_source=lambda: Hello(
            position=memory.position(), battery=Battery(ratio=0.9), software="test", map_version=TRACK.version
        ),
        rhythm=EAGER,
    )
    link.start()
    try:
        yield link
    finally:
        await asyncio.to_thread(link.stop)


async def enrolled(app: FastAPI) -> str:
    async with app.state.parts.database.transaction() as session:
        return await enrol(session, RealClock(), "r1")


async def rows(database: Database, table: Any) -> list[Any]:
    async with database.reading() as session:
        return list((await session.exec(select(table))).all())


@pytest.mark.slow
async def test_over_a_wire_that_breaks_again_and_again_every_message_arrives_once_and_in_order(
    settings: Settings, store: Store
) -> None:
    """Claims of corridors that are not there one way, refusals the other, so that both journals are at work."""
    chance, count = random.Random(7), 60
    outbox, memory = Outbox(store), Memory(store)
    async with serving(settings) as (app, port), BreakingWire(port, chance) as wire:
        token = await enrolled(app)
        async with linked(store, outbox, memory, wire.port, token) as link:
            refused: list[str] = []
            for number in range(count):
                outbox.put(Claim(claim_id=f"c{number}", legs=(NO_LEG,)))
                link.wake()
                await asyncio.sleep(0.01)

            async def everything_is_refused() -> bool:
                for incoming in link.incoming():
                    assert isinstance(incoming.message, Deny)
                    refused.append(incoming.message.claim_id)
                    memory.handled(incoming)
                return len(refused) >= count and outbox.waiting() == 0

            await until(everything_is_refused)
        assert wire.connections > 3, "it did break"
        assert refused == [f"c{number}" for number in range(count)]
        said = await rows(app.state.parts.database, RobotMessage)
        assert [(row.seq, row.body["claim_id"]) for row in said] == [(n + 1, f"c{n}") for n in range(count)]
        assert len(await rows(app.state.parts.database, ClaimRow)) == count
        assert memory.received() == Received(
            journal=(await rows(app.state.parts.database, RobotRow))[0].server_journal, seq=count
        )


async def test_a_service_that_is_stopped_and_started_again_goes_on_where_it_was(
    settings: Settings, store: Store
) -> None:
    outbox, memory = Outbox(store), Memory(store)
    async with serving(settings) as (app, port):
        token = await enrolled(app)
        async with linked(store, outbox, memory, port, token) as link:
            outbox.put(Clear(leg=LEGS[0]))
            link.wake()

            async def is_acknowledged() -> bool:
                return outbox.waiting() == 0

            await until(is_acknowledged)
            wire_port = port
    async with linked(store, outbox, memory, wire_port, token) as link:
        outbox.put(Clear(leg=LEGS[1]))
        link.wake()
        await asyncio.sleep(0.3)
        assert (link.state, outbox.waiting()) == (LinkState.OFFLINE, 1)
        async with serving(settings, wire_port) as (app, _):
            await until(is_acknowledged)
            assert [row.seq for row in await rows(app.state.parts.database, RobotMessage)] == [1, 2]


async def test_two_machines_with_one_token_do_not_fight_for_ever(settings: Settings, tmp_path: Path) -> None:
    async with serving(settings) as (app, port):
        token = await enrolled(app)
        with Store(tmp_path / "a.db") as a, Store(tmp_path / "b.db") as b:
            async with linked(a, Outbox(a), Memory(a), port, token) as first:
                await until(lambda: is_in(first, LinkState.ONLINE))
                async with linked(b, Outbox(b), Memory(b), port, token) as second:
                    await until(lambda: is_in(first, LinkState.REPLACED))
                    await until(lambda: is_in(second, LinkState.ONLINE))
                    assert "is its token in use on a second machine?" in (first.problem or "")
                    await asyncio.sleep(0.5)
                    assert second.state is LinkState.ONLINE
        assert await rows(app.state.parts.database, MessageToRobot) == []


async def is_in(link: Link, state: LinkState) -> bool:
    return link.state is state


async def test_a_token_that_the_service_does_not_know_ends_the_link_with_a_reason(
    settings: Settings, store: Store
) -> None:
    nobodys = "cmr_00000000_" + "x" * 43
    async with serving(settings) as (_, port), linked(store, Outbox(store), Memory(store), port, nobodys) as link:
        await until(lambda: is_in(link, LinkState.REFUSED))
        assert "enrol" in (link.problem or "")
