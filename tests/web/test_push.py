"""Notices that a phone shows by itself: pushed into the service worker, as a push service does."""

import json
import re

import pytest
from playwright.async_api import CDPSession, expect

from tests.web.test_offline import WORKER_IS_THERE
from tests.web.visitor import Visitor

pytestmark = pytest.mark.browser
SHOWN = """async () => {
  const { active, ...registration } = await navigator.serviceWorker.ready;
  const shown = await (await navigator.serviceWorker.ready).getNotifications();
  return shown.map(({ title, body, tag, lang, data }) => ({ title, body, tag, lang, url: data.url }));
}"""
REGISTRATION = "() => navigator.serviceWorker.ready.then(() => true)"


async def pushed(ada: Visitor, text: str) -> None:
    """As from the push service, to the worker of this page."""
    browser: CDPSession = await ada.context.new_cdp_session(ada.page)
    found: dict[str, str] = {}
    browser.on("ServiceWorker.workerRegistrationUpdated", lambda event: found.update(event["registrations"][0]))
    await browser.send("ServiceWorker.enable")
    await ada.page.wait_for_timeout(200)
    told = {"origin": ada.service.url, "registrationId": found["registrationId"], "data": text}
    await browser.send("ServiceWorker.deliverPushMessage", told)


async def come_with_notices(visit) -> Visitor:
    ada: Visitor = await visit(on="phone", service_workers="allow", permissions=["notifications"])
    await ada.page.goto("/")
    await ada.page.wait_for_function(WORKER_IS_THERE)
    return ada


async def test_a_pushed_notice_is_shown_once_and_leads_to_its_letter(visit):
    ada = await come_with_notices(visit)
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
        await pushed(ada, json.dumps(notice))
    shown = await ada.page.evaluate(SHOWN)
    assert shown == [
        {
            **{name: notice[name] for name in ("title", "body", "tag")},
            "lang": "en",
            "url": f"/follow.html?order={order_id}",
        }
    ]
    await ada.page.goto(shown[0]["url"])
    await expect(ada.page.get_by_role("heading", name="Looking for a robot")).to_be_visible()


async def test_a_push_that_nobody_can_read_is_shown_as_one_and_leads_to_the_notices(visit):
    ada = await come_with_notices(visit)
    await pushed(ada, "not what the service sends")
    (shown,) = await ada.page.evaluate(SHOWN)
    assert (shown["title"], shown["url"]) == ("Campus Mail", "/notices.html")


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
