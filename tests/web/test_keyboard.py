"""Every page's main task with the keyboard alone: nothing is clicked here, and nothing is focused but by keys."""

import re
from collections.abc import AsyncIterator

import pytest
import pytest_asyncio
from playwright.async_api import expect

from tests.web.full_campus import Campus, full_campus
from tests.web.keyboard import Keyboard

pytestmark = pytest.mark.browser

BOB = "bob.martin@campus.example"


@pytest_asyncio.fixture(scope="module", loop_scope="session")
async def campus(tmp_path_factory: pytest.TempPathFactory) -> AsyncIterator[Campus]:
    async with full_campus(tmp_path_factory.mktemp("keyboard")) as campus:
        yield campus


@pytest.mark.nightly
async def test_a_person_signs_in_sends_a_letter_follows_it_cancels_it_and_settles_their_language_by_keys(
    visit, service
):
    ada = await visit("ada.king", signed_in=False, reduced_motion="reduce")
    page, keys = ada.page, Keyboard(ada.page)
    heading = page.get_by_role("heading", level=1)
    await page.goto("/")
    await expect(page.get_by_label("Email address")).to_be_visible()
    await keys.to("Email address")
    await keys.type(ada.email)
    await keys.press("Enter")
    await expect(page.get_by_label("Code from the email")).to_be_focused()
    await keys.type(service.code_mailed_to(ada.email))
    await keys.press("Enter")
    await expect(heading).to_have_text("Send a letter")

    await keys.to("Skip to")
    await keys.press("Enter")
    await keys.to("From")
    await keys.type("Post 1")
    await keys.to("To")
    await keys.type("Post 4")
    await keys.to("Recipient’s email")
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
    await expect(page.get_by_role("heading", name="Route")).to_be_focused()

    await keys.to("My mail", "Shift+Tab")
    await keys.press("Enter")
    await expect(heading).to_have_text("My mail")
    await keys.to("Search")
    await keys.type("bob")
    await expect(page.get_by_text("1 letter found")).to_be_visible()
    await keys.to("Send again to")
    await keys.press("Enter")
    await expect(page.get_by_label("Recipient’s email")).to_have_value(BOB)

    await keys.to(r".*unread Inbox")
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
    await keys.to("Livrée, E-mail")
    await keys.press("Space")
    await expect(page.get_by_role("checkbox", name="Livrée, E-mail")).not_to_be_checked()


@pytest.mark.nightly
async def test_a_dispatcher_orders_for_a_sender_pauses_a_robot_acts_on_an_order_and_prints_by_keys(visit, campus):
    dana = await campus.staff(visit)
    page, keys = dana.page, Keyboard(dana.page)
    dialog = page.get_by_role("dialog")
    await page.goto("/mailroom.html")
    await expect(page.get_by_role("button", name=re.compile("^Acknowledge"))).to_be_visible()
    await keys.stands()
    await keys.to("Order at the desk")
    await keys.press("Enter")
    await expect(dialog).to_be_visible()
    stops = await keys.walk()
    assert stops[0].startswith("Recipient"), "it begins at the first field, and nothing behind the dialog is come to"
    await keys.press("Escape")
    assert await keys.here() == "Order at the desk"

    await keys.to("Acknowledge")
    await keys.press("Enter")
    await expect(
        page.get_by_text("Acknowledged: A wheel does not turn although it should. It says: The lid does not close.")
    ).to_be_visible()
    assert (await keys.here()).startswith("Issues"), "what was pressed is gone"
    await keys.to("Decide")
    await keys.press("Enter", "ArrowDown", "Enter")
    await expect(page.get_by_text(re.compile("^Decided: "))).to_be_visible()
    await expect(page.locator(":focus")).to_be_visible()
    await keys.to("Act.*Bob Martin to Grace Hill")
    await keys.press("Enter")
    await expect(dialog).to_be_visible()
    await keys.to("Change priority")
    await keys.press("Enter")
    await expect(page.get_by_role("radio", name="Normal priority")).to_be_focused()
    await keys.press("ArrowUp", "Enter")
    await expect(page.get_by_text(re.compile("^Priority of .* saved"))).to_be_visible()
    assert (await keys.here()).startswith("Actions")

    await keys.to("Robot r1")
    await keys.press("Enter")
    await expect(page.get_by_role("heading", level=1)).to_have_text("Robot r1")
    await expect(page.get_by_role("button", name="Recall")).to_be_visible()
    await keys.to("Recall")
    await keys.press("Enter")
    await expect(page.get_by_label("Reason")).to_be_focused()
    await keys.type("A parade")
    await keys.press("Enter")
    await expect(page.get_by_role("listitem").filter(has_text="Return to base")).to_be_visible()
    assert await keys.here() == "Recall"

    await page.goto("/print.html")
    await expect(page.get_by_role("button", name="Print 9 sheets")).to_be_visible()
    await keys.to("Post 3")
    await keys.press("Space")
    await expect(page.get_by_role("button", name="Print 6 sheets")).to_be_visible()
    await page.evaluate("() => addEventListener('beforeprint', () => (document.title = 'printed'))")
    await keys.to("Print 6 sheets")
    await keys.press("Enter")
    await expect(page).to_have_title("printed")


@pytest.mark.nightly
async def test_a_person_without_account_sees_their_code_and_says_not_now_by_keys(visit, campus):
    guest = await visit("grace.hopper", at=campus.service, signed_in=False, reduced_motion="reduce")
    await campus.order_of("bob.martin", guest.email.partition("@")[0], "carrying")
    page, keys = guest.page, Keyboard(guest.page)
    await page.goto(campus.service.link_mailed_to(guest.email))
    await expect(page.get_by_text("Show the code")).to_be_visible()
    await keys.stands()
    await keys.to("Show the code")
    await keys.press("Enter")
    await expect(page.get_by_role("img", name="QR code for the robot’s camera")).to_be_visible()
    await keys.to("I can’t take it now")
    await keys.press("Enter", "Escape")
    assert await keys.here() == "I can’t take it now"
    await keys.press("Enter")
    await keys.to("Yes, send it back")
    await keys.press("Enter")
    await expect(page.get_by_text("The robot has been asked to bring it back.")).to_be_visible()
    await expect(page.locator(":focus")).to_be_visible()  # somewhere, though what was pressed is gone
    await keys.to("Français", "Shift+Tab")
    await keys.press("Enter")
    await expect(page.get_by_role("button", name="English")).to_be_visible()
