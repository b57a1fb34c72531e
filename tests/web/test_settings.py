"""Personal settings; each part saves by itself, and says so."""

import re
from collections.abc import AsyncIterator
from pathlib import Path

import pytest
import pytest_asyncio
from playwright.async_api import expect

from app.core.http_client import HttpClient
from app.core.settings import Settings
from app.notifications.channels.webhook import secret_bytes
from protocol.clock import RealClock
from tests.app.notifications.receivers import receiving
from tests.app.notifications.test_webhooks import is_signed
from tests.app.robots.playing import serving
from tests.web.keyboard import Keyboard
from tests.web.service import Service
from tests.web.visitor import Visitor

pytestmark = pytest.mark.browser

NO_OVERFLOW = "() => document.documentElement.scrollWidth <= document.documentElement.clientWidth"


async def test_language_name_post_and_notices_are_changed_and_kept(visit):
    ada: Visitor = await visit("ada.king", on="phone", viewport={"width": 320, "height": 640})
    page = ada.page
    await page.goto("/")
    await page.locator("summary").filter(has_text="Account").click()
    await page.get_by_role("link", name="Settings").click()
    me = page.get_by_role("region", name="Profile")
    await me.get_by_label("Name").fill("Augusta Ada King")
    await me.get_by_label("Usual post").select_option("Post 2")
    await expect(me.get_by_role("status")).to_have_text("Saved")
    await me.get_by_label("Language").select_option("Français")
    await expect(page.get_by_role("heading", level=1)).to_have_text("Réglages")
    await expect(page).to_have_title(re.compile("^Réglages"))
    await expect(page.get_by_role("navigation", name="Pages").get_by_role("link", name="Mon courrier")).to_be_visible()

    notices = page.get_by_role("region", name="Notifications")
    await notices.get_by_role("checkbox", name="Livrée, E-mail").uncheck()
    await expect(notices.get_by_role("status")).to_have_text("Enregistré")
    assert await page.evaluate(NO_OVERFLOW)
    await ada.assert_accessible()
    await page.reload()
    await expect(page.get_by_role("checkbox", name="Livrée, E-mail")).not_to_be_checked()
    person = await ada.api("/me")
    assert (person["name"], person["language"], person["usual_post"]) == ("Augusta Ada King", "fr", "post2")


async def test_the_address_book_is_kept_with_the_keyboard_alone(visit):
    ada: Visitor = await visit("ada.king")
    page = ada.page
    await ada.order("bob.martin@campus.example")
    await page.goto("/settings.html")
    book = page.get_by_role("region", name="Address book")
    await book.get_by_role("button", name="Save, Bob Martin").focus()
    await page.keyboard.press("Enter")
    await expect(book.get_by_label("Display name")).to_be_focused()
    await page.keyboard.press("Control+a")
    await page.keyboard.type("Bob next door")
    await page.keyboard.press("Tab")
    await page.keyboard.type("Post 3")
    await page.keyboard.press("Tab")
    await page.keyboard.press("Enter")
    bob = book.get_by_role("listitem").filter(has_text="Bob next door")
    await expect(bob).to_contain_text("bob.martin@campus.example · Post 3")
    await book.get_by_label("Email address").fill("porter")
    await page.keyboard.press("Enter")
    await expect(book.get_by_role("alert")).to_have_text("This is not an email address.")
    await bob.get_by_role("button", name="Remove, Bob next door").click()
    await expect(book.get_by_role("status")).to_contain_text("Removed")
    await expect(book.get_by_role("listitem")).to_have_text(re.compile("Bob Martin"))


@pytest.mark.nightly
async def test_delegates_are_in_one_list_and_taken_back_there_by_keyboard(visit):
    ada: Visitor = await visit("ada.king", locale="fr-CA")
    page, keys = ada.page, Keyboard(ada.page)
    letter = await ada.order("bob.martin@campus.example", what="Les clés")
    await ada.name_delegate(letter, "porter@campus.example")
    await ada.name_delegate(await ada.order("bea.lund@campus.example"), "porter@campus.example")
    await page.goto("/settings.html")
    named = page.get_by_role("region", name="Personnes désignées")
    await expect(named.get_by_role("listitem")).to_have_count(2)
    oldest = named.get_by_role("listitem").last
    for told in ("The porter", "porter@campus.example", "Dépose la lettre à Post 1", "Valable jusqu’à"):
        await expect(oldest).to_contain_text(told)
    await ada.assert_accessible()
    await keys.to("Révoquer, The porter, Pour Bea Lund")
    await keys.press("Enter")
    await expect(named.get_by_role("status")).to_contain_text("Révoqué")
    await expect(named.get_by_role("listitem")).to_have_count(1)
    await keys.to("Révoquer, The porter, Les clés")
    await keys.press("Enter")
    await expect(named.get_by_text(re.compile("^Personne pour l’instant"))).to_be_visible()
    await expect(named.get_by_role("link", name="Mon courrier")).to_be_visible()
    (delegate,) = (await ada.api(f"/orders/{letter}/delegates"))["items"]
    assert delegate["revoked_at"], "for the robot too"


