"""Orders that were not placed: shown as long as they are kept, and sent again only when their person says so."""

import re
from collections.abc import Awaitable, Callable

import pytest
from playwright.async_api import BrowserContext, Page, Route, expect

from tests.web.test_offline import KEPT, come_with_worker, no_network, worker_of
from tests.web.test_order import fill, send
from tests.web.visitor import Visitor

pytestmark = pytest.mark.browser

ORDERS = "/api/v1/orders"


async def ordered(person: Visitor) -> list[str]:
    return [order["description"] for order in (await person.api("/orders"))["items"]]


def placings(context: BrowserContext) -> list[str]:
    """Keys of all tries to place an order from now on, by pages and worker."""
    keys: list[str] = []

    def count(request) -> None:
        if request.method == "POST" and request.url.endswith(ORDERS):
            keys.append(request.headers["idempotency-key"])

    context.on("request", count)
    return keys


def refusing(status: int, code: str) -> Callable[[Route], Awaitable[None]]:
    async def refuse(route: Route) -> None:
        if route.request.method == "POST":
            await route.fulfill(status=status, json={"code": code, "title": code, "status": status})
        else:
            await route.continue_()

    return refuse


async def opened_again(page: Page) -> None:
    """And the outbox has had its chance to send: it asks who is signed in first."""
    async with page.expect_response(lambda answer: answer.url.endswith("/me") and answer.request.method == "GET"):
        await page.reload()
    await expect(page.get_by_role("region", name=KEPT)).to_be_visible()


@pytest.mark.nightly
async def test_an_order_that_was_refused_for_its_lost_session_is_shown_and_waits_for_its_persons_word(visit):
    ada = await visit("ada.king", on="phone")
    page, kept = ada.page, ada.page.get_by_role("region", name=KEPT)
    keys = placings(ada.context)
    await page.goto("/")
    await fill(page, what="Ghost")
    await ada.end_sessions()
    await send(page)
    await expect(kept.get_by_text(re.compile("^Not sent. You were signed out"))).to_be_visible()
    assert len(keys) == 1, "no 401 is tried again"
    await ada.sign_in()
    await page.reload()
    await expect(kept.get_by_text("Not sent.")).to_be_visible()
    async with ada.without_network():
        await fill(page, what="Second")
        await send(page)
        await expect(kept.get_by_text("Will be sent once")).to_be_visible()
    await expect(kept.get_by_text("Sent. Looking for a robot")).to_be_visible()
    assert await ordered(ada) == ["Second"]
    await ada.assert_accessible()
    await kept.get_by_role("button", name="Send now").click()
    await expect(kept.get_by_text("Sent. Looking for a robot")).to_have_count(2)
    assert await ordered(ada) == ["Ghost", "Second"]


@pytest.mark.parametrize(("status", "code"), [(409, "conflict"), (429, "too_many_requests")])
@pytest.mark.slow
async def test_a_refused_order_is_tried_once_and_can_be_thrown_away(visit, status, code):
    ada = await visit("ada.king", on="phone")
    ada.refusals_expected.add(ORDERS)
    ada.loses_answers = True
    page, kept = ada.page, ada.page.get_by_role("region", name=KEPT)
    keys = placings(ada.context)
    await page.route("**" + ORDERS, refusing(status, code))
    await page.goto("/")
    await fill(page, what="Refused")
    await send(page)
    await expect(kept.get_by_text("Not sent.")).to_be_visible()
    await expect(page.get_by_label("Contents")).to_have_value("")
    assert len(keys) == 1
    await page.unroute_all()
    await opened_again(page)
    await fill(page, what="Second")
    await send(page)
    await expect(page.get_by_role("heading", name="Looking for a robot")).to_be_visible()
    await kept.get_by_role("button", name="Discard").click()
    await expect(kept).to_be_hidden()
    assert await ordered(ada) == ["Second"] and len(set(keys)) == len(keys) == 2


@pytest.mark.slow
async def test_what_the_worker_is_refused_is_shown_and_not_tried_again_by_it(visit):
    ada = await come_with_worker(visit, "ada.king", permissions=["background-sync"])
    ada.refusals_expected.add(ORDERS)
    page, fire = ada.page, await worker_of(ada)
    async with no_network(ada):
        await fill(page, what="Refused")
        await send(page)
        await expect(page.get_by_role("region", name=KEPT).get_by_text("Will be sent once")).to_be_visible()
        await page.close()
        keys = placings(ada.context)
    await ada.context.route("**" + ORDERS, refusing(401, "not_signed_in"))
    async with ada.context.expect_event("response", lambda answer: answer.request.method == "POST"):
        await fire("dispatchSyncEvent", tag="orders", lastChance=False)
    await fire("dispatchSyncEvent", tag="orders", lastChance=True)
    page = await ada.new_page()
    await page.goto("/")
    kept = page.get_by_role("region", name=KEPT)
    await expect(kept.get_by_text("Not sent.")).to_be_visible()
    assert len(keys) == 1
    await ada.context.unroute_all()
    await kept.get_by_role("button", name="Send now").click()
    await expect(kept.get_by_text("Sent. Looking for a robot")).to_be_visible()
    assert await ordered(ada) == ["Refused"] and len(set(keys)) == 1
