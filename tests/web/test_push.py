"""Notices that a phone shows by itself: pushed into the service worker, as a push service does."""

import asyncio
import json
import re
from collections.abc import AsyncIterator, Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest
import pytest_asyncio
from playwright.async_api import Browser, Playwright, expect

from benchmarks.pages.chromium import find_chromium
from tests.app.robots.playing import until
from tests.web.service import Service
from tests.web.test_offline import WORKER_IS_THERE, worker_of
from tests.web.visitor import Visitor

pytestmark = pytest.mark.browser


@pytest.fixture
def chromium(whole_chromium: Browser) -> Browser:
    """The shell shows no notices."""
    return whole_chromium


# Who asks for the notices while one is on its way to the screen makes Chromium forget that one: it is in the list and
# not shown yet. Therefore no test asks before the worker has been told that it is shown.
NOTE_WHAT_IS_SHOWN = """() => {
  const show = ServiceWorkerRegistration.prototype.showNotification;
  self.shown = 0;
  ServiceWorkerRegistration.prototype.showNotification = async function (...what) {
    await show.apply(this, what);
    self.shown += 1;
  };
}"""
IS_SHOWN = """async (number) => {
  while (self.shown < number) await new Promise((resolve) => setTimeout(resolve, 20));
}"""
SHOWN = """async () => (await (await navigator.serviceWorker.ready).getNotifications())
  .map(({ title, body, tag, lang, data }) => ({ title, body, tag, lang, url: data.url }))"""


# A browser lets a worker open windows for the finger of a person alone: the event is made here, and where it would lead
# is noted. The notice, the windows and the inbox are real.
TAP = """async (title) => {
  const soon = async (look) => {
    for (let tries = 0; tries < 400; tries += 1) {
      const seen = await look();
      if (seen) return seen;
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
    throw new Error(`not seen: ${look}`);
  };
  const shown = async () => (await registration.getNotifications()).filter((one) => one.title === title);
  let leads = null;
  clients.openWindow = async (url) => void (leads = ["opens", url]);
  WindowClient.prototype.focus = async function () { leads = ["focuses", this.url]; };
  const [first, ...others] = await shown();
  const before = 1 + others.length;
  dispatchEvent(new NotificationEvent("notificationclick", { notification: first }));
  await soon(async () => leads && (await shown()).length < before);
  return { leads, left: (await shown()).length };
}"""


async def push_to(ada: Visitor) -> Callable[[str], Awaitable[object]]:
    """Hand a text to the worker as a push service does, and wait until the worker has shown it."""
    fire, number = await worker_of(ada), 0
    (worker,) = ada.context.service_workers
    await worker.evaluate(NOTE_WHAT_IS_SHOWN)

    async def push(text: str) -> None:
        nonlocal number
        number += 1
        await fire("deliverPushMessage", data=text)
        async with asyncio.timeout(30):
            await worker.evaluate(IS_SHOWN, number)

    return push


@pytest.mark.nightly
async def test_a_pushed_notice_is_shown_once_and_leads_to_its_letter_and_an_unreadable_one_to_the_notices(visit):
    ada = await visit(on="phone", service_workers="allow", permissions=["notifications"])
    page = ada.page
    await page.goto("/")
    await page.wait_for_function(WORKER_IS_THERE)
    push = await push_to(ada)
    await push("not what the service sends")
    (unreadable,) = await page.evaluate(SHOWN)
    assert (unreadable["title"], unreadable["url"]) == ("Campus Mail", "/notices.html")

    order_id = await ada.order("bob.martin@campus.example")
    notice = {
        "tag": f"{order_id}/robot_here",
        "kind": "robot_here",
        "order_id": order_id,
        "title": "The robot is waiting at Post 1",
        "body": "Hold your code to the robot's camera.",
        "at": "2026-11-22T12:00:00+00:00",
        "language": "en",
    }
    for _ in range(2):
        await push(json.dumps(notice))
    await push(json.dumps({**notice, "tag": "another"}))
    shown = await page.evaluate(SHOWN)
    assert [one["tag"] for one in shown].count(notice["tag"]) == 1, "what is told twice is shown once"
    (one,) = [one for one in shown if one["tag"] == notice["tag"]]
    assert (one["title"], one["body"], one["lang"]) == (notice["title"], notice["body"], "en")
    await page.goto(one["url"])
    await expect(page.get_by_role("heading", name="Looking for a robot")).to_be_visible()


