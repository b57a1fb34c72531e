"""Answers that have not changed are not sent again: an ETag for whatever JSON is read, 304 for who has it already."""

from hashlib import sha256
from typing import Final

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

HASH_CHARACTERS: Final = 16
OF_THE_BODY: Final = frozenset({"content-length", "content-type"})


class ETags:
    """For GET of what is JSON, sent in one piece, and not secret (`no-store`).

    The ETag of an order begins with its version (`"7-…"`), which is all that If-Match looks at: where its robot was
    last seen is part of the answer but no reason to refuse a change.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http" or scope["method"] != "GET" or not scope["path"].startswith("/api/"):
            await self._app(scope, receive, send)
        else:
            await self._app(scope, receive, _Tagged(send, Headers(scope=scope).get("if-none-match", "")).send)


class _Tagged:
    """Holds back the head of an answer until its body is there."""

    def __init__(self, send: Send, if_none_match: str) -> None:
        self._send, self._if_none_match = send, if_none_match
        self._head: Message | None = None

    async def send(self, message: Message) -> None:
        if message["type"] == "http.response.start" and _is_taggable(message):
            self._head = message
            return
        if self._head is not None:
            head, self._head = self._head, None
            message = self._tag(head, message)
            await self._send(head)
        await self._send(message)

    def _tag(self, head: Message, body: Message) -> Message:
        """Complete `head`; the body that goes with it."""
        if body.get("more_body"):
            return body
        headers = MutableHeaders(scope=head)
        tag = _tag_of(body.get("body", b""), headers.get("etag", ""))
        headers["ETag"] = tag
        if not _names(self._if_none_match, tag):
            return body
        head["status"] = 304
        head["headers"] = [(name, value) for name, value in head["headers"] if name.decode() not in OF_THE_BODY]
        return {**body, "body": b""}


def _is_taggable(head: Message) -> bool:
    headers = Headers(raw=head["headers"])
    is_json = headers.get("content-type", "").startswith("application/json")
    return head["status"] == 200 and is_json and "no-store" not in headers.get("cache-control", "")


def _tag_of(body: bytes, version: str) -> str:
    digest = sha256(body).hexdigest()[:HASH_CHARACTERS]
    return f'"{version.strip(chr(34))}-{digest}"' if version else f'"{digest}"'


def _names(if_none_match: str, tag: str) -> bool:
    return any(one.strip().removeprefix("W/") in {"*", tag} for one in if_none_match.split(","))
