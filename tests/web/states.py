"""The pages of everybody, in every state that they come upon: each function leads through some and names them."""

import re
from collections.abc import AsyncIterator
from typing import Any

from playwright.async_api import Page, Route, expect

from tests.web.visitor import Visitor

States = AsyncIterator[str]

BOB = "bob.martin@campus.example"
LONG = "A very long description-without-any-space-in-a-good-part-of-it"
LEAVE_AND_COME_BACK = """() => {
  dispatchEvent(new Event("pagehide"));
  dispatchEvent(new PageTransitionEvent("pageshow", { persisted: true }));
}"""
NEW_VERSION = "() => dispatchEvent(new CustomEvent('new-version', { detail: { take: () => undefined } }))"
OFFER_TO_INSTALL = "() => dispatchEvent(new Event('beforeinstallprompt', { cancelable: true }))"


async def stands(page: Page, address: str, one_moment: str = "Loading") -> None:
    """Until there is more than a promise of it."""
    await page.goto(address)
    await expect(page.get_by_role("heading", level=1)).to_be_visible()
    await expect(page.get_by_text(one_moment)).to_be_hidden()


async def signing_in(ada: Visitor) -> States:
    page = ada.page
    ada.refusals_expected |= {"/api/v1/sign-in", "/api/v1/sign-in/codes"}
    await stands(page, "/")
    yield "sign-in"
    await page.get_by_label("Email address").fill("eve@elsewhere.example")
    await page.keyboard.press("Enter")
    await expect(page.get_by_text(re.compile("Use your campus address"))).to_be_visible()
    yield "sign-in, another address refused"
    await page.get_by_label("Email address").fill(ada.email)
    await page.keyboard.press("Enter")
    await page.get_by_label("Code from the email").fill("12345678")
    await page.keyboard.press("Enter")
    await expect(page.get_by_text(re.compile("Wrong code"))).to_be_visible()
    yield "sign-in, wrong code"
    async with ada.without_network():
        await page.goto("/")
        await expect(page.get_by_role("heading", name="Campus Mail is not responding")).to_be_visible()
        yield "a service that does not answer"


async def ordering(ada: Visitor) -> States:
    page = ada.page
    await stands(page, "/")
    await expect(page.get_by_role("region", name="How it works")).to_be_visible()
    yield "order, for a newcomer"
    await page.get_by_role("button", name="Send the robot").click()
    await expect(page.get_by_text("Enter the recipient.")).to_be_visible()
    await page.get_by_role("radio", name="Later").check()
    yield "order, refused, later"
    await page.get_by_role("radio", name="Repeat").check()
    await expect(page.get_by_role("checkbox", name="Monday")).to_be_visible()
    yield "order, again and again"
    for name in ("bob.martin", "bea.lund", "cleo.wong", "deniz.arslan"):
        await ada.order(f"{name}@campus.example", what=LONG)
    await expect(page.get_by_role("button", name="Dismiss")).to_be_visible()
    yield "order, told of something"
    await stands(page, "/")
    await page.get_by_label("From").select_option("Post 1")
    await page.get_by_label("To", exact=True).select_option("Post 4")
    await expect(page.get_by_text(re.compile("Arrives"))).to_be_visible()
    await page.get_by_text("What does this time mean").click()
    yield "order, with others under way"
    await page.get_by_role("combobox", name="Recipient’s email").focus()
    await expect(page.get_by_role("listbox").get_by_role("option")).to_have_count(4)
    yield "order, people offered"
    await page.get_by_label("Recipient’s email").fill(BOB)
    await page.keyboard.press("Escape")
    await page.evaluate(OFFER_TO_INSTALL)
    await page.evaluate(NEW_VERSION)
    await page.locator(".account summary").click()
    await expect(page.get_by_role("button", name="Install as an app")).to_be_visible()
    yield "order, account sheet open, a new version"
    await page.locator(".account summary").click()
    async with ada.without_network():
        await page.evaluate(LEAVE_AND_COME_BACK)
        await page.get_by_role("button", name="Send the robot").click()
        await expect(page.get_by_role("region", name="Saved on this device")).to_be_visible()
        await expect(page.get_by_text(re.compile("^No connection"))).to_be_visible()
        yield "order, no connection, one kept"


async def reading_mail(ada: Visitor) -> States:
    page = ada.page
    await stands(page, "/mail.html")
    await expect(page.get_by_text("Nothing is on its way to you.")).to_be_visible()
    await expect(page.get_by_role("heading", name="Repeat")).to_be_visible()
    yield "my mail, empty"
    every = {"weekdays": [0, 2, 4], "at": "09:30", "zone": "America/Toronto"}
    await ada.post("/standing-orders", {"from_post": "post1", "to_post": "post4", "recipient": BOB, **every})
    await ada.post(f"/orders/{await ada.order(BOB, what=LONG)}/cancel")
    for _ in range(21):
        await ada.order(BOB)
    await ada.order(ada.email, what="To myself")
    await stands(page, "/mail.html")
    await expect(page.get_by_role("button", name="Show older")).to_be_visible()
    await expect(page.get_by_role("button", name=re.compile("^End"))).to_be_visible()
    yield "my mail, full"
    await page.get_by_role("button", name=re.compile("^End")).click()
    yield "my mail, asked whether a standing order ends"
    await page.keyboard.press("Escape")
    await page.get_by_role("searchbox").fill("no such name")
    await expect(page.get_by_text("0 letters found")).to_be_visible()
    yield "my mail, nothing found"