async def told(ada: Visitor, order_id: str) -> dict[str, str]:
    """The push message of Ada's newest notification of this order."""

    async def notices() -> list[dict[str, str]]:
        return [one for one in (await ada.api("/notices"))["items"] if one["order_id"] == order_id]

    newest = (await until(notices, limit_s=15))[0]
    notice = {name: newest[name] for name in ("kind", "order_id", "title", "body", "at")}
    return {**notice, "tag": f"{order_id}/{notice['kind']}", "language": "en"}


async def tap(ada: Visitor, title: str) -> dict[str, Any]:
    """On a notice that is shown; where it leads, and how many are shown still."""
    (worker,) = ada.context.service_workers
    return await worker.evaluate(TAP, title)


@pytest.mark.nightly
async def test_a_tap_on_a_notice_leads_to_its_letter_in_the_window_that_shows_it_or_in_a_new_one(visit):
    ada = await visit(on="phone", service_workers="allow", permissions=["notifications"])
    page, url = ada.page, ada.service.url
    await page.goto("/")
    await page.wait_for_function(WORKER_IS_THERE)
    push = await push_to(ada)
    order_id = await ada.order("bob.martin@campus.example")
    notice = await told(ada, order_id)
    letter = f"{url}/follow.html?order={order_id}"
    await push(json.dumps(notice))
    assert await tap(ada, notice["title"]) == {"leads": ["opens", letter], "left": 0}, "the form stays as it was"

    async def nothing_is_unread() -> bool:
        return bool((await ada.api("/notices"))["unread"] == 0)

    await until(nothing_is_unread, limit_s=15)
    await page.goto(f"{letter}#content")
    await expect(page.get_by_role("heading", name="Looking for a robot")).to_be_visible()
    await push(json.dumps({**notice, "tag": "told once more"}))
    assert await tap(ada, notice["title"]) == {"leads": ["focuses", f"{letter}#content"], "left": 0}
    await push("not what the service sends")
    assert (await tap(ada, "Campus Mail"))["leads"] == ["opens", f"{url}/notices.html"]


@pytest_asyncio.fixture(loop_scope="session")
async def installed(
    playwright_here: Playwright, service: Service, tmp_path: Path, browser_type_launch_args: dict[str, Any]
) -> AsyncIterator[Visitor]:
    """Ada, who has installed the app: in a browser that keeps things, since a test's usual window installs nothing."""
    arguments = {**browser_type_launch_args, "executable_path": find_chromium(whole=True)}
    options = {"base_url": service.url, "locale": "en-CA", "permissions": ["notifications"]}
    context = await playwright_here.chromium.launch_persistent_context(str(tmp_path), **arguments, **options)
    assert context.browser is not None
    ada = Visitor(context.browser, service, "ada.installed@campus.example", options)
    ada.context = context
    ada.page = await ada.new_page()
    await ada.sign_in()
    await ada.page.goto("/")
    await ada.page.wait_for_function(WORKER_IS_THERE)
    yield ada
    await context.close()
    assert not ada.complaints


@pytest.mark.nightly
async def test_the_installed_apps_icon_counts_what_is_unread_until_it_is_read(installed: Visitor):
    ada = installed
    browser = await ada.context.new_cdp_session(await ada.context.new_page())
    app = {"manifestId": f"{ada.service.url}/"}
    asked = await ada.context.new_cdp_session(ada.page)
    assert (await asked.send("Page.getInstallabilityErrors"))["installabilityErrors"] == []
    await browser.send("PWA.install", {**app, "installUrlOrBundleUrl": f"{ada.service.url}/"})

    async def counts(number: int) -> None:
        async def does() -> bool:
            return bool((await browser.send("PWA.getOsAppState", app))["badgeCount"] == number)

        await until(does, limit_s=15)

    push = await push_to(ada)
    await ada.page.close()
    for what in ("Keys", "Books"):
        await push(json.dumps(await told(ada, await ada.order("bob.martin@campus.example", what=what))))
    await counts(2)
    page = await ada.new_page()
    await page.goto("/notices.html")
    await page.get_by_role("button", name="Mark all as read").click()
    await counts(0)


@pytest.mark.slow
async def test_pages_know_how_a_device_stands_with_notices(visit):
    ada = await visit(on="phone", service_workers="allow")
    await ada.page.goto("/")
    await expect(ada.page.get_by_role("heading", name="Send a letter")).to_be_visible()
    state = "async () => (await import('/src/offline/push.js')).pushState()"
    assert await ada.page.evaluate(state) in {"off", "refused"}
    await ada.page.evaluate("() => delete window.PushManager")
    assert await ada.page.evaluate(state) == "unsupported"
    words = "async () => (await import('/src/offline/push.js')).pushWords('refused')"
    assert re.search("blocks notifications", await ada.page.evaluate(words))
