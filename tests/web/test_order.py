"""Ordering a letter."""

import asyncio
import re
import zlib
from collections.abc import AsyncIterator, Awaitable, Callable

import pytest
import pytest_asyncio
from playwright.async_api import Page, Route, expect

from protocol.parts import Battery
from tests.web.service import Service
from tests.web.visitor import Visitor

pytestmark = pytest.mark.browser

BOB = "bob.martin@campus.example"
PLACE = "(element) => [element.getBoundingClientRect().top + scrollY, element.offsetHeight]"


async def fill(page: Page, recipient: str = BOB, from_post: str = "Post 1", to_post: str = "Post 4", what: str = ""):
    await page.get_by_label("From").select_option(from_post)
    await page.get_by_label("To", exact=True).select_option(to_post)
    await page.get_by_label("Recipient’s email").fill(recipient)
    await page.get_by_label("Contents").fill(what)


async def send(page: Page):
    await page.get_by_role("button", name="Send the robot").click()


@pytest_asyncio.fixture(loop_scope="session")
async def there(
    service: Service, request: pytest.FixtureRequest
) -> AsyncIterator[Callable[[Visitor], Awaitable[None]]]:
    """A robot is connected, with too little charge to be given anything; to be awaited until the service knows."""
    name = f"r{zlib.crc32(request.node.name.encode())}"
    async with service.connected(name, battery=Battery(ratio=0.1)):

        async def is_known(to: Visitor) -> None:
            while (await to.api("/estimate?from_post=post1&to_post=post4"))["reason"]:  # noqa: ASYNC110  # over HTTP
                await asyncio.sleep(0.1)

        yield is_known


async def test_who_orders_while_no_robot_can_come_reads_so_instead_of_a_time(visit):
    ada = await visit("ada.king", on="phone")
    await ada.page.goto("/")
    button = ada.page.get_by_role("button", name="Send the robot")
    await expect(ada.page.get_by_text("Choose both posts to see the arrival time.")).to_be_visible()
    place = await button.evaluate(PLACE)
    await fill(ada.page)
    told = ada.page.locator(".estimate")
    await expect(told).to_contain_text("The arrival time is not known yet.")
    await expect(told).to_contain_text("No robot is connected at the moment.")
    assert await button.evaluate(PLACE) == place, "nothing moves under a finger"


async def test_the_time_of_arrival_is_shown_as_an_assumption_before_anything_is_ordered(visit, there):
    ada = await visit("ada.king", on="phone")
    await there(ada)
    await ada.page.goto("/")
    await expect(ada.page.get_by_text("Choose both posts to see the arrival time.")).to_be_visible()
    button = ada.page.get_by_role("button", name="Send the robot")
    place = await button.evaluate(PLACE)
    await fill(ada.page)
    await expect(ada.page.get_by_role("status").get_by_text(re.compile("Arrives"))).to_be_visible()
    await expect(ada.page.get_by_text("Estimated from the map’s 6 m; no measured trips yet.")).to_be_visible()
    assert await button.evaluate(PLACE) == place, "nothing moves under a finger"
    time = ada.page.locator(".estimate strong")
    await time.evaluate("time => (time.textContent = '11:58 a.m. – 12:04 p.m.')")
    fits = "({ parentElement: box }) => box.scrollWidth <= box.clientWidth"
    assert await time.evaluate(fits), "the time of day that takes most room has room"
    assert await button.evaluate(PLACE) == place
    assert (await ada.api("/orders"))["items"] == []


@pytest.mark.parametrize("device", ["phone", "desk"])
async def test_an_ordered_letter_is_followed_at_once_and_stands_in_my_mail(visit, device):
    ada = await visit("ada.king", on=device)
    page = ada.page
    await page.goto("/")
    await fill(page, what="Signed forms")
    await send(page)
    await expect(page.get_by_role("heading", name="Looking for a robot")).to_be_visible()
    await expect(page.get_by_text("The arrival time is not known yet.")).to_be_visible()
    await expect(page.get_by_text("No robot is connected at the moment.")).to_be_visible()
    await expect(page.get_by_text("No robot is assigned to this order yet.")).to_be_visible()
    await page.get_by_role("link", name="My mail").click()
    sent = page.get_by_role("region", name="Sent")
    await expect(
        sent.get_by_role("link", name=re.compile("Signed forms.*Ordered|Ordered.*Signed forms"))
    ).to_be_visible()


