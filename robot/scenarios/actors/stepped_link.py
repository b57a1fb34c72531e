"""`robot.link.link.Link` in stepped time: the daemon's own connection over a wire in memory, on the world's clock.

Nothing of the connection is imitated: greeting, envelopes, numbers, acknowledgements and replay are `connection.py`'s.
Where there is no network nothing moves on the wire; after so long both ends take it for dead, and what was on it is
lost, as with a real socket.
"""

import asyncio
import selectors
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from typing import Final, Protocol

from protocol.clock import Clock
from protocol.errors import ProtocolError
from protocol.to_server import Hello, Snapshot, Why
from robot.link.connection import Connection, Ends, LinkBroken, Newest, Rhythm
from robot.link.link import LinkState
from robot.mission.memory import Incoming, Memory
from robot.mission.outbox import Outbox

DEAD_AFTER_S: Final = 8.0
"""A dead network is noticed by pings after so long at most (`connection.Rhythm`)."""
RETRY_S: Final = 2.0
TURNS: Final = 8
"""Turns of the event loop in a tick: from a message that came in to the answer that goes out takes three."""


class Far(Protocol):
    """The server's end: what arrived, answered."""

    def opened(self, robot: str, send: Callable[[str], None]) -> None: ...

    def hear(self, robot: str, text: str) -> None: ...

    def closed(self, robot: str) -> None: ...


class Wire:
    """A socket as `Connection` needs it. `carry` moves what was sent, both ways."""

    def __init__(self) -> None:
        self.up: deque[str] = deque()
        self.down: deque[str] = deque()
        self._arrived: asyncio.Queue[str | None] = asyncio.Queue()
        self._broken = False

    async def send(self, message: str, /) -> None:
        if self._broken:
            raise LinkBroken("no network")
        self.up.append(message)

    async def recv(self) -> str | bytes:
        text = None if self._broken else await self._arrived.get()
        if text is None:
            raise LinkBroken("no network")
        return text

    async def close(self, code: int = 1000, reason: str = "") -> None:
        self.cut()

    def arrive(self) -> None:
        while self.down:
            self._arrived.put_nowait(self.down.popleft())

    def cut(self) -> None:
        """Waiting callers are notified that nothing comes any more."""
        self._broken = True
        self._arrived.put_nowait(None)


class SteppedLoop(asyncio.SelectorEventLoop):
    """Time is the world's; a turn never waits."""

    def __init__(self, now: Callable[[], float]) -> None:
        super().__init__(selectors.SelectSelector())
        self._world_now = now

    def time(self) -> float:
        return self._world_now()

    def turn(self) -> None:
        for _ in range(TURNS):
            self.call_soon(self.stop)
            self.run_forever()


class SteppedLink:
    """See `robot.link.link.Link`; `tick` instead of a thread. `network`: whether there is any where the robot is
    now."""

    def __init__(
        self,
        *,
        robot: str,
        clock: Clock,
        outbox: Outbox,
        memory: Memory,
        hello_source: Callable[[], Hello],
        far: Far,
        network: Callable[[], bool],
    ) -> None:
        self._robot, self._clock, self._far, self._network = robot, clock, far, network
        self._newest = Newest()
        self._incoming: deque[Incoming] = deque(memory.unhandled())
        self._loop = SteppedLoop(clock.now)
        self._wake, self._room = asyncio.Event(), asyncio.Event()
        self._room.set()
        self._ends = Ends(robot, clock, outbox, memory, hello_source, self._newest, self._incoming.append, Rhythm())
        self._wire: Wire | None = None
        self._talk: asyncio.Task[None] | None = None
        self._carried_s = self._retry_s = clock.now()
        self.state = LinkState.OFFLINE
        self.problem: str | None = None

    @property
    def online(self) -> bool:
        return self.state is LinkState.ONLINE

    def start(self) -> None:
        """There is no thread to start."""

    def wake(self) -> None:
        self._wake.set()

    def snapshot(self, snapshot: Snapshot) -> None:
        if self._newest.take(snapshot):
            self.wake()

    def say(self, why: Why) -> None:
        if self._newest.take(why):
            self.wake()

    def incoming(self) -> list[Incoming]:
        taken = list(self._incoming)
        self._incoming.clear()
        return taken

    def tick(self, now: float) -> None:
        """Let messages pass, as far as there is network."""
        if self._network():
            if self._wire is None and now >= self._retry_s:
                self._connect()
            if self._wire is not None:
                self._carry(self._wire, now)
        elif self._wire is not None and now - self._carried_s > DEAD_AFTER_S:
            self._hang_up("no network here")
        self._loop.turn()
        self._look_after(now)

    def _connect(self) -> None:
        self._wire = wire = Wire()
        self._carried_s = self._clock.now()
        self._far.opened(self._robot, wire.down.append)
        self._talk = self._loop.create_task(self._run(Connection(wire, self._ends, self._wake, self._room)))

    async def _run(self, connection: Connection) -> None:
        await connection.greet()
        self.state, self.problem = LinkState.ONLINE, None
        await connection.run()

    def _carry(self, wire: Wire, now: float) -> None:
        self._carried_s = now
        while wire.up:
            self._far.hear(self._robot, wire.up.popleft())
        wire.arrive()

    def _hang_up(self, problem: str) -> None:
        if self._wire is not None:
            self._wire.cut()
            self._wire = None
            self._far.closed(self._robot)
        self.state, self.problem = LinkState.OFFLINE, problem

    def _look_after(self, now: float) -> None:
        """A connection that has ended: of itself, or because there is no network any more."""
        if self._talk is None or not self._talk.done():
            return
        task, self._talk = self._talk, None
        problem = "closed"
        try:
            task.result()
        except (LinkBroken, ProtocolError, TimeoutError) as error:
            problem = str(error)
        self._hang_up(problem)
        self._retry_s = now + RETRY_S

    def stop(self) -> None:
        if self._loop.is_closed():
            return
        self._hang_up("stopped")
        if self._talk is not None:
            self._talk.cancel()
            with suppress(asyncio.CancelledError, LinkBroken):
                self._loop.run_until_complete(self._talk)
        self._loop.close()
        self.state = LinkState.STOPPED
