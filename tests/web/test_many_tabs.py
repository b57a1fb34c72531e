"""Many tabs of one browser, by plain HTTP/1.1: one stream for all, none while no tab is visible, nothing missed."""

import asyncio
import json
import re
from collections.abc import Awaitable, Callable

import pytest
from playwright.async_api import BrowserContext, Page, Request, Route, expect

from app.models import Role
from protocol.diagnostics import Diagnostics
from tests.app.robots.playing import until
from tests.web.keyboard import press
from tests.web.service import ROOT
from tests.web.test_offline import HIDE
from tests.web.test_order import fill, send
from tests.web.test_robots import give_roles
from tests.web.visitor import Visitor

pytestmark = pytest.mark.browser

TABS = 12
"""Twice as many as a browser keeps connections to one HTTP/1.1 server."""
INSIGHT = Diagnostics.model_validate_json(
    json.dumps(json.loads((ROOT / "protocol/examples/insight.json").read_text(encoding="utf-8"))["body"])
)
MAILROOM, ROBOT = 10, 11
ALL_AT_ONCE_MS = 60_000
"""Eleven pages opened in one moment, beside other tests."""


class Streams:
    """The event streams that a browser has open, and what else its pages ask for."""

    def __init__(self, context: BrowserContext) -> None:
        self.open: list[Request] = []
        self.asked: list[str] = []
        context.on("request", self._begin)
        context.on("requestfinished", self._end)
        context.on("requestfailed", self._end)

    def _begin(self, request: Request) -> None:
        path = request.url.partition("/api/v1")[2]
        if path.startswith("/live"):
            self.open.append(request)
        elif path:
            self.asked.append(path)

    def _end(self, request: Request) -> None:
        if request in self.open:
            self.open.remove(request)

    async def are_read_by(self, *pages: Page) -> None:
        async def read_so() -> bool:
            return self.readers == [*pages]

        await until(read_so)

    @property
    def readers(self) -> list[Page]:
        """Of a tab that was closed no end is reported."""
        return [page for request in self.open if not (page := request.frame.page).is_closed()]


@pytest.mark.nightly
async def test_twelve_tabs_share_one_stream_and_each_of_them_works(quiet_campus, robot, visit):
    dana = await quiet_campus.dispatcher(visit)
    await give_roles(quiet_campus.service, dana.email, Role.DISPATCHER, Role.MAINTAINER)
    streams = Streams(dana.context)
    tabs = [dana.page, *[await dana.new_page() for _ in range(TABS - 1)]]
    await tabs[0].goto("/")
    await streams.are_read_by(tabs[0])
    special = {MAILROOM: "/mailroom.html", ROBOT: f"/robots.html?robot={robot.name}"}
    await asyncio.gather(*(tab.goto(special.get(n, "/"), timeout=ALL_AT_ONCE_MS) for n, tab in enumerate(tabs[1:], 1)))
    for n, tab in enumerate(tabs):
        await expect(tab.get_by_label("From") if n not in special else tab.locator("main h1")).to_be_visible()
    assert streams.readers == tabs[:1]

    await fill(tabs[9], what="Signed forms")
    await send(tabs[9])
    await tabs[9].wait_for_url("**/follow.html*")
    for tab in (tabs[0], tabs[8]):
        await expect(tab.get_by_role("link", name=re.compile("Signed forms"))).to_be_visible()
    await expect(tabs[MAILROOM].get_by_text("Signed forms").first).to_be_visible()

    await press(tabs[MAILROOM], rf"Stop\W+{robot.name}")
    await tabs[MAILROOM].keyboard.press("Enter")
    await robot.hear("emergency_stop")
    await robot.say(INSIGHT)
    await expect(tabs[ROBOT].get_by_text("Live from the robot")).to_be_visible()


@pytest.mark.slow
async def test_a_tab_takes_over_from_one_that_is_hidden_or_closed_and_misses_nothing(quiet_campus, visit):
    ada = await visit("ada.king", at=quiet_campus.service)
    streams = Streams(ada.context)
    first, second, third = ada.page, await ada.new_page(), await ada.new_page()

    async def shows(tab: Page, what: str) -> None:
        await expect(tab.get_by_role("link", name=re.compile(what))).to_be_visible()

    for tab in (first, second, third):
        await tab.goto("/")
        await streams.are_read_by(first)
        await expect(tab.get_by_label("From")).to_be_visible()
    await ada.order("bob.martin@campus.example", what="Told to all")
    for tab in (first, second, third):
        await shows(tab, "Told to all")
    streams.asked.clear()
    await first.close()
    await streams.are_read_by(second)
    await ada.order("bob.martin@campus.example", what="Told by the second")
    await shows(third, "Told by the second")
    await second.evaluate(HIDE, True)
    await streams.are_read_by(third)
    await third.evaluate(HIDE, True)
    await streams.are_read_by()
    await ada.order("bob.martin@campus.example", what="Told later")
    await second.evaluate(HIDE, False)
    await streams.are_read_by(second)
    for tab in (second, third):
        await shows(tab, "Told later")
    assert not [path for path in streams.asked if path.startswith("/orders")], "what was missed is given, not fetched"


@pytest.mark.nightly
async def test_a_person_who_opens_a_page_while_something_happens_is_told_of_it(quiet_campus, visit):
    """Between what a page was answered and what it hears there is no gap, though nothing is asked for twice."""
    ada = await visit("ada.king", at=quiet_campus.service)
    streams = Streams(ada.context)
    for tab in (ada.page, await ada.new_page()):  # one that reads the stream, and one that is told by it
        what = f"Overtaken {tab is ada.page}"

        await tab.route("**/api/v1/orders?*", _while(ada, what))
        await tab.goto("/")
        await expect(tab.get_by_role("link", name=re.compile(what))).to_be_visible()
        await streams.are_read_by(ada.page)


def _while(person: Visitor, what: str) -> Callable[[Route], Awaitable[None]]:
    """An answer that is on its way while its person orders something elsewhere."""

    async def order_meanwhile(route: Route) -> None:
        answer = await route.fetch()
        await person.order("bob.martin@campus.example", what=what)
        await route.fulfill(response=answer)

    return order_meanwhile