@pytest.mark.parametrize("address", ["/", "/follow.html"], ids=["typed", "repeated by a link"])
@pytest.mark.parametrize("is_kept", [True, False], ids=["page kept by the browser", "page opened anew"])
@pytest.mark.nightly
async def test_going_back_after_ordering_offers_nothing_that_one_tap_orders_twice(visit, address, is_kept):
    ada = await visit()
    page = ada.page
    if not is_kept:
        await page.add_init_script("addEventListener('unload', () => undefined)")  # no browser keeps such a page
    if address == "/":
        await page.goto("/")
        await fill(page, what="Keys")
    else:
        await page.goto(f"/follow.html?order={await ada.order(BOB)}")
        await page.get_by_role("button", name="Cancel this order").click()
        await page.get_by_role("dialog").get_by_role("button", name="Yes, cancel it").click()
        await page.get_by_role("link", name="Send another one").click()
        await expect(page.get_by_label("Recipient’s email")).to_have_value(BOB)
    await send(page)
    await expect(page.get_by_role("heading", name="Looking for a robot")).to_be_visible()
    before = len((await ada.api("/orders"))["items"])
    await page.go_back()
    await expect(page.get_by_role("heading", name="Send a letter")).to_be_visible()
    await expect(page.get_by_label("Recipient’s email")).to_have_value("")
    await send(page)
    await expect(page.locator("[aria-invalid=true]").first).to_be_visible()
    assert len((await ada.api("/orders"))["items"]) == before


@pytest.mark.nightly
async def test_the_same_post_twice_is_refused_at_the_field(visit, there):
    ada = await visit()
    await there(ada)
    ada.refusals_expected.add("/api/v1/orders")
    await ada.page.goto("/")
    await fill(ada.page, to_post="Post 1")
    await send(ada.page)
    to = ada.page.get_by_label("To", exact=True)
    await expect(to).to_have_accessible_description(re.compile("Choose two different posts"))
    await expect(to).to_be_focused()
    await to.select_option("Post 2")
    await expect(to).to_have_accessible_description("")
    await expect(ada.page.get_by_text(re.compile("Arrives"))).to_be_visible()


async def test_an_unknown_recipient_is_refused_at_the_field(visit):
    ada = await visit()
    ada.refusals_expected.add("/api/v1/orders")
    await ada.page.goto("/")
    await fill(ada.page, recipient="eve@elsewhere.example")
    await send(ada.page)
    recipient = ada.page.get_by_label("Recipient’s email")
    await expect(recipient).to_have_accessible_description(re.compile("This address is unknown"))
    await expect(recipient).to_be_focused()


async def test_an_empty_form_says_what_is_missing_and_sends_no_request(visit):
    ada = await visit()
    await ada.page.goto("/")
    await send(ada.page)
    for words in ("Choose where the robot picks it up.", "Choose where it goes.", "Enter the recipient."):
        await expect(ada.page.get_by_text(words)).to_be_visible()
    await expect(ada.page.get_by_label("From")).to_be_focused()


async def test_a_letter_is_ordered_with_the_keyboard_alone(visit):
    ada = await visit()
    page = ada.page
    await page.goto("/")
    await expect(page.get_by_role("heading", name="Send a letter")).to_be_visible()
    await page.get_by_label("From").focus()
    for keys in (["Post 1", "Tab"], ["Post 4", "Tab"], [BOB, "Tab"], ["Keys", "Enter"]):
        await page.keyboard.type(keys[0])
        await page.keyboard.press(keys[1])
    await expect(page.get_by_role("heading", name="Looking for a robot")).to_be_visible()


async def test_a_double_tap_is_one_order(visit):
    ada = await visit(on="phone")
    await ada.page.goto("/")
    await fill(ada.page)
    await ada.page.get_by_role("button", name="Send the robot").dblclick()
    await expect(ada.page.get_by_role("heading", name="Looking for a robot")).to_be_visible()
    assert len((await ada.api("/orders"))["items"]) == 1


