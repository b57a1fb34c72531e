"""As little HTTP as a load generator needs, so that what is measured is the server and not its client."""

import asyncio
import json
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Answer:
    """One answer of the server."""

    status: int
    body: bytes

    def json(self) -> Any:
        return json.loads(self.body)


class Visitor:
    """A person's browser: one connection that is kept open, one request at a time."""

    def __init__(self, port: int, cookie: str | None = None) -> None:
        self._port = port
        self._cookie = f"Cookie: session={cookie}\r\n" if cookie else ""
        self._reader: asyncio.StreamReader | None = None
        self._writer: asyncio.StreamWriter | None = None

    async def get(self, path: str) -> Answer:
        return await self._ask(f"GET {path}", b"", "")

    async def post(self, path: str, body: Any, headers: str = "") -> Answer:
        return await self._ask(f"POST {path}", json.dumps(body).encode(), headers)

    async def _ask(self, what: str, body: bytes, headers: str) -> Answer:
        if self._writer is None:
            self._reader, self._writer = await asyncio.open_connection("127.0.0.1", self._port, limit=2**20)
        assert self._reader is not None
        head = (
            f"{what} HTTP/1.1\r\nHost: 127.0.0.1:{self._port}\r\n{self._cookie}{headers}"
            f"Sec-Fetch-Site: same-origin\r\nContent-Type: application/json\r\nContent-Length: {len(body)}\r\n\r\n"
        )
        self._writer.write(head.encode() + body)
        answered = await self._reader.readuntil(b"\r\n\r\n")
        length_bytes = int(answered.lower().partition(b"content-length:")[2].partition(b"\r\n")[0] or 0)
        return Answer(int(answered[9:12]), await self._reader.readexactly(length_bytes))

    def close(self) -> None:
        if self._writer is not None:
            self._writer.close()
        self._reader = self._writer = None


class Follower(asyncio.Protocol):
    """An open page: hands every piece of its event stream on, with the moment at which it came."""

    def __init__(self, port: int, cookie: str, heard: Callable[[float, bytes], None]) -> None:
        self._request = f"GET /api/v1/live HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: session={cookie}\r\n\r\n"
        self._heard = heard
        self._transport: asyncio.BaseTransport | None = None
        self.following = asyncio.Event()
        self.ended = False

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self._transport = transport
        transport.write(self._request.encode())  # type: ignore[attr-defined]

    def data_received(self, data: bytes) -> None:
        if not self.following.is_set() and b"following" in data:
            self.following.set()
        self._heard(time.perf_counter(), data)

    def connection_lost(self, exc: Exception | None) -> None:
        self.ended = True

    def close(self) -> None:
        if self._transport is not None:
            self._transport.close()


async def follow(port: int, cookie: str, heard: Callable[[float, bytes], None]) -> Follower:
    """Open a page and wait until it follows."""
    loop = asyncio.get_running_loop()
    _, follower = await loop.create_connection(lambda: Follower(port, cookie, heard), "127.0.0.1", port)
    async with asyncio.timeout(30):
        await follower.following.wait()
    return follower
