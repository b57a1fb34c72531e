"""What a page asks for before it can be used: each thing once, and what only later is needed, later."""

import re
from pathlib import Path

import pytest
from playwright.async_api import expect

pytestmark = pytest.mark.browser
WEB = Path(__file__).parents[2] / "web"
BEGUN = re.compile(r'<link rel="preload" as="fetch" href="([^"]+)"')
ADDRESSES = """() => performance.getEntriesByType("resource").map(({ name }) => name.replace(location.origin, ""))"""
PLACE_AN_ORDER = ("/place_order.js", "/outbox.js", "/send_order.js")


@pytest.mark.parametrize(("file", "address"), [("index.html", "/"), ("mail.html", "/mail.html")])
async def test_what_the_head_has_begun_to_ask_is_what_the_page_takes(visit, file, address):
    """A page that took none of them would ask for all of them a second time."""
    ada = await visit(on="phone")
    # When the stream opens, all is asked again: here it never does.
    await ada.page.route("**/api/v1/live", lambda route: None)
    await ada.page.goto(address, wait_until="commit")
    await expect(ada.page.locator("main h1")).to_be_visible()
    asked = await ada.page.evaluate(ADDRESSES)
    begun = [address.replace("&amp;", "&") for address in BEGUN.findall((WEB / file).read_text(encoding="utf-8"))]
    assert "/api/v1/me" in begun
    # The clock of a demonstration asks for the time again.
    assert {one: asked.count(one) for one in begun if one != "/api/v1/about"} == dict.fromkeys(begun[1:], 1)


async def test_what_ends_an_order_is_fetched_when_somebody_begins_one(visit):
    ada = await visit(on="phone")
    await ada.page.goto("/")
    await expect(ada.page.locator(".estimate")).to_contain_text("arrive")
    assert not {*PLACE_AN_ORDER} & {*await ada.page.evaluate(ADDRESSES)}
    async with ada.page.expect_response("**/place_order.js"):
        await ada.page.get_by_label("From").focus()


async def test_an_order_whose_end_could_not_be_fetched_says_so_and_goes_out_when_it_is_tapped_again(visit):
    """The network went away between the form and the tap, on the very first visit: nothing of the page is kept yet."""
    ada = await visit(on="phone")
    await ada.page.route("**/send_order.js", lambda route: route.abort())
    await ada.page.goto("/")
    await ada.page.get_by_label("From").select_option("Post 1")
    await ada.page.get_by_label("To", exact=True).select_option("Post 4")
    await ada.page.get_by_label("Recipient’s e-mail").fill("bob.martin@campus.example")
    await ada.page.get_by_role("button", name="Send the robot").click()
    await expect(ada.page.get_by_text("No answer. Check your network and try again.")).to_be_visible()
    await ada.page.unroute("**/send_order.js")
    await ada.page.get_by_role("button", name="Send the robot").click()
    await ada.page.wait_for_url("**/follow.html*")
    ada.complaints.clear()  # of the answers that were cut off here
