"""Notices that a phone shows by itself: pushed into the service worker, as a push service does."""

import asyncio
import json
import re
from collections.abc import Awaitable, Callable

import pytest
from playwright.async_api import CDPSession, expect

from tests.web.test_offline import WORKER_IS_THERE
from tests.web.visitor import Visitor

pytestmark = pytest.mark.browser
SHOWN = """async (tags) => {
  const registration = await navigator.serviceWorker.ready;
  for (;;) {
    const shown = await registration.getNotifications();
    if (tags.every((tag) => shown.some((one) => one.tag === tag))) {
      return shown.map(({ title, body, tag, lang, data }) => ({ title, body, tag, lang, url: data.url }));
    }
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}"""


async def push_to(ada: Visitor) -> Callable[[str], Awaitable[object]]:
    """What a push service does: it hands a text to the worker of this page."""
    browser: CDPSession = await ada.context.new_cdp_session(ada.page)
    found: asyncio.Future[str] = asyncio.get_running_loop().create_future()

    def hear(event: dict[str, list[dict[str, str]]]) -> None:
        if event["registrations"] and not found.done():
            found.set_result(event["registrations"][-1]["registrationId"])

    browser.on("ServiceWorker.workerRegistrationUpdated", hear)
    await browser.send("ServiceWorker.enable")
    async with asyncio.timeout(15):
        to = {"origin": ada.service.url, "registrationId": await found}
    return lambda text: browser.send("ServiceWorker.deliverPushMessage", {**to, "data": text})


async def test_a_pushed_notice_is_shown_once_and_leads_to_its_letter_and_an_unreadable_one_to_the_notices(visit):
    ada = await visit(on="phone", service_workers="allow", permissions=["notifications"])
    page = ada.page
    await page.goto("/")
    await page.wait_for_function(WORKER_IS_THERE)
    push = await push_to(ada)
    await push("not what the service sends")
    (unreadable,) = await page.evaluate(SHOWN, [""])
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
    shown = await page.evaluate(SHOWN, [notice["tag"], "another"])
    assert [one["tag"] for one in shown].count(notice["tag"]) == 1, "what is told twice is shown once"
    (one,) = [one for one in shown if one["tag"] == notice["tag"]]
    assert (one["title"], one["body"], one["lang"]) == (notice["title"], notice["body"], "en")
    await page.goto(one["url"])
    await expect(page.get_by_role("heading", name="Looking for a robot")).to_be_visible()


async def test_pages_know_how_a_device_stands_with_notices(visit):
    ada = await visit(on="phone", service_workers="allow")
    await ada.page.goto("/")
    await expect(ada.page.get_by_role("heading", name="Send a letter")).to_be_visible()
    state = "async () => (await import('/push.js')).pushState()"
    assert await ada.page.evaluate(state) in {"off", "refused"}
    await ada.page.evaluate("() => delete window.PushManager")
    assert await ada.page.evaluate(state) == "unsupported"
    words = "async () => (await import('/push.js')).pushWords('refused')"
    assert re.search("was told not to show notices", await ada.page.evaluate(words))
