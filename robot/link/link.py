"""The robot's link to its server: always trying, in a thread of its own, and never in anybody's way.

The daemon puts durable messages into the outbox and says `wake()`; it hands over snapshots and reasons, of which only
the newest counts; it asks for `incoming()` messages when it likes. A tunnel without network is expected: the link comes
back by itself. Two things end it for good, and `problem` says which: the token was refused, or another connection of
the same robot took its place (a copied token looks like this).

LinkError
├── InsecureServer   plain ws:// to another machine
├── TokenRefused     the server does not know this robot's token
└── LinkReplaced     a newer connection of the same robot took this one's place
"""

import asyncio
import math
import random
import threading
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import suppress
from enum import StrEnum
from ipaddress import ip_address
from typing import Final
from urllib.parse import urlsplit

import structlog
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed, InvalidStatus, WebSocketException

from protocol.clock import Clock
from protocol.diagnostics import Diagnostics
from protocol.envelope import MAX_MESSAGE_BYTES
from protocol.errors import ProtocolError
from protocol.to_robot import EmergencyStop, Revoke, Watch
from protocol.to_server import Hello, Snapshot, Why
from robot.core.errors import RobotError
from robot.link.connection import Connection, Ends, LinkBroken, Newest, Rhythm
from robot.mission.memory import Incoming, Memory
from robot.mission.outbox import Outbox
from robot.mission.store import StoreError

MAX_INCOMING: Final = 200
"""Messages that the daemon has not taken; beyond this the link stops reading until it does."""

log = structlog.get_logger("robot.link.link")


class LinkError(RobotError):
    """The link ended, or cannot begin."""


class InsecureServer(LinkError):
    """Unencrypted to another machine: the token and everybody's mail could be read on the way."""


class TokenRefused(LinkError):
    """The server does not know this token: enrol the robot again and give it the new one."""


class LinkReplaced(LinkError):
    """Another connection of this robot took this one's place; coming back would only throw that one out."""


class LinkState(StrEnum):
    """The state of the link, in one word."""

    STOPPED = "stopped"
    OFFLINE = "offline"
    ONLINE = "online"
    REFUSED = "refused"
    REPLACED = "replaced"


_REFUSED: Final = "the server refused this robot's token: enrol it again (python -m app robots enrol NAME)"
_REPLACED: Final = "another connection signed in as this robot: is its token in use on a second machine?"
_STATE_AFTER: Final = {TokenRefused: LinkState.REFUSED, LinkReplaced: LinkState.REPLACED}