async def reading_notices(ada: Visitor) -> States:
    page = ada.page
    await stands(page, "/notices.html")
    await expect(page.locator(".empty")).to_be_visible()
    yield "notices, none"
    await ada.post(f"/orders/{await ada.order(BOB, what=LONG)}/cancel")
    await expect(page.get_by_role("button", name="Mark all as read")).to_be_visible()
    yield "notices, unread"
    await page.get_by_role("button", name="Mark all as read").click()
    await expect(page.get_by_role("button", name="Mark all as read")).to_be_hidden()
    yield "notices, read"


# What differs to the eye; tests/web/test_follow.py has all of them, in words.
OF_SENDER = ("queued", "to_sender", "at_sender", "carrying", "delivered", "at_return", "held", "cancelled", "attention")
CODES = {"sender": {"at_sender": "load", "at_return": "return"}, "recipient": {"at_recipient": "receive"}}
OF_RECIPIENT = ("carrying", "at_recipient")


async def following(ada: Visitor, order_id: str) -> States:
    """The service's own order as it is at the robot; its other states as the service would tell them."""
    page, address = ada.page, f"/follow.html?order={order_id}"
    order: dict[str, Any] = await ada.api(f"/orders/{order_id}")

    async def tell(route: Route) -> None:
        await route.fulfill(json=order)

    await page.route(f"**/api/v1/orders/{order_id}", tell)
    await stands(page, address)
    for role, states in (("sender", OF_SENDER), ("recipient", OF_RECIPIENT)):
        for state in states:
            code = CODES[role].get(state)
            order |= {"my_role": role, "state": state, "version": order["version"] + 1, "my_code": code}
            await ada.asks_anew()
            await expect(page.locator(f".standing.{state}")).to_be_visible()
            yield f"follow, {role}, {state}"
    await page.unroute_all()


async def at_the_robot(ada: Visitor, order_id: str) -> States:
    page = ada.page
    await stands(page, f"/follow.html?order={order_id}")
    await expect(page.get_by_role("img", name="QR code for the robot’s camera")).to_be_visible()
    await page.get_by_text("Enter six digits instead").click()
    await page.get_by_label("Six digits").fill("12")
    await page.keyboard.press("Enter")
    await page.get_by_text("Let another person meet the robot").click()
    await page.get_by_label("Their name").fill("The porter of the old library building")
    await page.keyboard.press("Enter")
    await expect(page.get_by_role("img", name=re.compile("^Code for The porter"))).to_be_visible()
    await page.locator("campus-map summary").last.click()
    yield "follow, at the robot, digits refused, a delegate named"
    await page.get_by_role("button", name="Cancel this order").click()
    await expect(page.get_by_role("dialog")).to_be_visible()
    yield "follow, asked whether to cancel"
    await page.keyboard.press("Escape")
    async with ada.without_network():
        await page.evaluate(LEAVE_AND_COME_BACK)
        await expect(page.get_by_text(re.compile("^No connection"))).to_be_visible()
        yield "follow, no connection"
    unknown = "01ARZ3NDEKTSV4RRFFQ69G5FAV"
    ada.refusals_expected.add(f"/api/v1/orders/{unknown}")
    await page.goto(f"/follow.html?order={unknown}")
    await expect(page.get_by_role("heading", name="Letter not found")).to_be_visible()
    yield "follow, not here"
    await stands(page, "/mailroom.html")
    yield "a page for others"


async def settling(ada: Visitor) -> States:
    page = ada.page
    ada.refusals_expected |= {"/api/v1/me/webhook"}
    await ada.put("/me/contacts/bea.lund@campus.example", {"label": "Bea next door", "post": "post2"})
    await ada.name_delegate(await ada.order(BOB, what=LONG), "porter.of.the.old.library@campus.example")
    await stands(page, "/settings.html")
    take_back = page.get_by_role("button", name="Revoke, The porter")
    await expect(take_back).to_be_visible()
    tokens = page.get_by_role("region", name="Access tokens")
    await expect(tokens.get_by_role("button", name="Create token")).to_be_visible()
    yield "settings"
    await tokens.get_by_role("button", name="Create token").click()
    await expect(tokens.get_by_role("alert")).to_be_visible()
    await take_back.click()
    await expect(page.get_by_text(re.compile("^No delegates"))).to_be_visible()
    await page.get_by_role("button", name="Change, Bea next door").click()
    hook = page.get_by_role("region", name="Webhook")
    await hook.get_by_label("URL").fill("https://127.0.0.1/told")
    await hook.get_by_role("button", name="Save webhook").click()
    await expect(hook.get_by_role("alert")).to_be_visible()
    yield "settings, refused"
    await tokens.get_by_label("What it is for").fill("Night report")
    await tokens.get_by_role("checkbox").first.check()
    await tokens.get_by_role("button", name="Create token").click()
    await expect(tokens.get_by_role("group", name=re.compile("^Your new token"))).to_be_visible()
    yield "settings, a token shown once"
