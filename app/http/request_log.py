"""Each request has an id: in every line of the log that comes of it, and in a header of the answer."""

import re
import secrets
import time
from typing import Final

import structlog
from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

HEADER: Final = "X-Request-ID"
USABLE: Final = re.compile(r"[A-Za-z0-9_-]{8,64}")
"""What a proxy may have given; anything else could forge lines of the log."""
ORDER: Final = re.compile(r"/api/v1/orders/([0-9a-f]{16})(?:/|$)")

log = structlog.get_logger(__name__)


class RequestLog:
    """Outermost, so that whatever goes wrong within is logged with the id."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        given = Headers(scope=scope).get(HEADER, "")
        request_id = given if USABLE.fullmatch(given) else secrets.token_hex(8)
        begun_s = time.perf_counter()

        async def send_with_id(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message)[HEADER] = request_id
                _note(scope, message["status"], time.perf_counter() - begun_s)
            await send(message)

        with structlog.contextvars.bound_contextvars(request=request_id, **_order_in(scope["path"])):
            await self._app(scope, receive, send_with_id)


def _order_in(path: str) -> dict[str, str]:
    found = ORDER.match(path)
    return {"order": found[1]} if found else {}


def _note(scope: Scope, status: int, took_s: float) -> None:
    """Paths hold ids but no secrets; queries are left out."""
    level = "warning" if status >= 500 else "debug" if scope["method"] in ("GET", "HEAD") else "info"
    getattr(log, level)(
        "answered", method=scope["method"], path=scope["path"], status=status, ms=round(took_s * 1e3, 1)
    )
