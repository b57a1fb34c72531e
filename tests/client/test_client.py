"""The client against the real service: what is asked, what is raised, what is sent again."""

import asyncio
import inspect
from collections.abc import Awaitable, Callable

import httpx
import pytest

from app.accounts.scopes import Scope
from campus_mail_client import AsyncCampusMail, CampusMail, NoAnswer, Retrying, UnexpectedAnswer
from campus_mail_client.models import NewDelegate, NewOrder, NoticesRead
from campus_mail_client.problems import (
    InvalidRequest,
    NotCancellable,
    OrderChanged,
    ScopeNeeded,
    UnknownOrder,
    UnknownPost,
)
from campus_mail_client.retrying import may_repeat_after_answer, may_repeat_after_failure
from tests.client.conftest import RECIPIENT, SENDER, Campus

QUICK = Retrying(first_pause_s=0.01)


class Between(httpx.AsyncBaseTransport):
    """Stands between client and service, as a bad network does: `happens(n)` may spoil the n-th request's answer."""

    def __init__(self, happens: Callable[[int, httpx.Response], Awaitable[httpx.Response]]) -> None:
        self._real, self._happens = httpx.AsyncHTTPTransport(), happens
        self.requests: list[httpx.Request] = []

    async def handle_async_request(self, request: httpx.Request) -> httpx.Response:
        self.requests.append(request)
        answer = await self._real.handle_async_request(request)
        return await self._happens(len(self.requests), answer)

    async def aclose(self) -> None:
        await self._real.aclose()


async def lost_at_first(number: int, answer: httpx.Response) -> httpx.Response:
    if number == 1:
        await answer.aclose()
        raise httpx.ReadError("the network broke before the answer came")
    return answer


@pytest.mark.slow
async def test_an_order_is_placed_read_changed_and_cancelled(campus: Campus, mail: AsyncCampusMail) -> None:
    await campus.enrol()
    await campus.announce("r1", online=True)
    await campus.service.app.state.parts.fleet.learning.poll()
    order = await mail.place("post1", "post4", RECIPIENT, "A letter")
    assert (order.state, order.sender.email, order.description) == ("queued", SENDER, "A letter")
    assert order.window is not None
    assert order.window.from_ < order.window.to
    assert order.estimate is not None
    assert (order.estimate.from_, order.estimate.to) == (order.window.from_, order.window.to)
    assert (await mail.one_order(order.id)).id == order.id
    assert (await mail.cancel_order(order.id, if_match=f'"{order.version}"')).state == "cancelled"


async def test_an_order_whose_answer_was_lost_is_placed_once(campus: Campus) -> None:
    network = Between(lost_at_first)
    async with AsyncCampusMail(campus.url, await campus.token(), retrying=QUICK, transport=network) as mail:
        order = await mail.place("post1", "post4", RECIPIENT)
        assert [one.id async for one in mail.each(mail.list_orders)] == [order.id]
    first, second = network.requests[:2]
    assert first.headers["Idempotency-Key"] == second.headers["Idempotency-Key"]


async def test_a_program_that_is_started_again_with_its_key_finds_its_order(mail: AsyncCampusMail) -> None:
    first = await mail.place("post1", "post4", RECIPIENT, key="invoice-17")
    assert (await mail.place("post1", "post4", RECIPIENT, key="invoice-17")).id == first.id


async def test_what_is_not_safe_to_repeat_is_not_repeated(campus: Campus) -> None:
    network = Between(lost_at_first)
    async with AsyncCampusMail(campus.url, await campus.token(), retrying=QUICK, transport=network) as mail:
        with pytest.raises(NoAnswer, match="in 1 tries"):
            await mail.notices_read(NoticesRead(ids=[1]))
    assert len(network.requests) == 1


async def test_a_long_list_is_walked_page_by_page(mail: AsyncCampusMail) -> None:
    placed = [(await mail.place("post1", "post4", RECIPIENT)).id for _ in range(5)]
    walked = [order.id async for order in mail.each(mail.list_orders, role="sent", limit=2)]
    assert sorted(walked) == sorted(placed)


async def test_the_delegates_of_an_order_are_walked_page_by_page(mail: AsyncCampusMail) -> None:
    order = await mail.place("post1", "post4", RECIPIENT)
    names = ["Eve", "Joe", "Zoe"]
    for name in names:
        await mail.name_delegate(order.id, NewDelegate(name=name))
    walked = [one.name async for one in mail.each(mail.list_delegates, order_id=order.id, limit=2)]
    assert sorted(walked) == names


@pytest.mark.parametrize("client", [AsyncCampusMail, CampusMail])
def test_whatever_answers_items_can_be_walked(client: type) -> None:
    """The spool alone shows the newest, without a way to the others."""
    methods = {name: inspect.signature(method) for name, method in inspect.getmembers(client, inspect.isfunction)}
    lists = {name for name, said in methods.items() if "items" in getattr(said.return_annotation, "model_fields", {})}
    assert len(lists) > 10
    assert {name for name in lists if "cursor" not in methods[name].parameters} == {"spooled_mails"}