@pytest.mark.slow
async def test_an_answer_that_is_lost_is_asked_for_again_and_nothing_is_ordered_twice(visit):
    ada = await visit()
    ada.loses_answers = True
    keys = []

    async def lose_the_first_answer(route: Route) -> None:
        keys.append(route.request.headers["idempotency-key"])
        answer = await route.fetch()
        await (route.abort() if len(keys) == 1 else route.fulfill(response=answer))

    await ada.page.route(re.compile("/api/v1/orders$"), lose_the_first_answer)
    await ada.page.goto("/")
    await fill(ada.page)
    await send(ada.page)
    await expect(ada.page.get_by_role("heading", name="Looking for a robot")).to_be_visible()
    assert len(keys) == 2 and len(set(keys)) == 1
    assert len((await ada.api("/orders"))["items"]) == 1


@pytest.mark.slow
async def test_an_order_without_any_answer_is_kept_and_sent_again_with_its_key_after_a_reload(visit):
    ada = await visit()
    ada.loses_answers = True
    page = ada.page
    keys = []

    async def lose(route: Route) -> None:
        keys.append(route.request.headers["idempotency-key"])
        await route.fetch()
        await route.abort()

    await page.goto("/")
    await fill(page, what="Keys")
    await page.route(re.compile("/api/v1/orders$"), lose)
    await send(page)
    kept = page.get_by_role("region", name="Saved on this device")
    await expect(kept.get_by_text("Will be sent once, as soon as you are back online.")).to_be_visible()
    async with page.expect_request(re.compile("/api/v1/orders$")) as sent:  # before the reload, or because of it
        await page.unroute_all(behavior="wait")  # one that is on its way would go to the service beside the next
        await page.reload()
    assert {(await sent.value).headers["idempotency-key"]} == set(keys)
    await kept.get_by_role("link", name="Track").click()
    await expect(page.get_by_role("heading", name="Looking for a robot")).to_be_visible()
    assert len((await ada.api("/orders"))["items"]) == 1


@pytest.mark.slow
async def test_a_repeat_takes_three_taps(visit, there):
    ada = await visit()
    await there(ada)
    await ada.order(BOB, to_post="post3", what="First")
    page = ada.page
    await page.goto("/")
    await page.get_by_role("button", name=re.compile("^Bob Martin")).click()
    await expect(page.get_by_label("From")).to_have_value("post1")
    await expect(page.get_by_label("To", exact=True)).to_have_value("post3")
    await expect(page.get_by_label("Recipient’s email")).to_have_value(BOB)
    await expect(page.get_by_text(re.compile("Arrives"))).to_be_visible()
    await send(page)
    await expect(page.get_by_role("heading", name="Looking for a robot")).to_be_visible()


async def test_an_order_is_cancelled_after_asking_once(visit):
    ada = await visit()
    order_id = await ada.order(BOB)
    page = ada.page
    await page.goto(f"/follow.html?order={order_id}")
    await page.get_by_role("button", name="Cancel this order").click()
    await page.get_by_role("button", name="Keep it").click()
    await page.get_by_role("button", name="Cancel this order").click()
    await page.get_by_role("dialog").get_by_role("button", name="Yes, cancel it").click()
    await expect(page.get_by_role("heading", name="Cancelled")).to_be_visible()
    await expect(page.get_by_role("button", name="Cancel this order")).to_be_hidden()
    await page.get_by_role("link", name="Send another one").click()
    await expect(page.get_by_label("Recipient’s email")).to_have_value(BOB)


async def test_an_order_of_others_is_not_here(visit):
    ada, eve = await visit("ada.king"), await visit("eve")
    order_id = await ada.order(BOB)
    eve.refusals_expected.add(f"/api/v1/orders/{order_id}")
    await eve.page.goto(f"/follow.html?order={order_id}")
    await expect(eve.page.get_by_role("heading", name="Letter not found")).to_be_visible()
    await expect(eve.page.get_by_text("or you don’t have access to it")).to_be_visible()


