"""Free text stays within the page and does not reorder it, at any length and in either direction of writing."""

import re
from collections.abc import AsyncIterator
from typing import Final

import pytest
import pytest_asyncio
from playwright.async_api import Locator, Page, expect

from tests.web.mailroom_scene import Campus
from tests.web.service import Service
from tests.web.visitor import Visitor

pytestmark = pytest.mark.browser

NARROW: Final = {"viewport": {"width": 320, "height": 720}}
LONG: Final = "W" * 190
LONG_NAME: Final = "M" * 80
HEBREW: Final = "דנה כהן"
ARABIC: Final = "فاطمة"
OUTSIDE: Final = """() => {
  const wide = document.documentElement.clientWidth, found = [];
  const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let text; (text = texts.nextNode()); ) {
    if (!/\\w/.test(text.data) || text.parentElement.closest(".unseen, script, noscript, .mail")) continue;
    const range = document.createRange();
    range.selectNode(text);
    const inList = text.parentElement.closest(".orders, .sections") !== null; // which is pushed sideways by itself
    const out = [...range.getClientRects()].some(({left, right, width}) =>
      width > wide || (!inList && width > 1 && (right > wide + 1 || left < -1)));
    if (out && text.parentElement.checkVisibility()) found.push(text.data.slice(0, 40));
  }
  const sideways = document.documentElement.scrollWidth - wide;
  return sideways > 0 ? [...found, `${sideways} px to scroll`] : found;
}"""
PLACES: Final = """(element, words) => {
  const texts = document.createTreeWalker(element, NodeFilter.SHOW_TEXT), letters = [];
  for (let text; (text = texts.nextNode()); ) for (let i = 0; i < text.data.length; i += 1) letters.push([text, i]);
  const line = letters.map(([text, i]) => text.data[i]).join("");
  const start = line.indexOf(words), digit = start + words.length + line.slice(start + words.length).search(/\\d/);
  return [[start, start + words.length - 1], [digit, digit]].map(([first, last]) => {
    const range = document.createRange();
    range.setStart(...letters[first]);
    range.setEnd(letters[last][0], letters[last][1] + 1);
    return range.getBoundingClientRect().toJSON();
  });
}"""


async def named(visitor: Visitor, name: str) -> Visitor:
    """The same person under another name."""
    answer = await visitor.context.request.patch(
        "/api/v1/me", data={"name": name}, headers={"Sec-Fetch-Site": "same-origin"}
    )
    assert answer.ok, await answer.text()
    return visitor


@pytest_asyncio.fixture(scope="module", loop_scope="session")
async def campus(tmp_path_factory: pytest.TempPathFactory) -> AsyncIterator[Campus]:
    with Service(tmp_path_factory.mktemp("texts")) as service:
        campus = Campus(service)
        campus.orders = await campus.scene.is_busy()
        yield campus


async def brought(campus: Campus, sender: Visitor, recipient: str, what: str) -> None:
    """A letter whose robot stands before its recipient, who is told."""
    way = (sender.email.partition("@")[0], recipient, "post1", "post4")
    await campus.scene.order("at_recipient", "r2", *way, what)


async def open_all(page: Page) -> None:
    """Everything that is folded up."""
    await page.evaluate("document.querySelectorAll('main details').forEach((one) => (one.open = true))")


@pytest.mark.nightly
async def test_one_word_of_190_letters_stays_within_every_page_that_shows_it(campus, visit):
    dana = await named(await campus.dispatcher(visit, **NARROW), LONG_NAME)
    order = await dana.order(dana.email, what=LONG)
    await brought(campus, dana, "grace.hopper", LONG)
    await dana.name_delegate(order, "porter@campus.example")
    wish = {"from_post": "post1", "to_post": "post4", "recipient": dana.email, "description": LONG}
    weekly = {"at": "09:30", "weekdays": [0, 2], "zone": "America/Toronto"}
    await dana.post("/standing-orders", {**wish, **weekly})
    await dana.put(f"/me/contacts/{dana.email}", {"label": LONG_NAME, "post": None})
    page = dana.page
    shown = 0
    for address in (
        *("/", f"/follow.html?order={order}", "/mail.html", "/notices.html", "/settings.html", "/mailroom.html"),
        *(
            "/mailroom.html?wall",
            f"/print.html?order={order}",
            campus.service.link_mailed_to("grace.hopper@campus.example"),
        ),
    ):
        await page.goto(address)
        await expect(page.get_by_role("heading").first).to_be_visible()
        await expect(page.get_by_text(re.compile(f"{LONG}|{LONG_NAME}")).first).to_be_attached()
        await open_all(page)
        shown += await page.get_by_text(LONG).count()
        assert await page.evaluate(OUTSIDE) == [], address
    assert shown >= 7
    await page.goto("/")
    form = await page.get_by_label("From").bounding_box()
    assert form and form["y"] < NARROW["viewport"]["height"], "the form stays on the first screen"
    await page.goto("/mailroom.html")
    await page.get_by_role("button", name=re.compile(f"^Act.*{LONG_NAME}")).first.click()
    await expect(page.get_by_role("dialog")).to_be_visible()
    assert await page.evaluate(OUTSIDE) == []


async def digits_stand_behind(element: Locator, words: str) -> None:
    """On the same line as the words before them and to their right, as in any sentence that runs from left to right."""
    await expect(element).to_contain_text(re.compile(f"{words}.*\\d"))
    name, digits = await element.evaluate(PLACES, words)
    assert abs(name["top"] - digits["top"]) < 8, "not on one line"
    assert digits["left"] >= name["right"], await element.inner_text()


@pytest.mark.parametrize("name", [HEBREW, ARABIC])
@pytest.mark.nightly
async def test_digits_beside_a_name_that_runs_from_right_to_left_stay_behind_it(campus, visit, name):
    ada = await named(await visit("ada", at=campus.service), name)
    bob = await named(await visit("bob", at=campus.service), name)
    order = await ada.order(bob.email, what="Keys")
    nameless = await ada.order(bob.email, what=f"{name} {name}")
    page = ada.page
    for which in (order, nameless):  # one that has ended says the time beside the name
        await ada.post(f"/orders/{which}/cancel")
    await page.goto("/mail.html")
    for which in (order, nameless):
        await digits_stand_behind(page.locator(f".order:has([href$='{which}']) .when"), name)
    about = page.locator(f".order:has([href$='{nameless}']) .who")
    assert await about.locator("bdi").evaluate("(one) => getComputedStyle(one).unicodeBidi") == "isolate"
    await page.goto(f"/follow.html?order={order}")
    await expect(page.locator("dl.details dd bdi").first).to_have_text(name)
    # What is told in a plain sentence, on pages and in mails.
    await brought(campus, ada, bob.email.partition("@")[0], "Keys")
    assert f"\u2068{name}\u2069" in campus.service.newest_mail_to(bob.email)
