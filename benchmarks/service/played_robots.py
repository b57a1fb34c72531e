"""Robots as the service sees them: a signed-in socket that greets, acknowledges, and says what it is told to say."""

import asyncio
import json
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from datetime import UTC, datetime
from random import Random
from typing import Any, Final

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

from benchmarks.body.report import say
from benchmarks.service.filling import KnownRobot
from benchmarks.service.samples import until
from benchmarks.service.servers import Server
from maps import CampusMap
from protocol.both_ways import Ack
from protocol.envelope import DURABLE, YOUNGER, Envelope, type_of
from protocol.parts import Battery, Part, Position
from protocol.to_server import Hello, Occupancy

AT_ONCE: Final = 20
"""So many connect at the same time: a whole fleet that comes back would not come in one moment either."""

KNOWN_WITHIN_S: Final = 300.0
IDLE_SHARE: Final = 0.15
ANSWERS_WITHIN_S: Final = 0.1
IDLE_FOR_S: Final = 3
"""A service that uses no more of its core for so long, and answers meanwhile, has planned for every robot."""

Heard = Callable[["PlayedRobot", float, dict[str, Any]], None]


class PlayedRobot:
    """One robot. `heard` is called with every message from the service, and the moment at which it came. `home`: the
    bay with a dock in which it stands; without one it is a robot of before there were bays."""

    def __init__(
        self, known: KnownRobot, post: str, map_version: str, heard: Heard | None = None, home: str | None = None
    ) -> None:
        self.known, self.post, self.home, self._map_version = known, post, home, map_version
        self._heard = heard
        self._socket: ClientConnection | None = None
        self._listening: asyncio.Task[None] | None = None
        self.seq = 0
        self.acknowledged = 0
        self._received = 0
        self.sent_at_s: dict[int, float] = {}
        self.acknowledged_after_s: list[float] = []
        self.errors: list[dict[str, Any]] = []

    async def connect(self, url: str) -> None:
        headers = {"Authorization": f"Bearer {self.known.token}"}
        self._socket = await connect(
            url, additional_headers=headers, compression=None, proxy=None, ping_interval=None, open_timeout=30
        )
        hello = Hello(
            position=Position(post=self.home or self.post),
            battery=self.battery,
            software="benchmark",
            map_version=self._map_version,
            understands=YOUNGER if self.home else (),
            home=self.home,
        )
        await self._socket.send(self.text(hello))
        welcome = json.loads(await self._socket.recv())
        assert welcome["type"] == "welcome", welcome
        self._listening = asyncio.create_task(self._listen())

    @property
    def battery(self) -> Battery:
        return Battery(ratio=0.9, docked=True if self.home else None)

    def in_its_bay(self) -> Occupancy:
        """Return what a robot says that stands at home."""
        assert self.home is not None
        return Occupancy(where="bay", post=self.home, evidence="dock", happened_at=datetime.now(UTC))

    def text(self, message: Part) -> str:
        """A durable message gets the next number."""
        name = type_of(message)
        if name in DURABLE:
            self.seq += 1
        envelope = Envelope(
            type=name,
            robot=self.known.name,
            journal=f"journal-{self.known.name}",
            seq=self.seq if name in DURABLE else None,
            ack=self._received,
            at=datetime.now(UTC),
            body=message,
        )
        return envelope.to_text()

    async def say(self, message: Part) -> None:
        assert self._socket is not None
        text = self.text(message)
        if type_of(message) in DURABLE:
            self.sent_at_s[self.seq] = time.perf_counter()
        await self._socket.send(text)

    async def _listen(self) -> None:
        assert self._socket is not None
        with suppress(ConnectionClosed):
            async for text in self._socket:
                await self._hear(time.perf_counter(), json.loads(text))

    async def _hear(self, at_s: float, envelope: dict[str, Any]) -> None:
        for seq in range(self.acknowledged + 1, envelope["ack"] + 1):
            self.acknowledged_after_s.append(at_s - self.sent_at_s.pop(seq))
        self.acknowledged = max(self.acknowledged, envelope["ack"])
        if envelope["type"] == "error":
            self.errors.append(envelope["body"])
        if envelope["seq"] is not None:
            self._received = max(self._received, envelope["seq"])
            await self._acknowledge()
        if self._heard is not None:
            self._heard(self, at_s, envelope)

    async def _acknowledge(self) -> None:
        assert self._socket is not None
        await self._socket.send(self.text(Ack()))

    @property
    def is_connected(self) -> bool:
        return self._listening is not None and not self._listening.done()

    async def close(self) -> None:
        if self._socket is not None:
            self._socket.transport.abort()
        if self._listening is not None:
            await asyncio.wait([self._listening])


def at_home(
    known: Sequence[KnownRobot], campus: CampusMap, random: Random, heard: Heard | None = None
) -> list[PlayedRobot]:
    """Return these robots, each in a home of its own, which lie anywhere on the campus."""
    homes = random.sample([bay.name for bay in campus.track.home_bays], len(known))
    return [
        PlayedRobot(one, campus.address_of(home), campus.version, heard, home)
        for one, home in zip(known, homes, strict=True)
    ]


async def come_home(robots: Sequence[PlayedRobot], server: Server) -> float:
    """Bring a fleet online, each robot in its home, and wait until the service has nothing more to do for it; return
    how many seconds that took after the last connection."""
    connected_s = await connect_all(list(robots), server.link_url)
    say(f"  {len(robots)} robots connected in {connected_s:.1f} s")
    begun_s = time.perf_counter()
    await asyncio.gather(*(robot.say(robot.in_its_bay()) for robot in robots))
    await until(lambda: all(robot.acknowledged >= robot.seq for robot in robots), KNOWN_WITHIN_S)
    idle_s = 0
    while idle_s < IDLE_FOR_S and time.perf_counter() < begun_s + KNOWN_WITHIN_S:
        before_s, asked_s = server.processor_s(), time.perf_counter()
        await asyncio.to_thread(server.health)
        answered_s = time.perf_counter() - asked_s
        await asyncio.sleep(max(0.0, 1.0 - answered_s))
        is_idle = answered_s < ANSWERS_WITHIN_S and server.processor_s() - before_s < IDLE_SHARE
        idle_s = idle_s + 1 if is_idle else 0
    for robot in robots:
        robot.acknowledged_after_s.clear()
    return time.perf_counter() - begun_s


async def connect_all(robots: list[PlayedRobot], url: str) -> float:
    """Bring a fleet online; how long that took."""
    begun_s = time.perf_counter()
    room = asyncio.Semaphore(AT_ONCE)

    async def one(robot: PlayedRobot) -> None:
        async with room:
            await robot.connect(url)

    async with asyncio.TaskGroup() as group:
        for robot in robots:
            group.create_task(one(robot))
    return time.perf_counter() - begun_s
