"""Properties of every page: languages, themes, small screens, and a network that comes and goes."""

import re

import pytest
from playwright.async_api import expect

pytestmark = pytest.mark.browser

BOB = "bob.martin@campus.example"
NO_OVERFLOW = "() => document.documentElement.scrollWidth <= document.documentElement.clientWidth"
GROUND = "() => getComputedStyle(document.documentElement).backgroundColor.match(/[0-9.]+/g).map(Number)"
SMALL_TARGETS = """() => [...document.querySelectorAll("a, button, input, select, summary")]
  .filter((element) => element.checkVisibility() && !element.matches(".skip"))
  .map((element) => ({name: element.outerHTML.slice(0, 60), height: element.getBoundingClientRect().height}))
  .filter(({height}) => height < 43.5)"""


async def test_a_theme_is_that_of_the_device_and_changes_with_it(visit):
    """Both themes are seen in every state by test_every_state.py."""
    ada = await visit(on="phone", color_scheme="dark")
    await ada.page.goto("/mail.html")
    await expect(ada.page.get_by_role("heading", level=1)).to_be_visible()
    assert sum((await ada.page.evaluate(GROUND))[:3]) / 3 < 55
    await ada.page.emulate_media(color_scheme="light")
    assert sum((await ada.page.evaluate(GROUND))[:3]) / 3 > 200


async def test_a_french_speaker_orders_in_french(visit):
    ada = await visit("aline.roy", on="phone", locale="fr-CA", signed_in=False)
    page = ada.page
    await page.goto("/")
    await expect(page.get_by_role("heading", name="Le courrier livré par robot")).to_be_visible()
    await ada.sign_in()
    await page.reload()
    await page.get_by_label("De", exact=True).select_option("Post 1")
    await page.get_by_label("À", exact=True).select_option("Post 4")
    await page.get_by_label("E-mail du destinataire").fill(BOB)
    await expect(page.get_by_text("L’heure d’arrivée n’est pas encore connue.")).to_be_visible()
    await page.get_by_role("button", name="Envoyer le robot").click()
    await expect(page.get_by_role("heading", name="Recherche d’un robot")).to_be_visible()
    await expect(page.locator("html")).to_have_attribute("lang", "fr")
    await page.get_by_role("link", name="Notifs").click()
    await expect(page.get_by_text(re.compile("^Commande acceptée"))).to_be_visible()


async def test_without_network_the_page_keeps_what_it_knows_says_so_and_catches_up(visit):
    ada = await visit()
    order_id = await ada.order(BOB)
    page = ada.page
    await page.goto(f"/follow.html?order={order_id}")
    await expect(page.get_by_role("heading", name="Looking for a robot")).to_be_visible()
    async with ada.without_network():
        # Leaving the page and coming back opens its stream anew.
        await page.evaluate("() => dispatchEvent(new Event('pagehide'))")
        await page.evaluate("() => dispatchEvent(new PageTransitionEvent('pageshow', {persisted: true}))")
        await expect(page.get_by_text(re.compile("^No connection"))).to_be_visible()
        await expect(page.get_by_role("heading", name="Looking for a robot")).to_be_visible()
        own = {"Sec-Fetch-Site": "same-origin"}
        await ada.context.request.post(f"/api/v1/orders/{order_id}/cancel", headers=own)
    await expect(page.get_by_role("heading", name="Cancelled")).to_be_visible()
    await expect(page.get_by_text(re.compile("^No connection"))).to_be_hidden()


async def test_a_notice_arrives_live_is_counted_and_can_be_read(visit):
    ada = await visit()
    page = ada.page
    await page.goto("/")
    notices = page.get_by_role("link", name=re.compile("Inbox"))
    await expect(notices).to_have_accessible_name("Inbox")
    await expect(page.get_by_role("heading", name="Send a letter")).to_be_visible()
    await ada.order(BOB)
    await expect(page.get_by_role("status").get_by_role("link", name=re.compile("^Order accepted"))).to_be_visible()
    await page.get_by_role("button", name="Dismiss").click()
    await expect(page.get_by_role("button", name="Dismiss")).to_be_hidden()
    await expect(notices).to_have_accessible_name(re.compile("1 unread"))
    await notices.click()
    await expect(page.get_by_role("link", name=re.compile("Order accepted.*Unread"))).to_be_visible()
    await page.get_by_role("button", name="Mark all as read").click()
    await expect(notices).to_have_accessible_name("Inbox")
    await expect(page.get_by_role("button", name="Mark all as read")).to_be_hidden()
    await page.get_by_role("link", name=re.compile("Order accepted")).click()
    await expect(page.get_by_role("heading", name="Looking for a robot")).to_be_visible()


async def test_a_service_that_does_not_answer_is_said_in_words(visit):
    ada = await visit(signed_in=False)
    async with ada.without_network():
        await ada.page.goto("/")
        await expect(ada.page.get_by_role("heading", name="Campus Mail is not responding")).to_be_visible()
    await ada.page.get_by_role("button", name="Try again").click()
    await expect(ada.page.get_by_label("Email address")).to_be_visible()
