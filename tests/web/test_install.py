"""Campus Mail as an app on a phone: what a browser wants of it before it installs it, and what it opens."""

import json

import pytest
from playwright.async_api import expect

pytestmark = pytest.mark.browser
OFFER = """() => {
  const offer = new Event("beforeinstallprompt", { cancelable: true });
  offer.prompt = async () => (document.title = "asked");
  dispatchEvent(offer);
  return offer.defaultPrevented;
}"""


async def test_a_browser_finds_nothing_that_keeps_it_from_installing_the_pages(visit):
    ada = await visit(on="phone", service_workers="allow")
    page = ada.page
    await page.goto("/")
    await expect(page.get_by_role("heading", name="Send a letter")).to_be_visible()
    await page.evaluate("() => navigator.serviceWorker.ready")
    browser = await ada.context.new_cdp_session(page)
    errors = (await browser.send("Page.getInstallabilityErrors"))["installabilityErrors"]
    # A window that keeps nothing, as those of tests, installs nothing either.
    assert [error["errorId"] for error in errors if error["errorId"] != "in-incognito"] == []
    told = await browser.send("Page.getAppManifest")
    assert told["errors"] == []
    manifest = json.loads(told["data"])
    assert manifest["id"] == manifest["scope"] == "/"
    for icon in manifest["icons"]:
        assert (await ada.context.request.get(icon["src"])).headers["content-type"].startswith(icon["type"])
    for shortcut in manifest["shortcuts"]:
        assert (await ada.context.request.get(shortcut["url"])).ok


async def test_installing_is_offered_in_the_account_sheet_and_nowhere_else(visit):
    ada = await visit(on="phone")
    page = ada.page
    await page.goto("/")
    await expect(page.get_by_role("heading", name="Send a letter")).to_be_visible()
    offer = page.get_by_role("button", name="Install as an app")
    assert await page.evaluate(OFFER), "the browser's own banner does not come"
    await expect(offer).to_be_hidden()
    await page.locator(".account summary").click()
    await ada.assert_accessible()
    await offer.click()
    await expect(page).to_have_title("asked")
    await expect(offer).to_be_hidden()


async def test_what_is_shared_with_the_app_stands_in_the_order(visit):
    ada = await visit(on="phone")
    await ada.page.goto("/?description=Signed+forms%2C+blue+envelope")
    await expect(ada.page.get_by_label("Contents")).to_have_value("Signed forms, blue envelope")
