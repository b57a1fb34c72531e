"""New notifications pop up: they cover no control, and stay while pointer or focus is on them."""

import asyncio
import re

import pytest
from playwright.async_api import Route, expect

from tests.web.keyboard import Keyboard

pytestmark = pytest.mark.browser

BOB = "bob.martin@campus.example"
SHOWN_MS = 12_000
IS_OVER_THE_KEYBOARD = """() => {
  const one = document.querySelector(".toast").getBoundingClientRect();
  const other = document.activeElement.getBoundingClientRect();
  return one.left < other.right && other.left < one.right && one.top < other.bottom && other.top < one.bottom;
}"""


@pytest.mark.slow
async def test_a_notice_lies_never_over_the_keyboard_and_waits_for_the_person_typing(visit):
    ada = await visit(viewport={"width": 320, "height": 640}, reduced_motion="reduce")
    page, keys = ada.page, Keyboard(ada.page)
    await page.clock.install()
    stands = asyncio.Event()

    async def fetched_late(route: Route) -> None:
        await stands.wait()
        await route.continue_()

    # It comes before what shows it has been fetched.
    await page.route("**/src/pages/after_opening.js", fetched_late)
    await page.goto("/")
    await expect(page.get_by_role("heading", name="Send a letter")).to_be_visible()
    await ada.order(BOB)
    await expect(page.get_by_role("link", name=re.compile("Inbox"))).to_have_accessible_name(re.compile("1 unread"))
    stands.set()
    toast = page.get_by_role("status").get_by_role("link", name=re.compile("^Order accepted"))
    await expect(toast).to_be_visible()

    # Wherever the keyboard goes, it lies elsewhere.
    send = page.get_by_role("button", name="Send the robot")
    await send.focus()
    await send.evaluate("(button) => button.scrollIntoView({ block: 'end' })")
    await expect(page.locator(".toast.high")).to_be_visible()
    assert not await page.evaluate(IS_OVER_THE_KEYBOARD)
    # Nor where nothing scrolls.
    await page.get_by_role("link", name="Campus Mail").evaluate("(link) => link.focus({ preventScroll: true })")
    await expect(page.locator(".toast:not(.high)")).to_be_visible()
    await send.evaluate("(button) => button.focus({ preventScroll: true })")
    await expect(page.locator(".toast.high")).to_be_visible()
    await page.get_by_role("link", name="Campus Mail").focus()
    await expect(page.locator(".toast:not(.high)")).to_be_visible()
    assert not await page.evaluate(IS_OVER_THE_KEYBOARD)

    # Time stands still for a pointer, and for the keyboard.
    await toast.hover()
    await page.clock.fast_forward(2 * SHOWN_MS)
    await expect(toast).to_be_visible()
    await send.focus()
    await toast.focus()
    await page.mouse.move(5, 5)
    await page.clock.fast_forward(2 * SHOWN_MS)
    await expect(toast).to_be_visible()

    # Escape puts it away, and the keyboard is where it was.
    await keys.press("Escape")
    await expect(toast).to_be_hidden()
    await expect(send).to_be_focused()

    # The next one goes by itself; nothing is told twice.
    await ada.order(BOB)
    await expect(toast).to_be_visible()
    await page.clock.fast_forward(SHOWN_MS)
    await expect(toast).to_be_hidden()
    await page.evaluate("() => dispatchEvent(new Event('pagehide'))")
    async with page.expect_request("**/api/v1/live*"):
        await page.evaluate("() => dispatchEvent(new PageTransitionEvent('pageshow', {persisted: true}))")
    await page.evaluate("() => new Promise((done) => setTimeout(done, 100))")
    await expect(toast).to_be_hidden()