async def test_sessions_are_ended_and_a_scripts_token_is_shown_once_and_revoked(visit):
    ada: Visitor = await visit("ada.king")
    elsewhere: Visitor = await visit(signed_in=False)
    elsewhere.email = ada.email
    await elsewhere.sign_in()
    page = ada.page
    await page.goto("/settings.html")
    sessions = page.get_by_role("region", name="Active sessions")
    await expect(sessions.get_by_role("listitem")).to_have_count(2)
    await sessions.get_by_role("button", name="End all others").click()
    await page.get_by_role("button", name="Yes, end them").click()
    await expect(sessions.get_by_role("listitem")).to_have_count(1)
    assert (await elsewhere.context.request.get("/api/v1/me")).status == 401

    tokens = page.get_by_role("region", name="Access tokens")
    await tokens.get_by_role("button", name="Create token").click()
    await expect(tokens.get_by_role("alert")).to_have_text("Enter a purpose.")
    await tokens.get_by_label("What it is for").fill("Night report")
    await tokens.get_by_role("checkbox", name="See my orders").check()
    await tokens.get_by_role("button", name="Create token").click()
    token = await tokens.get_by_role("group", name=re.compile("^Your new token")).locator("code").inner_text()
    bearer = {"Authorization": f"Bearer {token}"}
    script = await elsewhere.context.request.get("/api/v1/orders", headers=bearer)
    assert script.ok
    await ada.assert_accessible()
    await page.reload()
    await expect(tokens.get_by_text("Night report")).to_be_visible()
    await expect(page.get_by_text(token)).to_have_count(0)
    await tokens.get_by_role("button", name="Revoke, Night report").click()
    await expect(tokens.get_by_text("Night report")).to_have_count(0)
    assert (await elsewhere.context.request.get("/api/v1/orders", headers=bearer)).status == 401

    hook = page.get_by_role("region", name="Webhook")
    ada.refusals_expected.add("/api/v1/me/webhook")
    await hook.get_by_label("URL").fill("https://127.0.0.1/told")
    await hook.get_by_role("button", name="Save webhook").click()
    await expect(hook.get_by_role("alert")).to_contain_text("This URL cannot be used")


@pytest_asyncio.fixture(loop_scope="session")
async def open_service(tmp_path: Path) -> AsyncIterator[Service]:
    """One that posts to this machine too, as none does that was not made so in its code."""
    service = Service(tmp_path)
    settings = Settings(data=tmp_path, public_url=service.url)
    async with serving(settings, RealClock(), http_client=HttpClient(allow_private=True)) as here:
        service.url = f"http://127.0.0.1:{here.port}"
        yield service


@pytest.mark.slow
async def test_a_webhook_is_tried_at_a_tap_and_says_whether_it_hears_or_why_not(open_service, visit):
    ada: Visitor = await visit("ada.king", at=open_service, on="phone")
    page = ada.page
    await page.goto("/settings.html#webhook")
    hook = page.get_by_role("region", name="Webhook")
    with receiving() as receiver:
        receiver.answers = [204, 503]
        await hook.get_by_label("URL").fill(f"{receiver.url}/told")
        await hook.get_by_role("button", name="Save webhook").click()
        secret = await hook.get_by_role("group", name=re.compile("^Signing secret")).locator("code").inner_text()
        await hook.get_by_role("button", name="Send test").click()
        await expect(hook.get_by_role("status")).to_have_text("It answered 204: notifications arrive.")
        (heard,) = receiver.received
        assert (heard.path, is_signed(heard, secret_bytes(secret))) == ("/told", True)
        await ada.assert_accessible()
        await hook.get_by_role("button", name="Send test").click()
        await expect(hook.get_by_role("alert")).to_contain_text("It answered 503. Only 200 to 299")
    await hook.get_by_role("button", name="Send test").click()
    await expect(hook.get_by_role("alert")).to_contain_text("No answer (no answer: ConnectError)")
    await ada.assert_accessible()
