"""One deadline for everything that a request waits for: its turn to write, the database's lock, a connection.

Each wait has a limit of its own otherwise, and a request that meets several would hold its caller for their sum.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from time import monotonic
from typing import Final

from starlette.types import ASGIApp, Message, Receive, Scope, Send

WAIT_S: Final = 10.0
"""Real seconds that what is no request waits for one transaction; of a request the settings say it."""


@dataclass
class _Deadline:
    """Inherited by the tasks that a request starts; they outlive it, so it is lifted for all of them at once."""

    at_s: float | None


_present: ContextVar[_Deadline | None] = ContextVar("deadline", default=None)


def left_s() -> float:
    """Return the time for which the database may still be waited for here; 0 or more."""
    present = _present.get()
    if present is None or present.at_s is None:
        return WAIT_S
    return max(0.0, present.at_s - monotonic())


@contextmanager
def waiting_at_most(limit_s: float) -> Iterator[None]:
    """Wait no longer than this in here, nor than was allowed before."""
    before = _present.set(_Deadline(monotonic() + min(limit_s, left_s())))
    try:
        yield
    finally:
        _present.reset(before)


class RequestDeadline:
    """Gives each HTTP request its deadline. Streams, which go on after the answer has begun, are free of it then."""

    def __init__(self, app: ASGIApp, wait_s: float) -> None:
        self._app, self._wait_s = app, wait_s

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        deadline = _Deadline(monotonic() + self._wait_s)
        before = _present.set(deadline)

        async def send_and_lift(message: Message) -> None:
            deadline.at_s = None
            await send(message)

        try:
            await self._app(scope, receive, send_and_lift)
        finally:
            deadline.at_s = None
            _present.reset(before)
