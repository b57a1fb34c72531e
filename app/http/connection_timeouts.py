"""Time limits of connections that send nothing, or half of something.

uvicorn waits for ever for the rest of a request, and asyncio for a minute for a TLS handshake: each such connection
costs a place among those that a process may have open. What has been said whole (a stream, a robot's socket) is not
hurried; between two requests uvicorn's own `timeout_keep_alive` counts.
"""

import asyncio
from collections.abc import Callable
from typing import Any

import uvicorn
import uvloop
from fastapi import FastAPI
from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol


class PunctualHttp(HttpToolsProtocol):
    """Closes a connection whose request's head, or then its body, is not whole in time. Dripping makes it no longer."""

    within_s: float

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._is_whole = False
        self._timer: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        self._begin_to_wait()

    def connection_lost(self, exc: Exception | None) -> None:
        self._stop_waiting()
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        super().data_received(data)
        if self._is_whole:
            self._stop_waiting()
        elif self._timer is None:
            self._begin_to_wait()

    def on_message_begin(self) -> None:
        self._is_whole = False
        super().on_message_begin()

    def on_headers_complete(self) -> None:
        self._stop_waiting()  # the body has a time of its own
        super().on_headers_complete()

    def on_message_complete(self) -> None:
        self._is_whole = True
        super().on_message_complete()

    def handle_websocket_upgrade(self) -> None:
        self._stop_waiting()
        super().handle_websocket_upgrade()

    def _begin_to_wait(self) -> None:
        self._timer = self.loop.call_later(self.within_s, self._is_late)

    def _stop_waiting(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _is_late(self) -> None:
        self._timer = None
        if self.flow.read_paused:  # it is we who do not read
            self._begin_to_wait()
        else:
            self.transport.abort()  # TLS would wait for a farewell, too


class PunctualLoop(uvloop.Loop):
    """Ends TLS handshakes that are not done in time."""

    within_s: float

    async def create_server(self, *arguments: Any, **options: Any) -> Any:
        if options.get("ssl"):
            options["ssl_handshake_timeout"] = self.within_s
        return await super().create_server(*arguments, **options)


class PunctualConfig(uvicorn.Config):
    """uvicorn with these two; `within_s` is how long each step may take."""

    def __init__(self, app: FastAPI, within_s: float, **options: Any) -> None:
        self._within_s = within_s
        options["http"] = type("PunctualHttp", (PunctualHttp,), {"within_s": within_s})
        super().__init__(app, **options)

    def get_loop_factory(self) -> Callable[[], asyncio.AbstractEventLoop]:
        return self._new_loop

    def _new_loop(self) -> asyncio.AbstractEventLoop:
        loop = PunctualLoop()
        loop.within_s = self._within_s
        return loop
