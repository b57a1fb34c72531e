"""One visit with a network, of whichever page, and then none: what helps in a tunnel is there, nothing of others."""

import re
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest
from playwright.async_api import Page, expect

from app.models import Role
from protocol.parts import StopAction
from protocol.to_robot import Mission
from protocol.to_server import Step
from tests.app.robots.playing import PlayedRobot, until
from tests.web.drawn import expect_drawn
from tests.web.service import Service
from tests.web.states import stands
from tests.web.test_offline import KEPT, KEPT_ANSWERS, WORKER_IS_THERE, is_kept, no_network, sign_out
from tests.web.test_order import BOB, fill, send
from tests.web.test_robots import give_roles
from tests.web.visitor import Visitor

pytestmark = pytest.mark.browser

ONE_MOMENT, NO_ANSWER, NOT_LOADED = "Loading", "No response", "This could not be loaded without a network."
NOT_KEPT = ("/notices.html", "/settings.html", "/follow.html?order=none")
NOT_KEPT_OF_STAFF = ("/mailroom.html", "/mailroom.html?wall", "/robots.html", "/print.html?order=none")
EVERYBODYS = ["/about", "/map"]
KEPT_OF_LINKS = """async () => {
  const cache = await caches.open("links");
  const kept = await cache.keys();
  return Promise.all(kept.map(async (one) => `${one.url} ${await (await cache.match(one))?.text()}`));
}"""


@pytest.fixture
def own_service(tmp_path: Path) -> Iterator[Service]:
    """Each test's robot has one order, and no other has."""
    with Service(tmp_path) as service:
        yield service


@asynccontextmanager
async def under_way(ada: Visitor, recipient: str) -> AsyncIterator[tuple[str, PlayedRobot, Mission]]:
    """An order that a robot has been found for: whose turn it is has a code."""
    async with ada.service.connected("r1") as robot:
        order = await ada.order(recipient, what="Keys")
        yield order, robot, await robot.mission()


async def come_once(visit, address: str, name: str = "ada.king", **options: Any) -> Visitor:
    """The first page that this browser ever opens there, and no other: it is left open until its worker stands."""
    person = await visit(name, on="phone", service_workers="allow", **options)
    await open_once(person, address)
    return person


async def open_once(person: Visitor, address: str) -> None:
    await stands(person.page, address)
    await person.page.wait_for_function(WORKER_IS_THERE)


async def of_links(page: Page, number: int) -> None:
    """Wait until so many answers are kept; a page polls every five seconds."""

    async def kept() -> bool:
        return len(await page.evaluate(KEPT_OF_LINKS)) == number

    await until(kept, limit_s=15)


async def shows_code(page: Page, digits: str) -> None:
    code = page.get_by_role("region", name=re.compile("^Your code to"))
    image = code.get_by_role("img", name="QR code for the robot’s camera")
    if not await image.is_visible():
        await code.get_by_text("Show the code").click()
    await expect_drawn(image)
    await expect(code.locator("strong.number")).to_have_text(f"{digits[:3]}\N{NO-BREAK SPACE}{digits[3:]}")


async def expect_one_word(page: Page) -> None:
    """Neither that it comes nor that there was no answer, and nothing twice."""
    await expect(page.get_by_text(NOT_LOADED)).to_have_count(1)
    await expect(page.get_by_role("heading", level=1)).to_have_count(1)
    for other in (ONE_MOMENT, NO_ANSWER):
        await expect(page.get_by_text(other)).to_have_count(0)


@pytest.mark.parametrize("first", ["/", "/mail.html", "/follow.html?order={order}", "/settings.html"])
@pytest.mark.nightly
async def test_after_one_visit_of_any_page_orders_their_codes_and_the_order_form_are_there(
    visit, own_service: Service, first
):
    ada = await visit("ada.king", on="phone", at=own_service, service_workers="allow")
    page = ada.page
    async with under_way(ada, BOB) as (order, _, _):
        digits = (await ada.api(f"/orders/{order}/code"))["digits"]
        await open_once(ada, first.format(order=order))
        async with no_network(ada):
            await page.goto("/")
            await page.get_by_role("link", name=re.compile("Keys")).click()
            await expect(page.get_by_role("heading", level=1)).to_be_visible()
            await shows_code(page, digits)
            await page.goto("/mail.html")
            sent, coming = (page.get_by_role("region", name=name, exact=True) for name in ("Sent", "Incoming"))
            await expect(sent.get_by_role("link", name=re.compile("Keys"))).to_be_visible()
            await expect(
                coming.get_by_text("Nothing in progress. Completed mail is shown when you are online.")
            ).to_be_visible()
            await expect_one_word(page)  # of what comes round again
            await page.goto("/")
            await fill(page, what="More keys")
            await send(page)
            await expect(page.get_by_role("region", name=KEPT).get_by_text("Will be sent once")).to_be_visible()


@pytest.mark.nightly
async def test_what_a_page_hears_while_it_is_open_is_there_as_well(visit, own_service: Service):
    """A person who reads that a robot comes goes to meet it."""
    ada = await visit("ada.king", at=own_service)
    bob = await come_once(visit, "/settings.html", "bob.martin", at=own_service)
    async with under_way(ada, bob.email) as (order, robot, mission):
        (load,) = [stop for stop in mission.stops if stop.action is StopAction.LOAD]
        await robot.report(mission, Step.ACCEPTED)
        await robot.ends(await robot.report(mission, Step.ARRIVED, load))
        await robot.ends(await robot.say(robot.receipt(load)))
        await is_kept(bob.page, f"/orders/{order}/code.svg")
        digits = (await bob.api(f"/orders/{order}/code"))["digits"]
        async with no_network(bob):
            await bob.page.goto(f"/follow.html?order={order}")
            await expect(bob.page.get_by_role("heading", name="A letter is on its way to you")).to_be_visible()
            await shows_code(bob.page, digits)


