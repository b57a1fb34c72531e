"""Files of the pages as they go over the wire: compressed once, and kept while they are the same."""

import asyncio
import gzip
import posixpath
from collections.abc import Callable
from functools import partial
from typing import Final

import brotli
from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

SMALLEST: Final = 500
COMPRESSIBLE: Final = ("text/", "application/json", "application/manifest+json", "image/svg+xml")
BEST: Final[dict[str, Callable[[bytes], bytes]]] = {"br": brotli.compress, "gzip": gzip.compress}
"""For what is kept: a tenth of a second once. Browsers take `br` by https, and from their own machine."""
FAST: Final[dict[str, Callable[[bytes], bytes]]] = {
    "br": partial(brotli.compress, quality=4),
    "gzip": partial(gzip.compress, compresslevel=5),
}
NEEDLESS: Final = ("Last-Modified", "Accept-Ranges")
"""The ETag says when to ask again, and ranges are of the file as it lies on the disk. A page has dozens of files."""
Kept = dict[tuple[str, str], tuple[str, bytes]]


def encoding_for(accepted: str) -> str | None:
    """The best that a browser takes; one with a weight of nothing it does not take."""
    names = {one.partition(";")[0].strip() for one in accepted.split(",") if not one.replace(" ", "").endswith(";q=0")}
    return next((name for name in BEST if name in names), None)


class Compressed:
    """Compresses what its application answers. What has an ETag is kept: one body for each path and encoding.

    A file answers to endless spellings of its path, and is kept under one.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app
        self.kept = Kept()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        encoding = encoding_for(Headers(scope=scope).get("accept-encoding", "")) if scope["method"] == "GET" else None
        path = posixpath.normpath(scope["path"]).strip("/")
        await self._app(scope, receive, _Answer(send, path, encoding, self.kept).send)


class _Answer:
    """Holds back what can be compressed until all of it is there."""

    def __init__(self, send: Send, path: str, encoding: str | None, kept: Kept) -> None:
        self._send, self._path, self._encoding, self._kept = send, path, encoding, kept
        self._head: Message | None = None
        self._parts: list[bytes] = []

    async def send(self, message: Message) -> None:
        if message["type"] == "http.response.start" and _is_compressible(message):
            MutableHeaders(scope=message).add_vary_header("Accept-Encoding")
            self._head = message if self._encoding else None
        if self._head is None:
            await self._send(message)
        elif message["type"] == "http.response.body":
            self._parts.append(message.get("body", b""))
            if not message.get("more_body"):
                await self._finish(self._head, b"".join(self._parts))

    async def _finish(self, head: Message, body: bytes) -> None:
        if self._encoding and len(body) >= SMALLEST:
            headers = MutableHeaders(scope=head)
            body = await self._compressed(self._encoding, headers.get("etag", ""), body)
            headers["Content-Encoding"], headers["Content-Length"] = self._encoding, str(len(body))
            for name in NEEDLESS:
                del headers[name]
        await self._send(head)
        await self._send({"type": "http.response.body", "body": body})

    async def _compressed(self, encoding: str, tag: str, body: bytes) -> bytes:
        known, compressed = self._kept.get((self._path, encoding), ("", b""))
        if tag and known == tag:
            return compressed
        compressed = await asyncio.to_thread((BEST if tag else FAST)[encoding], body)
        if tag:
            self._kept[self._path, encoding] = tag, compressed
        return compressed


def _is_compressible(head: Message) -> bool:
    headers = Headers(raw=head["headers"])
    is_whole = head["status"] == 200 and "content-encoding" not in headers
    return is_whole and headers.get("content-type", "").startswith(COMPRESSIBLE)
