"""Requests of a page before it can be used: each once, and later needs later."""

import re
from pathlib import Path

import pytest
from playwright.async_api import Page, Route, expect

pytestmark = pytest.mark.browser
WEB = Path(__file__).parents[2] / "web"
BEGUN = re.compile(r'<link rel="preload" as="fetch" href="([^"]+)"')
ADDRESSES = """() => performance.getEntriesByType("resource").map(({ name }) => name.replace(location.origin, ""))"""
LIVE, NOTICES = "/api/v1/live", "/api/v1/notices?limit=50"
# A browser writes an answer down when its last byte has come, which may be after the page has shown what it read.
WRITTEN_DOWN = f"""(awaited) => awaited.every((one) => ({ADDRESSES})().includes(one))"""
PLACE_AN_ORDER = ("/src/orders/place_order.js", "/src/offline/outbox.js", "/src/orders/send_order.js")


async def asked_for(page: Page, awaited: list[str]) -> list[str]:
    """The addresses that the page has had an answer from, once each of those awaited is among them."""
    await page.wait_for_function(WRITTEN_DOWN, arg=awaited)
    return await page.evaluate(ADDRESSES)


@pytest.mark.parametrize(("file", "address"), [("index.html", "/"), ("mail.html", "/mail.html")])
async def test_what_the_head_has_begun_to_ask_is_what_the_page_takes(visit, file, address):
    """A page that took none of them would ask for all of them a second time."""
    ada = await visit(on="phone")
    # When the stream opens, all is asked again: here it never does.
    await ada.page.route("**/api/v1/live", lambda route: None)
    await ada.page.goto(address, wait_until="commit")
    await expect(ada.page.locator("main h1")).to_be_visible()
    begun = [
        address.replace("&amp;", "&") for address in BEGUN.findall((WEB / "public" / file).read_text(encoding="utf-8"))
    ]
    assert "/api/v1/me" in begun
    asked = await asked_for(ada.page, begun)
    # The clock of a demonstration asks for the time again.
    assert {one: asked.count(one) for one in begun if one != "/api/v1/about"} == dict.fromkeys(begun[1:], 1)


async def test_the_shell_stands_while_what_the_page_shows_is_on_its_way(visit):
    """And takes no turn on the wire from it: six at a time is all that a browser fetches."""
    ada = await visit(on="phone")
    held: list[Route] = []

    async def hold(route: Route) -> None:
        held.append(route)

    await ada.page.route("**/src/orders/order_page.js", hold)
    await ada.page.goto("/", wait_until="commit")
    await expect(ada.page.get_by_role("navigation")).to_be_visible()
    await expect(ada.page).to_have_title("Send a letter · Campus Mail")
    assert not {LIVE, NOTICES} & {*await ada.page.evaluate(ADDRESSES)}
    async with ada.page.expect_request(f"**{LIVE}*"):
        await held[0].continue_()
    await expect(ada.page.get_by_label("From")).to_be_visible()
    assert NOTICES not in await ada.page.evaluate(ADDRESSES), "how many are unread is said with who is here"


async def test_what_ends_an_order_is_fetched_when_a_person_begins_one(visit):
    ada = await visit(on="phone")
    await ada.page.goto("/")
    await expect(ada.page.locator(".estimate")).to_contain_text("arrival")
    assert not {*PLACE_AN_ORDER} & {*await ada.page.evaluate(ADDRESSES)}
    async with ada.page.expect_response("**/src/orders/place_order.js"):
        await ada.page.get_by_label("From").focus()


async def test_a_choice_whose_fields_could_not_be_fetched_is_not_marked_as_taken(visit):
    """Else a letter for later would go out at once."""
    ada = await visit(on="phone")
    page = ada.page
    await page.route("**/order_schedule.js*", lambda route: route.abort())
    await page.goto("/")
    await page.get_by_role("radio", name="Later").dispatch_event("click")
    await expect(page.get_by_text("No response. Check your network and try again.")).to_be_visible()
    await expect(page.get_by_role("radio", name="Now")).to_be_checked()
    await page.unroute("**/order_schedule.js*")
    await page.get_by_role("radio", name="Later").check()
    await expect(page.locator("order-schedule input").first).to_be_visible()
    await expect(page.get_by_text("No response. Check your network and try again.")).to_be_hidden()
    ada.complaints.clear()  # of the answers that were cut off here


async def test_an_order_whose_end_could_not_be_fetched_says_so_and_goes_out_when_it_is_tapped_again(visit):
    """The network went away between the form and the tap, on the very first visit: nothing of the page is kept yet."""
    ada = await visit(on="phone")
    await ada.page.route("**/src/orders/send_order.js*", lambda route: route.abort())
    await ada.page.goto("/")
    await ada.page.get_by_label("From").select_option("Post 1")
    await ada.page.get_by_label("To", exact=True).select_option("Post 4")
    await ada.page.get_by_label("Recipient’s email").fill("bob.martin@campus.example")
    await ada.page.get_by_role("button", name="Send the robot").click()
    await expect(ada.page.get_by_text("No response. Check your network and try again.")).to_be_visible()
    await ada.page.unroute("**/src/orders/send_order.js*")
    await ada.page.get_by_role("button", name="Send the robot").click()
    await ada.page.wait_for_url("**/follow.html*")
    ada.complaints.clear()  # of the answers that were cut off here