async def test_a_recipient_is_chosen_from_those_one_knows_with_the_keyboard(visit):
    ada = await visit()
    page = ada.page
    for name in ("bob.martin", "bea.lund", "cleo.wong"):
        await ada.order(f"{name}@campus.example")
    await ada.put("/me/contacts/bea.lund@campus.example", {"label": "Bea next door", "post": "post2"})
    await page.goto("/")
    recipient = page.get_by_role("combobox", name="Recipient’s email")
    await recipient.focus()
    offers = page.get_by_role("listbox", name="People you know").get_by_role("option")
    await expect(offers).to_have_count(3)
    await page.keyboard.type("b")
    await expect(offers).to_have_count(2)
    await expect(page.get_by_text("2 people you know")).to_have_count(1)
    await page.keyboard.press("ArrowDown")
    await expect(recipient).to_have_attribute("aria-activedescendant", "contact-offers-0")
    await expect(offers.first).to_have_attribute("aria-selected", "true")
    await ada.assert_accessible()
    await page.keyboard.press("Escape")
    await expect(offers).to_have_count(0)
    await page.keyboard.type("ea")
    await expect(offers).to_have_text([re.compile("Bea next door")])
    await page.keyboard.press("ArrowUp")
    await page.keyboard.press("Enter")
    await expect(recipient).to_have_value("bea.lund@campus.example")
    await expect(page.get_by_label("To", exact=True)).to_have_value("post2")  # where they are found


async def test_a_letter_is_ordered_for_later_and_again_and_again(visit, there):
    ada = await visit(on="phone", timezone_id="America/Toronto")
    await there(ada)
    page = ada.page
    await page.goto("/")
    await fill(page, what="Later")
    window = page.locator(".estimate strong")
    now = await window.inner_text()
    await page.get_by_role("radio", name="Later").check()
    await page.get_by_label("Not before").fill("2027-05-03T09:30")
    await expect(window).not_to_have_text(now)
    await expect(window).to_contain_text("May 3, 9:3")
    await page.get_by_role("button", name="Schedule the robot").click()
    await expect(page.get_by_role("heading", level=1)).to_have_text("Scheduled for later")
    await expect(page.locator(".standing .window")).to_contain_text("May 3, 9:3")
    assert (await ada.api("/orders"))["items"][0]["not_before"] == "2027-05-03T13:30:00Z"

    await page.goto("/")
    await fill(page, what="Payroll")
    await page.get_by_role("radio", name="Repeat").check()
    days = page.get_by_role("group", name="Days").get_by_role("checkbox")
    await expect(days).to_have_count(7)
    for day in await days.all():
        await day.uncheck()
    await page.get_by_role("button", name="Schedule repeats").click()
    await expect(page.get_by_text("Choose a time.")).to_be_visible()
    await page.get_by_role("checkbox", name="Monday").check()
    await page.get_by_label("Time", exact=True).fill("08:15")
    await ada.assert_accessible()
    await page.get_by_role("button", name="Schedule repeats").click()
    payroll = page.get_by_role("region", name="Repeat").get_by_role("listitem")
    await expect(payroll).to_contain_text("every Monday at 8:15 a.m.")


async def test_a_newcomer_is_told_how_it_works_until_they_have_understood(visit):
    ada = await visit(on="phone", locale="fr-CA")
    page = ada.page
    await page.goto("/")
    steps = page.get_by_role("region", name="Comment ça marche")
    await expect(steps.get_by_role("listitem")).to_have_count(3)
    await ada.assert_accessible()
    await steps.get_by_role("button", name="Compris").click()
    await expect(steps).to_be_hidden()
    await page.reload()
    await expect(page.get_by_label("De", exact=True)).to_be_visible()
    await expect(steps).to_be_hidden()
    await page.locator("summary").first.click()
    await page.get_by_role("link", name="Comment ça marche").click()
    await expect(steps).to_be_visible()
    await page.get_by_text("Que signifie cette heure").click()
    await expect(page.get_by_text(re.compile("entre ces deux heures"))).to_be_visible()
