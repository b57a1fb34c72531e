"""The event stream of a browser (SSE): ids, a time to come back, and what was missed in between."""

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable
from typing import Annotated

from fastapi import APIRouter, Header, Query
from fastapi.sse import KEEPALIVE_COMMENT, format_sse_event
from starlette.responses import StreamingResponse

from app.accounts.current_user import CurrentUser, StillSignedInDep
from app.accounts.rate_limits import one_stream
from app.core.errors import TooManyRequests, problems
from app.core.parts import part
from app.core.settings import SettingsDep
from app.models import Person
from app.realtime.feed import LocalFeed, Numbered

router = APIRouter(tags=["live"])

RETRY_MS = 1000
KEEP_ALIVE_S = 15.0
"""Real seconds. A proxy closes what is silent for long."""
UNBUFFERED = {"Cache-Control": "no-cache", "X-Accel-Buffering": "no"}

TOLD = ("OrderView", "RobotView", "RobotTraffic", "NotificationView", "Watched")
"""What the data of the events is, `resync` apart, whose data is empty."""
EVENT = {
    "type": "object",
    "properties": {
        "event": {"type": "string", "enum": ["order", "robot", "traffic", "notice", "insight", "resync"]},
        "data": {
            "type": "string",
            "contentMediaType": "application/json",
            "contentSchema": {"anyOf": [{"$ref": f"#/components/schemas/{name}"} for name in TOLD]},
        },
        "id": {"type": "string"},
        "retry": {"type": "integer", "minimum": 0},
    },
}
"""One event, for the document. FastAPI's own streams would encode each anew for each listener."""

Since = Annotated[
    str,
    Query(
        max_length=64,
        pattern=r"^[0-9a-f-]*$",
        description="The `Feed-Position` of an answer, or the `id` of an event: what came after it is told first.",
    ),
]
MayListen = Callable[[], Awaitable[bool]]


class EventStream(StreamingResponse):
    """Pieces that are on the wire's form already."""

    media_type = "text/event-stream"


FeedDep = Annotated[LocalFeed, part(LocalFeed)]


@router.get(
    "/live",
    response_class=EventStream,
    dependencies=[one_stream],
    responses={200: {"content": {"text/event-stream": {"itemSchema": EVENT}}}, **problems(TooManyRequests)},
)
async def live(
    user: CurrentUser,
    feed: FeedDep,
    still_signed_in: StillSignedInDep,
    settings: SettingsDep,
    last_event_id: Annotated[str, Header(max_length=64)] = "",
    since: Since = "",
) -> EventStream:
    """Events `order`, `robot`, `traffic`, `closed`, `notice` as they happen, as one may see them; `resync`: fetch anew.

    `Last-Event-ID` outranks `since`.

    `insight` comes to maintainers who watch a robot (`watch_robot`), has no id and is not given again.
    """
    pieces = _pieces(user, feed, last_event_id or since, settings.session_check_s, lambda: still_signed_in(user))
    return EventStream(pieces, headers=UNBUFFERED)


async def _pieces(
    user: Person, feed: LocalFeed, last_event_id: str, check_every_s: float, may_listen: MayListen
) -> AsyncIterator[bytes]:
    with feed.listening(user) as queue:
        missed = feed.missed(user, last_event_id) if last_event_id else []
        yield format_sse_event(comment="following", retry=RETRY_MS, id=None if missed else feed.last_id)
        if missed is None:
            yield format_sse_event(event="resync", data_str="{}", id=feed.last_id)
        elif missed:
            yield b"".join(one.wire for one in missed)
        async for piece in _from_now_on(queue, check_every_s, may_listen):
            yield piece


async def _from_now_on(
    queue: asyncio.Queue[Numbered | None], check_every_s: float, may_listen: MayListen
) -> AsyncIterator[bytes]:
    """Until the feed ends, or the listener may do so no longer: a stream outlives many a session."""
    now_s = asyncio.get_running_loop().time
    check_at_s = now_s() + check_every_s
    while True:
        try:
            async with asyncio.timeout_at(min(check_at_s, now_s() + KEEP_ALIVE_S)):
                numbered = await queue.get()
        except TimeoutError:
            if now_s() < check_at_s:
                yield KEEPALIVE_COMMENT
            elif await may_listen():
                check_at_s = now_s() + check_every_s
            else:
                return
            continue
        wire, goes_on = _all_there_is(queue, numbered)
        if wire:
            yield wire
        if not goes_on:
            return


def _all_there_is(queue: asyncio.Queue[Numbered | None], first: Numbered | None) -> tuple[bytes, bool]:
    """Return what waits, in one piece; and if the stream goes on after it."""
    pieces = []
    numbered = first
    while numbered is not None:
        pieces.append(numbered.wire)
        if queue.empty():
            return b"".join(pieces), True
        numbered = queue.get_nowait()
    return b"".join(pieces), False