async def test_what_the_service_refuses_is_raised_by_name(campus: Campus, mail: AsyncCampusMail) -> None:
    with pytest.raises(UnknownPost, match="Did you mean 'post4'") as unknown:
        await mail.place("post1", "pots4", RECIPIENT)
    assert (unknown.value.status, unknown.value.code) == (422, "unknown_post")
    with pytest.raises(InvalidRequest) as invalid:
        await mail.place_order(NewOrder(from_post="1", to_post="post4", recipient=RECIPIENT), idempotency_key="k")
    assert [one.field for one in invalid.value.errors] == ["from_post"]
    with pytest.raises(UnknownOrder):
        await mail.one_order("none")
    order = await mail.place("post1", "post4", RECIPIENT)
    with pytest.raises(OrderChanged):
        await mail.cancel_order(order.id, if_match='"99"')
    async with AsyncCampusMail(campus.url, await campus.token(RECIPIENT)) as theirs:
        with pytest.raises(NotCancellable):
            await theirs.cancel_order(order.id)
    async with AsyncCampusMail(campus.url, await campus.token(scopes={Scope.ROBOTS_READ})) as reader:
        assert (await reader.all_robots()).items == []
        with pytest.raises(ScopeNeeded):
            await reader.place("post1", "post4", RECIPIENT)


async def test_notices_are_read_and_marked(mail: AsyncCampusMail) -> None:
    await mail.place("post1", "post4", RECIPIENT)
    inbox = await mail.my_notices()
    await mail.notices_read(NoticesRead(ids=[inbox.items[0].id]))
    assert (inbox.unread, (await mail.my_notices()).unread) == (1, 0)


async def test_a_service_that_is_busy_is_asked_again_when_it_says(campus: Campus) -> None:
    async def busy_at_first(number: int, answer: httpx.Response) -> httpx.Response:
        if number > 1:
            return answer
        await answer.aclose()
        problem = {"code": "too_many_requests", "detail": "Too often.", "status": 429}
        return httpx.Response(429, headers={"Retry-After": "1"}, json=problem)

    async with AsyncCampusMail(campus.url, await campus.token(), transport=Between(busy_at_first)) as mail:
        began_s = asyncio.get_running_loop().time()
        assert (await mail.who_am_i()).email == SENDER
        assert asyncio.get_running_loop().time() - began_s >= 1.0


async def test_who_is_no_campus_mail_is_named_as_such() -> None:
    proxy = httpx.MockTransport(lambda request: httpx.Response(502, text="<h1>Bad gateway</h1>"))
    async with AsyncCampusMail("http://127.0.0.1", "t", retrying=QUICK, transport=proxy) as mail:
        with pytest.raises(UnexpectedAnswer, match="502"):
            await mail.who_am_i()


async def test_programs_that_do_not_await_have_the_same(campus: Campus) -> None:
    await campus.enrol()
    token = await campus.token()
    seen: list[str] = []

    def program() -> str:
        with CampusMail(campus.url, token) as mail:
            order = mail.place("post1", "post4", RECIPIENT)
            assert [one.id for one in mail.each(mail.list_orders, limit=1)] == [order.id]
            for one in mail.follow(order.id):
                seen.append(one.state)
                if one.state == "queued":
                    asyncio.run_coroutine_threadsafe(campus.move(order.id, "assigned"), loop)
                elif one.state == "assigned" and one.can_cancel:
                    return mail.cancel_order(order.id).id
        raise AssertionError("never assigned")

    loop = asyncio.get_running_loop()
    order_id = await asyncio.to_thread(program)
    assert seen[0] == "queued"
    assert seen[-1] == "assigned"
    async with AsyncCampusMail(campus.url, token) as mail:
        assert (await mail.one_order(order_id)).cancel_requested


@pytest.mark.parametrize(
    ("tries_made", "retry_after", "least_s", "most_s"), [(1, "", 0.125, 0.25), (3, "", 0.5, 1.0), (1, "7", 7, 7)]
)
def test_pauses_double_unless_the_service_names_one(
    tries_made: int, retry_after: str, least_s: float, most_s: float
) -> None:
    pause_s = Retrying().pause_s(tries_made, retry_after)
    assert pause_s is not None
    assert least_s <= pause_s <= most_s


def test_no_client_waits_for_ever() -> None:
    assert Retrying(tries=2).pause_s(2) is None
    assert Retrying().pause_s(1, "3600") is None, "a problem with retry_after_s says so instead"


def test_what_may_be_sent_again() -> None:
    key, lost, refused = {"Idempotency-Key": "k"}, httpx.ReadTimeout("late"), httpx.ConnectError("refused")
    assert [may_repeat_after_failure(*case) for case in (("GET", {}, lost), ("POST", key, lost))] == [True, True]
    assert [may_repeat_after_failure("POST", {}, failure) for failure in (lost, refused)] == [False, True]
    assert may_repeat_after_answer("POST", {}, 503, "")
    assert may_repeat_after_answer("POST", key, 409, "still_running")
    assert not may_repeat_after_answer("POST", {}, 504, "")
    assert not may_repeat_after_answer("GET", {}, 404, "unknown_order")


def test_what_a_lost_database_may_have_done_is_repeated_only_where_twice_is_once() -> None:
    assert may_repeat_after_answer("GET", {}, 503, "database_away")
    assert may_repeat_after_answer("POST", {"Idempotency-Key": "k"}, 503, "database_away")
    assert not may_repeat_after_answer("POST", {}, 503, "database_away")
    assert may_repeat_after_answer("POST", {}, 503, "not_ready")
