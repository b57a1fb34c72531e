"""The event stream of a page (SSE): ids, a time to come back, and what was missed in between."""

from collections.abc import AsyncIterator
from typing import Annotated

from fastapi import APIRouter, Depends, Header
from fastapi.sse import EventSourceResponse, ServerSentEvent
from starlette.requests import HTTPConnection

from app.errors import problems
from app.live.feed import LocalFeed, Numbered
from app.people.current_user import CurrentUser

router = APIRouter(tags=["live"])

RETRY_MS = 1000


def _feed_of(connection: HTTPConnection) -> LocalFeed:
    feed: LocalFeed = connection.app.state.feed
    return feed


FeedDep = Annotated[LocalFeed, Depends(_feed_of)]


@router.get("/live", response_class=EventSourceResponse, responses=problems(401, 403))
async def live(
    user: CurrentUser, feed: FeedDep, last_event_id: Annotated[str, Header(max_length=64)] = ""
) -> AsyncIterator[ServerSentEvent]:
    """Events `order`, `robot` and `notice` as they happen, as this person may see them; `resync`: fetch anew."""
    with feed.listening(user) as queue:
        missed = feed.missed(user, last_event_id) if last_event_id else []
        yield ServerSentEvent(comment="following", retry=RETRY_MS, id=None if missed else feed.last_id)
        if missed is None:
            yield ServerSentEvent(event="resync", data={}, id=feed.last_id)
        for numbered in missed or []:
            yield _event(numbered)
        while (numbered_or_end := await queue.get()) is not None:
            yield _event(numbered_or_end)


def _event(numbered: Numbered) -> ServerSentEvent:
    return ServerSentEvent(event=numbered.happening.event, data=dict(numbered.happening.data), id=numbered.id)
