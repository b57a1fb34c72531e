"""Campus Mail for programs that await. `client.py` is the same for those that do not, made of this file.

async with AsyncCampusMail("https://mail.campus.example", token) as mail:
    order = await mail.place("post1", "post4", "ben.ode@campus.example")
    async for order in mail.follow(order.id):
        print(order.state)
"""

import asyncio
import json
import uuid
from collections.abc import AsyncGenerator, AsyncIterator, Awaitable, Callable, Sequence
from contextlib import aclosing
from types import TracebackType
from typing import Any, Protocol, Self, TypeVar

import httpx

from campus_mail_client.answers import pause_after, problem_of, settled
from campus_mail_client.async_operations import AsyncOperations
from campus_mail_client.errors import NoAnswer
from campus_mail_client.following import ENDED, Change, OrderWatch
from campus_mail_client.models import NewOrder, OrderView
from campus_mail_client.retrying import Retrying
from campus_mail_client.sse import EventReader

Item_co = TypeVar("Item_co", covariant=True)
Item = TypeVar("Item")
SILENCE_S = 60.0
"""The service says something on a stream every 15 s; after this long the connection is dead."""


class Page(Protocol[Item_co]):
    """One page of a list."""

    @property
    def items(self) -> Sequence[Item_co]: ...

    @property
    def next(self) -> str | None: ...


class AsyncCampusMail(AsyncOperations):
    """One connection pool and one way to sign in: a token of `POST /tokens`, or a session's cookie."""

    def __init__(
        self,
        url: str,
        token: str = "",
        *,
        session: str = "",
        timeout_s: float = 10.0,
        retrying: Retrying | None = None,
        transport: httpx.AsyncBaseTransport | None = None,
    ) -> None:
        headers = {"Authorization": f"Bearer {token}"} if token else {"Origin": url.rstrip("/")}
        cookie = "__Host-session" if url.startswith("https://") else "session"
        self._retrying = retrying or Retrying()
        self._timeout_s = timeout_s
        self._http = httpx.AsyncClient(
            base_url=url,
            headers=headers,
            cookies={cookie: session} if session else None,
            timeout=timeout_s,
            transport=transport,
        )

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self.aclose()

    async def aclose(self) -> None:
        """Let go of all connections."""
        await self._http.aclose()

    async def place(
        self,
        from_post: str,
        to_post: str,
        recipient: str,
        description: str | None = None,
        *,
        key: str = "",
        **more: Any,
    ) -> OrderView:
        """Order mail to be carried. The Idempotency-Key is made here, so a retry after a lost answer is the same order.

        Give a `key` of your own where the *program* may be started again: the same key is the same order for 24 hours.
        """
        wish = NewOrder(from_post=from_post, to_post=to_post, recipient=recipient, description=description, **more)
        return await self.place_order(wish, idempotency_key=key or str(uuid.uuid4()))

    async def each(self, pages: Callable[..., Awaitable[Page[Item]]], **wanted: Any) -> AsyncIterator[Item]:
        """Everything of a list, page after page: `mail.each(mail.list_orders, role="sent")`."""
        cursor: str | None = ""
        while cursor is not None:
            page = await pages(**wanted, cursor=cursor)
            for item in page.items:
                yield item
            cursor = page.next

    async def follow(self, order_id: str) -> AsyncIterator[OrderView]:
        """The order now, and again whenever it changes, until it has ended. Breaks of the connection are bridged."""
        watch = OrderWatch(order_id)
        async with aclosing(self.changes()) as changes:
            async for change in changes:
                order = await self.one_order(order_id) if watch.must_ask(change) else watch.order_in(change)
                if order is not None and watch.is_news(order):
                    yield order
                if order is not None and order.state in ENDED:
                    return

    async def changes(self) -> AsyncGenerator[Change, None]:
        """Everything that happens and concerns this person, as it happens: `order`, `robot`, `notice` and the like.

        First `connected`: nothing is missed from then on. A broken connection is made again and goes on where it
        ended; if that is too long ago, or the service was started anew, there is a `resync`: fetch what you show again.
        """
        reader = EventReader()
        broken, connected = 0, False
        while True:
            try:
                async with self._stream(reader.last_id) as answer:
                    await self._require_stream(answer)
                    async for line in answer.aiter_lines():
                        sent, broken = reader.take(line), 0
                        if reader.last_id and not connected:  # the service listens for this person now
                            connected = True
                            yield Change("connected", {})
                        if sent is not None:
                            yield Change(sent.event, json.loads(sent.data))
            except httpx.TransportError as error:
                broken += 1
                if broken >= self._retrying.tries and not connected:
                    raise NoAnswer(f"The stream of changes cannot be opened: {error}") from error
            reader.cut()
            await asyncio.sleep(reader.retry_s * min(2**broken, 16))

    def _stream(self, last_id: str) -> Any:
        headers = {"Accept": "text/event-stream"} | ({"Last-Event-ID": last_id} if last_id else {})
        timeout = httpx.Timeout(self._timeout_s, read=SILENCE_S)
        return self._http.stream("GET", "/api/v1/live", headers=headers, timeout=timeout)

    async def _require_stream(self, answer: httpx.Response) -> None:
        if answer.is_error:
            await answer.aread()
            if pause_after(self._retrying, answer.request, answer, 1) is None:
                raise problem_of(answer)
            raise httpx.ReadError(f"answered {answer.status_code}", request=answer.request)

    async def _call(
        self,
        method: str,
        path: str,
        kind: Any,
        *,
        body: Any = None,
        query: dict[str, Any] | None = None,
        headers: dict[str, Any] | None = None,
    ) -> Any:
        """One request, sent again where that is safe. Raises Problem, NoAnswer, UnexpectedAnswer."""
        request = self._http.build_request(
            method,
            path,
            params={name: value for name, value in (query or {}).items() if value is not None},
            headers={name: str(value) for name, value in (headers or {}).items() if value is not None},
            json=None if body is None else body.model_dump(mode="json", by_alias=True, exclude_unset=True),
        )
        tries = 1
        while True:
            outcome = await self._outcome(request)
            pause_s = pause_after(self._retrying, request, outcome, tries)
            if pause_s is None:
                return settled(outcome, request, tries, kind)
            await asyncio.sleep(pause_s)
            tries += 1

    async def _outcome(self, request: httpx.Request) -> httpx.Response | httpx.TransportError:
        try:
            return await self._http.send(request)
        except httpx.TransportError as failure:
            return failure
