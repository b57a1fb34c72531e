"""The network between robots and service: lines that carry text in order, late, cut for a while, or broken.

A line is what a TCP connection is to its ends: nothing overtakes, and nothing is lost but with the line itself. Who is
cut off notices after some seconds, as pings do (`robot/link/connection.py`, `app/robots/link/keepalive.py`).
"""

import asyncio
from collections.abc import Awaitable, Callable, MutableMapping
from dataclasses import dataclass, field
from random import Random
from typing import Any, Final

from starlette.websockets import WebSocket

ROBOT_NOTICES_S: Final = 8.0
SERVICE_NOTICES_S: Final = 11.0
LATENCY_S: Final = (0.02, 0.3)
APART_S: Final = 1e-6
ASGI: Final = {"type": "websocket", "path": "/api/v1/robots/link", "scheme": "ws", "query_string": b""}

Serve = Callable[[WebSocket], Awaitable[None]]
"""What the service does with a new connection, until its end."""
Message = MutableMapping[str, Any]


class LineClosed(ConnectionError):
    """The other end has closed, or the line is broken. `code`: of the WebSocket, if it was closed."""

    def __init__(self, code: int | None = None) -> None:
        super().__init__(f"the line is closed ({code})")
        self.code = code


class Line:
    """One connection. The robot's end is a socket as `robot.link.connection` wants it."""

    def __init__(self, rng: Random) -> None:
        self._loop, self._rng = asyncio.get_running_loop(), rng
        self._to_robot: asyncio.Queue[str | LineClosed] = asyncio.Queue()
        self._to_service: asyncio.Queue[Message] = asyncio.Queue()
        self._to_service.put_nowait({"type": "websocket.connect"})
        self._due_s = {id(self._to_robot): 0.0, id(self._to_service): 0.0}
        self._held: list[tuple[asyncio.Queue[Any], Any]] = []
        self.is_cut = self.is_broken = False

    # The robot's end.

    async def send(self, message: str, /) -> None:
        if self.is_broken:
            raise LineClosed
        self._post(self._to_service, {"type": "websocket.receive", "text": message})

    async def recv(self) -> str:
        message = await self._to_robot.get()
        if isinstance(message, LineClosed):
            raise message
        return message

    async def close(self, code: int = 1000, reason: str = "") -> None:
        self._post(self._to_service, {"type": "websocket.disconnect", "code": code})

    # The service's end, as ASGI has it.

    async def asgi_receive(self) -> Message:
        return await self._to_service.get()

    async def asgi_send(self, message: Message) -> None:
        if message["type"] == "websocket.send":
            self._post(self._to_robot, message["text"])
        elif message["type"] == "websocket.close":
            self._post(self._to_robot, LineClosed(message.get("code", 1000)))

    # What becomes of it.

    def _post(self, queue: "asyncio.Queue[Any]", item: Any) -> None:
        # One after the other: the loop calls in any order what is due in the same moment.
        due_s = max(self._due_s[id(queue)] + APART_S, self._loop.time() + self._rng.uniform(*LATENCY_S))
        self._due_s[id(queue)] = due_s
        self._loop.call_at(due_s, self._arrives, queue, item)

    def _arrives(self, queue: "asyncio.Queue[Any]", item: Any) -> None:
        if self.is_broken:
            return
        if self.is_cut:
            self._held.append((queue, item))
        else:
            queue.put_nowait(item)

    def cut(self) -> None:
        """Nothing comes through until `heal`."""
        self.is_cut = True

    def heal(self) -> None:
        self.is_cut = False
        held, self._held = self._held, []
        for queue, item in held:
            self._arrives(queue, item)

    def break_off(self, robot_after_s: float = 0.0, service_after_s: float = 0.0) -> None:
        """What is on its way is lost; the ends notice so much later."""
        if self.is_broken:
            return
        self.is_broken = True
        self._loop.call_later(robot_after_s, self._to_robot.put_nowait, LineClosed())
        self._loop.call_later(service_after_s, self._to_service.put_nowait, {"type": "websocket.disconnect"})


@dataclass
class Network:
    """One robot's way to the service. `failures`: what ended a conversation that should not have."""

    serve: Serve
    token: str
    rng: Random
    is_up: bool = True
    line: Line | None = None
    _tasks: set[asyncio.Task[None]] = field(default_factory=set)

    def connect(self) -> Line:
        """Raises ConnectionError while there is none."""
        if not self.is_up:
            raise ConnectionError("no network here")
        line = Line(self.rng)
        scope = {**ASGI, "client": ("127.0.0.1", 1), "server": ("127.0.0.1", 80)}
        headers = [(b"host", b"127.0.0.1"), (b"authorization", f"Bearer {self.token}".encode())]
        socket = WebSocket({**scope, "headers": headers}, line.asgi_receive, line.asgi_send)
        task = asyncio.ensure_future(self.serve(socket))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        self.line = line
        return line

    def hang_up(self) -> None:
        """The robot's computer has stopped: the operating system closes, or nothing does any more."""
        if self.line is not None:
            self.line.break_off()

    async def be_away(self, for_s: float) -> None:
        """Cut off for so long: what was said comes late, or with the next connection."""
        line, self.is_up = self.line, False
        if line is not None:
            line.cut()
        await asyncio.sleep(min(for_s, ROBOT_NOTICES_S))
        if for_s > ROBOT_NOTICES_S:
            if line is not None:
                line.break_off(service_after_s=SERVICE_NOTICES_S - ROBOT_NOTICES_S)
            await asyncio.sleep(for_s - ROBOT_NOTICES_S)
        elif line is not None:
            line.heal()
        self.is_up = True
