"""The pages of dispatchers, maintainers and people without account, in every state that they come upon."""

import re
from typing import Any

from playwright.async_api import Route, expect

from tests.web.states import LEAVE_AND_COME_BACK, LONG, States, stands
from tests.web.visitor import Visitor

OPEN_ALL = "(page) => page.querySelectorAll('details').forEach((one) => (one.open = true))"
NOTHING = {"items": [], "next": None}


async def dispatching(dana: Visitor) -> States:
    """Where something of each kind is wrong."""
    page = dana.page
    await stands(page, "/mailroom.html")
    wrong = page.get_by_role("region", name="Issues")
    await expect(wrong.get_by_role("listitem")).to_have_count(6)
    yield "mailroom, all kinds of things wrong"
    for action in ("Decide", "Unlock digits", "Resume"):
        await wrong.get_by_role("button", name=re.compile(f"^{action}")).click()
        await expect(page.get_by_role("dialog")).to_be_visible()
        yield f"mailroom, asked: {action}"
        await page.keyboard.press("Escape")
    await page.get_by_role("button", name=re.compile("^Recall")).first.click()
    await page.keyboard.press("Enter")
    await expect(page.get_by_text("Enter a reason")).to_be_visible()
    yield "mailroom, a reason missing"
    await page.keyboard.press("Escape")
    await page.get_by_role("button", name=re.compile("^Act.*Contract|^Actions")).last.click()
    await expect(page.get_by_role("dialog")).to_be_visible()
    yield "mailroom, what can be done with an order"
    await page.keyboard.press("Escape")
    await page.get_by_role("searchbox").fill("no such name")
    await expect(page.get_by_text("No matching orders.")).to_be_visible()
    yield "mailroom, nothing found"


async def working_at_the_desk(dana: Visitor) -> States:
    page = dana.page
    await stands(page, "/mailroom.html")
    await page.get_by_role("button", name="Order at the desk").click()
    await page.get_by_role("button", name="Place order").click()
    await expect(page.get_by_text("Enter the sender.")).to_be_visible()
    await page.get_by_role("combobox", name="Sender").press_sequentially("grace")
    await expect(page.get_by_role("dialog").get_by_role("listbox")).to_be_visible()
    yield "an order at the desk, refused, people offered"
    await page.keyboard.press("ArrowDown")
    await page.keyboard.press("Enter")
    await page.get_by_role("combobox", name="Recipient").fill("carl.sagan@campus.example")
    await page.get_by_role("dialog").get_by_label("From").select_option("Post 1")
    await page.get_by_role("dialog").get_by_label("To", exact=True).select_option("Post 4")
    await page.get_by_role("button", name="Place order").click()
    await expect(page.get_by_role("heading", name="Ordered")).to_be_visible()
    yield "an order at the desk, ordered"
    await page.keyboard.press("Escape")
    await page.get_by_role("button", name="Unsent mail").click()
    letters = page.get_by_role("dialog").locator(".letter")
    await expect(letters.first).to_be_visible()
    yield "unsent mail"
    await letters.first.click()
    await expect(page.locator("pre.mail")).to_be_visible()
    yield "unsent mail, being read"
    await page.keyboard.press("Escape")
    await page.get_by_role("button", name="Export").click()
    await page.get_by_label("Last day").fill("2020-01-01")
    await expect(page.get_by_text("The last day is before the first.")).to_be_visible()
    yield "export, refused"


async def on_a_quiet_day(dana: Visitor) -> States:
    page = dana.page

    async def tell_nothing(route: Route) -> None:
        await route.fulfill(json=[] if re.search("/robots$", route.request.url) else NOTHING)

    await page.route(re.compile(r"/api/v1/(robots|orders|alarms|outbox|notices/unsent)(\?|$)"), tell_nothing)
    await stands(page, "/mailroom.html")
    await expect(page.get_by_text("Nothing in progress.")).to_be_visible()
    yield "mailroom, all is well"
    await stands(page, "/robots.html")
    await expect(page.get_by_text("No robots enrolled yet.")).to_be_visible()
    yield "robots, none"
    await page.unroute_all()


async def printing(dana: Visitor, order_id: str) -> States:
    page = dana.page
    await stands(page, "/print.html")
    await expect(page.get_by_role("button", name="Print 9 sheets")).to_be_visible()
    yield "print, marker sheets"
    await stands(page, f"/print.html?order={order_id}")
    await expect(page.get_by_role("article", name="Mail slip")).to_be_visible()
    yield "print, a slip"
    await stands(page, "/mailroom.html?wall")
    await expect(page.get_by_role("region", name=re.compile("^In progress"))).to_be_visible()
    yield "mailroom on a wall"


async def keeping_robots(mira: Visitor, away: str, connected: str) -> States:
    """Of the two robots one is away; the other is connected, and sends diagnostics once watched."""
    page = mira.page
    await stands(page, "/robots.html")
    await expect(page.get_by_role("link", name=re.compile(f"Robot {away}"))).to_be_visible()
    yield "robots"
    await stands(page, f"/robots.html?robot={away}")
    await expect(page.get_by_text("No battery readings in this period.")).to_be_visible()
    yield "a robot that is away"
    await stands(page, f"/robots.html?robot={connected}")
    await expect(page.get_by_text("Live from the robot")).to_be_visible()
    yield "a robot, watched"
    await page.get_by_role("button", name="Pause updates").click()
    await page.locator("robot-page").evaluate(OPEN_ALL)
    await page.get_by_role("button", name="Create one-time code").click()
    await expect(page.get_by_text(re.compile("^Enter this on robot"))).to_be_visible()
    yield "a robot, all opened, a one-time code shown"
    await page.get_by_role("button", name="Recall", exact=True).click()
    await expect(page.get_by_role("dialog")).to_be_visible()
    yield "a robot, asked whether it comes back"


async def by_a_link(guest: Visitor, link: str) -> States:
    page = guest.page
    guest.refusals_expected.add("/api/v1/link/order")
    await stands(page, link)
    await expect(page.get_by_role("img", name="QR code for the robot’s camera")).to_be_visible()
    order: dict[str, Any] = await page.evaluate("() => document.querySelector('one-order').order")
    await page.get_by_text("Enter six digits instead").click()
    await page.get_by_text("Let another person meet the robot").click()
    await page.get_by_label("Their name").fill(LONG)
    yield "one order, the robot is here"
    await page.get_by_role("button", name="I can’t take it now").click()
    yield "one order, asked whether it goes back"
    await page.keyboard.press("Escape")
    async with guest.without_network():
        await page.evaluate(LEAVE_AND_COME_BACK)
        await page.evaluate("() => Object.assign(document.querySelector('one-order'), { unreached: true })")
        yield "one order, no network"
    for state in ("carrying", "delivered"):
        told = {**order, "state": state, "my_code": "receive" if state == "carrying" else None}
        await page.evaluate("(order) => Object.assign(document.querySelector('one-order'), { order })", told)
        await expect(page.locator(f".standing.{state}")).to_be_visible()
        yield f"one order, {state}"
    await page.goto("about:blank")
    await page.goto("/one-order.html#" + "x" * 43)
    await expect(page.get_by_role("heading", name="This link no longer works")).to_be_visible()
    yield "one order, refused"
