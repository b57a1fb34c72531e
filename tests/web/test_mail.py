"""My mail: found again, sent again, and sent again and again."""

import re

import pytest
from playwright.async_api import expect

from tests.web.visitor import Visitor

pytestmark = pytest.mark.browser

BOB, CLEO = "bob.martin@campus.example", "cleo.wong@campus.example"


async def test_mail_is_searched_as_one_types_narrowed_down_and_sent_again(visit):
    ada: Visitor = await visit("ada.king", on="phone")
    page = ada.page
    kept = await ada.order(BOB, to_post="post2", what="Signed forms")
    await ada.order(CLEO, to_post="post3", what="Keys")
    await ada.post(f"/orders/{kept}/cancel")
    await ada.orders(21, CLEO)
    await page.goto("/mail.html")
    sent = page.get_by_role("region", name="Sent")
    letters = sent.get_by_role("listitem")
    await expect(letters).to_have_count(20)
    await sent.get_by_role("button", name="Show older").click()
    await expect(letters).to_have_count(23)
    await expect(
        page.get_by_role("region", name="Incoming").get_by_text("Nothing is on its way to you.")
    ).to_be_visible()

    search = page.get_by_role("searchbox", name="Search")
    await search.press_sequentially("BOB.mar")
    await expect(page.get_by_role("status").get_by_text("1 letter found")).to_be_visible()
    await expect(letters).to_have_text(re.compile("Signed forms"))
    await search.fill("post 3")
    await expect(letters).to_have_text(re.compile("Keys"))
    await page.get_by_role("radio", name="Done").check()
    await expect(sent.get_by_text("No results.")).to_be_visible()
    await search.fill("")
    await expect(letters).to_have_text(re.compile("Cancelled.*Signed forms", re.DOTALL))
    await ada.assert_accessible()
    await sent.get_by_role("link", name="Send again to Bob Martin").click()
    await expect(page.get_by_label("Contents")).to_have_value("Signed forms")


async def test_a_standing_order_is_paused_resumed_and_ended_with_the_keyboard(visit):
    ada: Visitor = await visit("aline.roy", locale="fr-CA", timezone_id="America/Toronto")
    page = ada.page
    every = {"weekdays": [0, 2], "at": "09:30", "zone": "America/Toronto"}
    wish = {"from_post": "post1", "to_post": "post4", "recipient": BOB, "description": "Paie", **every}
    await ada.post("/standing-orders", wish)
    await page.goto("/mail.html")
    paie = page.get_by_role("region", name="Envois réguliers").get_by_role("listitem")
    await expect(paie).to_contain_text(re.compile(r"chaque lundi et mercredi à 9\sh\s30"))
    await expect(paie).to_contain_text("Prochain")
    pause = paie.get_by_role("button", name=re.compile(r"^Mettre en pause\s: Bob Martin"))
    await pause.focus()
    await page.keyboard.press("Enter")
    await expect(paie).to_contain_text("En pause")
    await expect(paie.get_by_role("button", name=re.compile("^Reprendre"))).to_be_focused()
    await page.keyboard.press("Enter")
    await expect(paie).to_contain_text("Actif")
    await page.keyboard.press("Tab")
    await page.keyboard.press("Enter")
    await expect(page.get_by_role("dialog").get_by_role("button", name="La garder")).to_be_focused()
    await page.keyboard.press("Tab")
    await page.keyboard.press("Enter")
    await expect(paie).to_contain_text("Terminé")
    await expect(paie.get_by_role("button")).to_have_count(0)
