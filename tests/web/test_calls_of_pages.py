"""Requests of each page when it opens: each once, and none that it has no use for."""

import asyncio
from collections import Counter
from collections.abc import AsyncIterator
from typing import Final
from urllib.parse import urlsplit

import pytest
import pytest_asyncio
from playwright.async_api import Page, Request, expect

from app.accounts.sign_in.service import set_roles
from app.models import Role
from tests.web.mailroom_scene import Campus
from tests.web.service import Service
from tests.web.visitor import Visitor

pytestmark = pytest.mark.browser

API: Final = "/api/v1/"
LIVE: Final = API + "live"
QUIET_S: Final = 1.2
AT_MOST: Final = {
    # page, and how often it asks for something of the service, the event stream among it
    "/": 5,
    "/?from_post=post1&to_post=post4": 6,
    "/follow.html?order={order}": 6,
    "/mail.html": 7,
    "/notices.html": 4,
    "/settings.html": 9,
    "/mailroom.html": 10,
    "/mailroom.html?wall": 10,
    "/robots.html": 7,
    "/robots.html?robot=r1": 11,
    "/print.html": 4 + 5,  # a picture for each post
    "/print.html?order={order}": 6,
}


class Asked:
    """The requests of a page, as they leave the browser."""

    def __init__(self, page: Page) -> None:
        self.calls: list[str] = []
        self._streams = asyncio.Event()
        page.on("request", self._note)

    def _note(self, request: Request) -> None:
        address = urlsplit(request.url)
        if address.path == LIVE:
            self.calls.append(LIVE)  # from whichever place it goes on
            self._streams.set()
        elif address.path.startswith(API):
            self.calls.append(f"{request.method} {address.path}?{address.query}".rstrip("?"))

    async def until_quiet(self) -> Counter[str]:
        """Once the stream stands and nothing more has been asked for a while."""
        await self._streams.wait()
        before = -1
        while before != len(self.calls):
            before = len(self.calls)
            await asyncio.sleep(QUIET_S)
        return Counter(self.calls)


@pytest_asyncio.fixture(scope="module", loop_scope="session")
async def busy_campus(tmp_path_factory: pytest.TempPathFactory) -> AsyncIterator[Campus]:
    """Twelve orders, four robots, and something wrong of each kind."""
    with Service(tmp_path_factory.mktemp("calls")) as service:
        campus = Campus(service)
        campus.orders = await campus.scene.is_busy()
        await campus.scene.everything_goes_wrong(campus.orders)
        yield campus


async def of_all_trades(campus: Campus, visit) -> Visitor:
    """A visitor with all roles, who has an order and a notification of it."""
    ada = await visit(at=campus.service)
    async with campus.scene.state.database.transaction() as session:
        person = await campus.scene.state.sign_in_service.person(session, ada.email, campus.scene.clock.utc())
        set_roles(person, {Role.DISPATCHER, Role.MAINTAINER}, set())
    return ada


@pytest.mark.parametrize("address", AT_MOST)
@pytest.mark.nightly
async def test_a_page_asks_for_each_answer_once(busy_campus, visit, address):
    ada = await of_all_trades(busy_campus, visit)
    order = await ada.order("bob.martin@campus.example")
    await ada.is_told()
    asked = Asked(ada.page)
    await ada.page.goto(address.format(order=order))
    await expect(ada.page.get_by_role("heading").first).to_be_visible()
    calls = await asked.until_quiet()
    assert {call: times for call, times in calls.items() if times > 1} == {}
    assert 3 < calls.total() <= AT_MOST[address], sorted(calls)
    unread = ada.page.get_by_role("navigation").get_by_text("1 unread")
    await expect(unread).to_have_count(0 if "wall" in address else 1)


@pytest.mark.nightly
async def test_a_robot_is_asked_to_tell_once_there_is_a_stream_to_hear_it_by(busy_campus, visit):
    """Diagnostics arrive once: sent before the stream is open they would be lost and requested again."""
    ada = await of_all_trades(busy_campus, visit)
    asked = Asked(ada.page)
    me = (await (await ada.page.request.get(f"{API}me")).json())["id"]
    await ada.page.add_init_script(
        f"navigator.locks.request('live {me}', () => new Promise((go) => (window.letGo = go)))"
    )
    await ada.page.goto("/robots.html?robot=r1")
    await expect(ada.page.get_by_role("status").filter(has_text="Waiting for data")).to_be_visible()
    await asyncio.sleep(QUIET_S)
    assert not [call for call in asked.calls if "/watch" in call or call == LIVE]
    await ada.page.evaluate("window.letGo()")
    assert (await asked.until_quiet())[f"POST {API}robots/r1/watch?anew=true"] == 1


@pytest.mark.slow
async def test_what_is_told_later_is_asked_for_once(busy_campus, visit):
    """The page of the notices and what stands around it show the same answer."""
    ada = await of_all_trades(busy_campus, visit)
    asked = Asked(ada.page)
    await ada.page.goto("/notices.html")
    await asked.until_quiet()
    asked.calls.clear()
    await ada.order("bob.martin@campus.example")
    await expect(ada.page.get_by_role("navigation").get_by_text("1 unread")).to_be_visible()
    await asyncio.sleep(QUIET_S)
    assert asked.calls == [f"GET {API}notices?limit=50"]
    await ada.page.get_by_role("button", name="Mark all as read").click()
    await expect(ada.page.get_by_role("navigation").get_by_text("unread")).to_be_hidden()
    assert asked.calls[1:] == [f"POST {API}notices/read"]
