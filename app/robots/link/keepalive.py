"""The robots' side of uvicorn's WebSockets: who speaks is there, so that only the silent are asked."""

from typing import Any

from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

LOOKS_AFTER_S = 3.0
ANSWERS_WITHIN_S = 5.0
"""A robot out of the network's reach is shown as offline within 11 s: twice the one and the other once. Our own robots
ping every 2 s (`robot/link/connection.py`), so that none of them is asked while its network is there."""


class AttentiveSocket(WebSocketsSansIOProtocol):
    """A ping and its answer cost as much as a report, and a thousand robots that report each second need none."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._has_spoken = False

    def data_received(self, data: bytes) -> None:
        self._has_spoken = True
        super().data_received(data)

    def send_keepalive_ping(self) -> None:
        """Called after each interval."""
        if self._has_spoken:
            self._has_spoken = False
            self.schedule_ping()
        else:
            super().send_keepalive_ping()