class Link:
    """The thread-safe surface. `hello_source` is called in the link's thread at every connection."""

    def __init__(
        self,
        *,
        url: str,
        token: str,
        robot: str,
        clock: Clock,
        outbox: Outbox,
        memory: Memory,
        hello_source: Callable[[], Hello],
        rhythm: Rhythm | None = None,
        stop_at_once: Callable[[], None] = lambda: None,
    ) -> None:
        """`stop_at_once` is called in the link's thread when an emergency stop or a `revoke` comes: it waits for no
        reasoning.

        Raises InsecureServer. Whatever was received before a restart and not handled is `incoming` again.
        """
        check_secure(url)
        self._url, self._token, self._clock = url, token, clock
        self._rhythm = rhythm or Rhythm()
        self._stop_at_once = stop_at_once
        self._newest = Newest()
        self._incoming: deque[Incoming] = deque(memory.unhandled())
        self.on_watch: Callable[[Watch], None] = lambda _: None
        """Called in the link's thread when a person at the service watches."""
        self._ends = Ends(
            *(robot, clock, outbox, memory, hello_source, self._newest, self._deliver, self._rhythm),
            watched=self._watched,
        )
        self._state = LinkState.STOPPED
        self._problem: str | None = None
        self._loop: asyncio.AbstractEventLoop | None = None
        self._thread = threading.Thread(target=self._run_thread, name="link", daemon=True)
        self._wake = asyncio.Event()
        self._room = asyncio.Event()
        self._ready = threading.Event()

    @property
    def state(self) -> LinkState:
        """Online means: the server has answered our hello on the connection that is open now."""
        return self._state

    @property
    def online(self) -> bool:
        return self._state is LinkState.ONLINE

    @property
    def problem(self) -> str | None:
        """Why the link is not online, in words; None while it is."""
        return self._problem

    def start(self) -> None:
        """Begin to connect; returns at once."""
        self._state = LinkState.OFFLINE
        self._thread.start()
        self._ready.wait()

    def stop(self, limit_s: float = 5.0) -> None:
        """Close the connection and end the thread. What waits in the outbox goes with the next start."""
        if self._thread.is_alive():
            self._in_thread(self._main.cancel)
            self._thread.join(limit_s)

    def wake(self) -> None:
        """Something new is in the outbox."""
        self._in_thread(self._wake.set)

    def snapshot(self, snapshot: Snapshot) -> None:
        """The state now. At most one a second is sent, always the newest; none is queued."""
        if self._newest.take(snapshot):
            self.wake()

    def say(self, why: Why) -> None:
        """The robot's activity and what it waits for; sent when it changes and after every reconnect."""
        if self._newest.take(why):
            self.wake()

    def has_room_for_diagnostics(self) -> bool:
        """Return whether the server is there and has been sent the one before."""
        return self.online and self._newest.diagnostics is None

    def tell_diagnostics(self, diagnostics: Callable[[], Diagnostics]) -> None:
        """Sent after everything else, and lost with the connection; `diagnostics` is called in the link's thread."""
        self._newest.diagnostics = diagnostics
        self.wake()

    def incoming(self) -> list[Incoming]:
        """Return what came since the last call, each message once per start. Say `memory.handled(it)` when it is done
        with."""
        taken = [self._incoming.popleft() for _ in range(len(self._incoming))]
        if taken:
            self._in_thread(self._room.set)
        return taken

    # In the link's own thread from here on.

    def _in_thread(self, call: Callable[[], object]) -> None:
        if self._loop is not None:
            with suppress(RuntimeError):  # the loop has just been closed: no connection is left to tell
                self._loop.call_soon_threadsafe(call)

    def _deliver(self, incoming: Incoming) -> None:
        if isinstance(incoming.message, EmergencyStop | Revoke):
            self._stop_at_once()
        self._incoming.append(incoming)
        if len(self._incoming) >= MAX_INCOMING:
            self._room.clear()

    def _watched(self, watch: Watch) -> None:
        self.on_watch(watch)

    def _run_thread(self) -> None:
        asyncio.run(self._run())

    async def _run(self) -> None:
        self._loop = asyncio.get_running_loop()
        main = asyncio.current_task()
        assert main is not None  # noqa: S101  # asyncio.run made it
        self._main = main
        self._room.set()
        self._ready.set()
        try:
            await self._keep_connected()
        except asyncio.CancelledError:
            self._state = LinkState.STOPPED

    async def _keep_connected(self) -> None:
        delays_s = retry_delays_s(self._rhythm)
        loop = asyncio.get_running_loop()
        while True:
            self._online_since_s = math.inf
            try:
                await self._connect_once()
            except LinkError as end:
                self._state, self._problem = _STATE_AFTER[type(end)], str(end)
                log.error("link_ended", reason=str(end))
                return
            except (OSError, WebSocketException, ProtocolError, LinkBroken, StoreError) as error:
                self._problem = str(error) or type(error).__name__
            except Exception as error:
                # A mistake in here must not silence the robot: it is told, and the link tries again.
                log.exception("link_failed")
                self._problem = repr(error)
            if loop.time() - self._online_since_s > self._rhythm.settled_after_s:
                delays_s = retry_delays_s(self._rhythm)
            self._state = LinkState.OFFLINE
            log.info("link_lost", reason=self._problem)
            await asyncio.sleep(max(self._rhythm.retry_floor_s, self._clock.real_s(next(delays_s))))

    async def _connect_once(self) -> None:
        try:
            async with self._socket() as socket:
                connection = Connection(socket, self._ends, self._wake, self._room)
                await connection.greet()
                self._state, self._problem = LinkState.ONLINE, None
                self._online_since_s = asyncio.get_running_loop().time()
                log.info("link_online", server=self._url)
                await connection.run()
        except ConnectionClosed as closed:
            raise _named(closed.rcvd.code if closed.rcvd else None) or closed from None
        except InvalidStatus as refused:
            raise TokenRefused(_REFUSED) if refused.response.status_code in {401, 403} else refused from None

    def _socket(self) -> connect:
        return connect(
            self._url,
            additional_headers={"Authorization": f"Bearer {self._token}"},
            compression=None,
            proxy=None,
            open_timeout=self._rhythm.greeting_limit_s,
            ping_interval=self._rhythm.ping_every_s,
            ping_timeout=self._rhythm.ping_limit_s,
            close_timeout=1.0,
            max_size=MAX_MESSAGE_BYTES,
        )


def _named(close_code: int | None) -> LinkError | None:
    match close_code:
        case 4401:
            return TokenRefused(_REFUSED)
        case 4409:
            return LinkReplaced(_REPLACED)
    return None


def retry_delays_s(rhythm: Rhythm) -> Iterator[float]:
    """Quick at first, then ever slower up to a limit; half of each by chance, so that a fleet does not come at once."""
    delay_s = rhythm.retry_first_s
    while True:
        yield delay_s * random.uniform(0.5, 1.0)
        delay_s = min(rhythm.retry_longest_s, 2 * delay_s)


def check_secure(url: str) -> None:
    """wss anywhere, ws to this machine only. Raises InsecureServer."""
    parts = urlsplit(url)
    if parts.scheme == "wss" or (parts.scheme == "ws" and _is_loopback(parts.hostname or "")):
        return
    raise InsecureServer(f"{url}: use wss://; plain ws:// is for a server on this machine only")


def _is_loopback(host: str) -> bool:
    try:
        return host == "localhost" or ip_address(host).is_loopback
    except ValueError:
        return False
