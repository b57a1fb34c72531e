"""A robot's link on simulated time: the product's own connection, again and again while there is a network.

`robot.link.link` has a thread for the same; all else is `robot.link.connection`.
"""

import asyncio
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from random import Random
from typing import Final

from benchmarks.fleet_simulation.network import Network
from protocol.clock import Clock
from protocol.errors import ProtocolError
from protocol.to_server import Hello, Snapshot
from robot.link.connection import Connection, Ends, LinkBroken, Newest, Rhythm
from robot.mission.memory import Incoming, Memory
from robot.mission.outbox import Outbox

RETRY_S: Final = (0.1, 15.0)
"""Ever more slowly, and half of each by chance."""


@dataclass
class RobotLink:
    """`on_news` is called for each message that has come, and when the service is there or gone."""

    robot: str
    network: Network
    clock: Clock
    outbox: Outbox
    memory: Memory
    hello: Callable[[], Hello]
    rng: Random
    on_news: Callable[[], None] = lambda: None
    online: bool = False
    connections: int = 0
    _incoming: list[Incoming] = field(default_factory=list)
    _newest: Newest = field(default_factory=Newest)
    _wake: asyncio.Event = field(default_factory=asyncio.Event)
    _room: asyncio.Event = field(default_factory=asyncio.Event)

    def __post_init__(self) -> None:
        self._incoming = list(self.memory.unhandled())
        self._room.set()

    # As duties and the mind see it.

    def incoming(self) -> Sequence[Incoming]:
        taken, self._incoming = self._incoming, []
        return taken

    def wake(self) -> None:
        self._wake.set()

    def snapshot(self, snapshot: Snapshot) -> None:
        if self._newest.take(snapshot):
            self.wake()

    # Its own.

    async def run(self) -> None:
        """Until cancelled."""
        wait_s = RETRY_S[0]
        while True:
            try:
                await self._connect_once()
                wait_s = RETRY_S[0]
            except (OSError, ProtocolError, LinkBroken, TimeoutError):
                pass
            self._is_online(False)
            await asyncio.sleep(wait_s * self.rng.uniform(0.5, 1.0))
            wait_s = min(RETRY_S[1], 2 * wait_s)

    async def _connect_once(self) -> None:
        line = self.network.connect()
        ends = Ends(
            *(self.robot, self.clock, self.outbox, self.memory, self.hello, self._newest, self._deliver, Rhythm())
        )
        connection = Connection(line, ends, self._wake, self._room)
        await connection.greet()
        self.connections += 1
        self._is_online(True)
        await connection.run()

    def _deliver(self, incoming: Incoming) -> None:
        self._incoming.append(incoming)
        self.on_news()

    def _is_online(self, online: bool) -> None:
        if online != self.online:
            self.online = online
            self.on_news()
