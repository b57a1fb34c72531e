"""The place in the event stream at which an answer was read: from there on the stream tells what has changed since."""

from typing import Final

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.realtime.feed import LocalFeed

FEED_POSITION: Final = "Feed-Position"
SENT_BY_BROWSERS: Final = "sec-fetch-mode"


class FeedPosition:
    """Adds `Feed-Position` to every answer that is read: `GET /live?since=…` goes on from there, with no gap."""

    def __init__(self, app: ASGIApp, feed: LocalFeed) -> None:
        self._app, self._feed = app, feed

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http" or scope["method"] != "GET" or not scope["path"].startswith("/api/"):
            await self._app(scope, receive, send)
            return
        if SENT_BY_BROWSERS in Headers(scope=scope):
            self._feed.expect_listener()
        position = self._feed.last_id  # Before anything is read: a change in between is told twice rather than never.

        async def send_with_position(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message)[FEED_POSITION] = position
            await send(message)

        await self._app(scope, receive, send_with_position)
