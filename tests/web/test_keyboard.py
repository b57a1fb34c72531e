"""Every page's main task with the keyboard alone: nothing is clicked here, and nothing is focused but by keys."""

import re
from collections.abc import AsyncIterator

import pytest
import pytest_asyncio
from playwright.async_api import expect

from tests.web.keyboard import Keyboard

pytestmark = pytest.mark.browser

BOB = "bob.martin@campus.example"


async def test_somebody_signs_in_sends_a_letter_follows_it_cancels_it_and_settles_their_language_by_keys(
    visit, service
):
    ada = await visit("ada.king", signed_in=False, reduced_motion="reduce")
    page, keys = ada.page, Keyboard(ada.page)
    heading = page.get_by_role("heading", level=1)
    await page.goto("/")
    await expect(page.get_by_label("E-mail address")).to_be_visible()
    await keys.to("E-mail address")
    await keys.type(ada.email)
    await keys.press("Enter")
    await expect(page.get_by_label("Code from the e-mail")).to_be_focused()
    await keys.type(service.code_mailed_to(ada.email))
    await keys.press("Enter")
    await expect(heading).to_have_text("Send a letter")

    await keys.to("Skip to")
    await keys.press("Enter")
    await keys.to("From")
    await keys.type("Post 1")
    await keys.to("To")
    await keys.type("Post 4")
    await keys.to("Recipient’s e-mail")
    await keys.type(BOB)
    await keys.to("Now")
    await keys.press("ArrowRight")
    await expect(page.get_by_role("radio", name="Later")).to_be_focused()
    await keys.press("ArrowLeft")
    await expect(page.get_by_role("radio", name="Now")).to_be_checked()
    await keys.to("Send the robot")
    await keys.press("Enter")
    await expect(heading).to_have_text("Looking for a robot")

    await keys.stands()
    await keys.to("Cancel this order")
    await keys.press("Enter")
    assert await keys.here() == "Keep it", "what undoes nothing comes first"
    await keys.press("Escape")
    assert await keys.here() == "Cancel this order", "the keyboard is back where it was"
    await keys.press("Enter", "Tab", "Enter")
    await expect(heading).to_have_text("Cancelled")
    await expect(page.get_by_role("heading", name="Its way")).to_be_focused()

    await keys.to("My mail", "Shift+Tab")
    await keys.press("Enter")
    await expect(heading).to_have_text("My mail")
    await keys.to("Search")
    await keys.type("bob")
    await expect(page.get_by_text("1 letter found")).to_be_visible()
    await keys.to("Send again to")
    await keys.press("Enter")
    await expect(page.get_by_label("Recipient’s e-mail")).to_have_value(BOB)

    await keys.to(r".*unread Notices")
    await keys.press("Enter")
    await expect(page.get_by_role("button", name="Mark all as read")).to_be_visible()
    await keys.stands()
    await keys.to("Mark all as read")
    await keys.press("Enter")
    await expect(page.get_by_role("button", name="Mark all as read")).to_be_hidden()
    await expect(heading).to_be_focused()
    await keys.to("Order accepted")
    await keys.press("Enter")
    await expect(heading).to_have_text("Cancelled")

    await keys.to("AK Account")
    await keys.press("Enter")
    await keys.to("Settings")
    await keys.press("Enter")
    await expect(heading).to_have_text("Settings")
    await keys.to("Language")
    await keys.type("Fran")
    await expect(heading).to_have_text("Réglages")
    assert await keys.here() == "Langue"
    await keys.to("Remise, E-mail")
    await keys.press("Space")
    await expect(page.get_by_role("checkbox", name="Remise, E-mail")).not_to_be_checked()