@asynccontextmanager
async def delegate_of(ada: Visitor, visit) -> AsyncIterator[tuple[Visitor, str, str]]:
    """A guest who has opened once the link in their mail."""
    guest = await visit("grace.hill", on="phone", at=ada.service, signed_in=False, service_workers="allow")
    guest.refusals_expected.add("/api/v1/link/order")
    async with under_way(ada, BOB) as (order, _, _):
        await ada.name_delegate(order, guest.email)
        link = ada.service.link_mailed_to(guest.email)
        await open_once(guest, link)
        await of_links(guest.page, 2)
        yield guest, link, order


@pytest.mark.nightly
async def test_after_one_visit_by_a_link_its_order_and_code_are_there(visit, own_service: Service):
    ada = await visit("ada.king", at=own_service)
    async with delegate_of(ada, visit) as (guest, link, _):
        page = guest.page
        digits = re.sub(r"\D", "", await page.locator("strong.number").text_content() or "")
        assert link.partition("#")[2] not in " ".join(await page.evaluate(KEPT_OF_LINKS)), "found, it opens no order"
        async with no_network(guest):
            await page.goto("about:blank")
            await page.goto(link)
            said = re.compile("^No network. This page shows the last known state")
            await expect(page.get_by_text(said)).to_be_visible()
            await expect(page.get_by_role("heading", level=1)).to_be_visible()
            await shows_code(page, digits)
            await guest.assert_accessible()
            await page.goto("about:blank")
            await page.goto("/one-order.html#" + "x" * 43)
            await expect_one_word(page)
            await guest.assert_accessible()


@pytest.mark.nightly
async def test_what_a_link_opened_is_forgotten_with_it(visit, own_service: Service):
    ada = await visit("ada.king", at=own_service)
    async with delegate_of(ada, visit) as (guest, _, order):
        (delegate,) = (await ada.api("/me/delegates"))["items"]
        await ada.delete(f"/orders/{order}/delegates/{delegate['id']}")
        await of_links(guest.page, 0)


@pytest.mark.nightly
async def test_what_a_link_opened_is_forgotten_when_the_order_has_ended(visit, own_service: Service):
    ada = await visit("ada.king", at=own_service)
    guest = await visit("grace.hill", at=own_service, signed_in=False, service_workers="allow")
    order = await ada.order(BOB)
    await ada.name_delegate(order, guest.email)
    await open_once(guest, own_service.link_mailed_to(guest.email))
    await of_links(guest.page, 1)
    await ada.post(f"/orders/{order}/cancel")
    await of_links(guest.page, 0)


@pytest.mark.nightly
async def test_what_a_link_opened_is_gone_when_a_person_signs_in_there(visit, own_service: Service):
    ada = await visit("ada.king", at=own_service)
    async with delegate_of(ada, visit) as (guest, *_):
        page = guest.page
        await page.goto("/")
        await page.get_by_label("Email address").fill(guest.email)
        await page.get_by_role("button", name="Send me a code").click()
        await page.get_by_label("Code from the email").fill(own_service.code_mailed_to(guest.email))
        await page.get_by_role("button", name="Sign in").click()
        await expect(page.get_by_role("heading", name="Send a letter")).to_be_visible()
        assert await page.evaluate(KEPT_OF_LINKS) == []


@pytest.mark.nightly
async def test_nothing_kept_in_one_visit_is_there_for_who_signs_in_next_nor_after_signing_out(
    visit, own_service: Service
):
    ada = await visit("ada.king", on="phone", at=own_service, service_workers="allow")
    page = ada.page
    async with under_way(ada, BOB) as (order, _, _):
        await open_once(ada, "/mail.html")
        assert f"/orders/{order}/code" in await page.evaluate(KEPT_ANSWERS)
        await ada.context.clear_cookies()
        eve = Visitor(ada.browser, own_service, f"eve.{ada.email}", ada.options)
        eve.context = ada.context
        await eve.sign_in()
        # Nothing is heard of the sign-in: the first to tell is who is said to be here.
        await stands(page, "/settings.html")
        await is_kept(page, "/orders")
        async with no_network(ada):
            await page.goto(f"/follow.html?order={order}")
            await expect_one_word(page)
            await page.goto("/mail.html")
            await expect(page.get_by_role("region", name="Sent", exact=True)).to_be_visible()
            await expect(page.get_by_text("Keys")).to_have_count(0)
        await page.goto("/")
        await sign_out(page)
        assert await page.evaluate(KEPT_ANSWERS) == EVERYBODYS


@pytest.mark.slow
async def test_a_session_that_has_ended_leaves_nothing(visit):
    ada = await visit("ada.king", on="phone", service_workers="allow")
    await ada.order(BOB, what="Keys")
    await open_once(ada, "/")
    await ada.end_sessions()
    await ada.page.goto("/")
    await expect(ada.page.get_by_label("Email address")).to_be_visible()
    assert await ada.page.evaluate(KEPT_ANSWERS) == EVERYBODYS


@pytest.mark.nightly
async def test_what_is_not_kept_says_one_clear_thing(visit):
    ada = await visit("ada.king", on="phone", service_workers="allow")
    await give_roles(ada.service, ada.email, Role.DISPATCHER, Role.MAINTAINER)
    await open_once(ada, "/")
    async with no_network(ada):
        for address in NOT_KEPT + NOT_KEPT_OF_STAFF:
            await ada.page.goto(address)
            await expect_one_word(ada.page)
            await ada.assert_accessible()
