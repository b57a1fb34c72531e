"""The event stream of a page (SSE): ids, a time to come back, and what was missed in between."""

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable
from typing import Annotated

from fastapi import APIRouter, Depends, Header
from fastapi.sse import EventSourceResponse, ServerSentEvent
from starlette.requests import HTTPConnection

from app.errors import TooManyRequests, problems
from app.live.feed import LocalFeed, Numbered
from app.people.current_user import CurrentUser, StillSignedInDep
from app.people.rate_limits import one_stream
from app.settings import SettingsDep

router = APIRouter(tags=["live"])

RETRY_MS = 1000


def _feed_of(connection: HTTPConnection) -> LocalFeed:
    feed: LocalFeed = connection.app.state.feed
    return feed


FeedDep = Annotated[LocalFeed, Depends(_feed_of)]


@router.get(
    "/live",
    response_class=EventSourceResponse,
    dependencies=[one_stream],
    responses=problems(TooManyRequests),
)
async def live(
    user: CurrentUser,
    feed: FeedDep,
    still_signed_in: StillSignedInDep,
    settings: SettingsDep,
    last_event_id: Annotated[str, Header(max_length=64)] = "",
) -> AsyncIterator[ServerSentEvent]:
    """Events `order`, `robot` and `notice` as they happen, as this person may see them; `resync`: fetch anew."""
    with feed.listening(user) as queue:
        missed = feed.missed(user, last_event_id) if last_event_id else []
        yield ServerSentEvent(comment="following", retry=RETRY_MS, id=None if missed else feed.last_id)
        if missed is None:
            yield ServerSentEvent(event="resync", data={}, id=feed.last_id)
        for numbered in missed or []:
            yield _event(numbered)
        async for numbered in _from_now_on(queue, settings.session_check_s, lambda: still_signed_in(user)):
            yield _event(numbered)


async def _from_now_on(
    queue: asyncio.Queue[Numbered | None], check_every_s: float, may_listen: Callable[[], Awaitable[bool]]
) -> AsyncIterator[Numbered]:
    """Until the feed ends, or whoever listens may do so no longer: a stream outlives many a session."""
    now_s = asyncio.get_running_loop().time
    check_at_s = now_s() + check_every_s
    while True:
        try:
            async with asyncio.timeout_at(check_at_s):
                numbered = await queue.get()
        except TimeoutError:
            if not await may_listen():
                return
            check_at_s = now_s() + check_every_s
            continue
        if numbered is None:
            return
        yield numbered


def _event(numbered: Numbered) -> ServerSentEvent:
    return ServerSentEvent(event=numbered.happening.event, data=dict(numbered.happening.data), id=numbered.id)
