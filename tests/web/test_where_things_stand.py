"""Layout that must not jump, break or be stretched: the header, the addresses of people, the axis of a robot's charge.

In a browser whose scrollbars take room, as on most desks."""

import re
from collections.abc import AsyncIterator
from datetime import timedelta
from itertools import pairwise
from typing import Any

import pytest
import pytest_asyncio
from playwright.async_api import Browser, Locator, Playwright, expect

from app.models import BatterySample, RobotRow, Role
from tests.web.looking import DESK, NARROW
from tests.web.mailroom_scene import Campus
from tests.web.test_robots import give_roles
from tests.web.visitor import Visitor
from web.make_pages import HEADS

pytestmark = pytest.mark.browser

LONG = "ada.von-lovelace_at_the.department.of.mathematics"
HEADER = """() => {
  const x = (where) => document.querySelector(where)?.getBoundingClientRect().x;
  return {brand: x(".brand img"), navigation: x("nav.pages a"), account: x(".account summary")};
}"""
DRAWN_FROM_TO = """(svg) => {
  const [all, drawn] = [svg, svg.querySelector(".charge")].map((one) => one.getBoundingClientRect());
  return [(drawn.left - all.left) / all.width, (drawn.right - all.left) / all.width];
}"""
MINUTE, HOUR = timedelta(minutes=1), timedelta(hours=1)
SCROLLS = "() => document.documentElement.scrollHeight > document.documentElement.clientHeight"
LINES = """(owner) => {
  const walker = document.createTreeWalker(owner, NodeFilter.SHOW_TEXT);
  const lines = [];
  let top = null;
  for (let node = walker.nextNode(); node; node = walker.nextNode())
    for (let i = 0; i < node.data.length; i += 1) {
      const range = document.createRange();
      range.setStart(node, i);
      range.setEnd(node, i + 1);
      const box = range.getBoundingClientRect();
      if (!box.width) continue;
      if (top === null || box.top > top + box.height / 2) lines.push("");
      top = box.top;
      lines[lines.length - 1] += node.data[i];
    }
  return lines;
}"""
COPIED = """(owner) => {
  getSelection().selectAllChildren(owner);
  return getSelection().toString();
}"""


@pytest_asyncio.fixture(scope="module", loop_scope="session")
async def chromium(playwright_here: Playwright, browser_type_launch_args: dict[str, Any]) -> AsyncIterator[Browser]:
    """Without a window it hides scrollbars unless it is told not to."""
    shown = {**browser_type_launch_args, "ignore_default_args": ["--hide-scrollbars"]}
    browser = await playwright_here.chromium.launch(**shown)
    yield browser
    await browser.close()


async def staff(campus: Campus, visit: Any, **options: Any) -> Visitor:
    dana: Visitor = await visit("dana.desk", at=campus.service, **options)
    await give_roles(campus.service, dana.email, Role.DISPATCHER, Role.MAINTAINER)
    return dana


@pytest.mark.parametrize("size", [DESK, NARROW], ids=["desk", "phone"])
@pytest.mark.nightly
async def test_the_header_stands_at_the_same_place_on_every_page(quiet_campus, visit, size):
    dana = await staff(quiet_campus, visit, viewport=size)
    order_id = await dana.order("bob.martin@campus.example")
    more = {"follow": f"?order={order_id}"}
    places, long = {}, set[bool]()
    for name in sorted(HEADS.keys() - {"one-order"}):  # which is for people without an account, and leads nowhere
        await dana.page.goto(f"/{name}.html{more.get(name, '')}")
        await expect(dana.page.get_by_role("heading", level=1)).to_be_visible()
        places[name] = await dana.page.evaluate(HEADER)
        long.add(await dana.page.evaluate(SCROLLS))
    assert None not in places["index"].values()
    assert places == dict.fromkeys(places, places["index"])
    assert long == {True, False}, "some of them scroll"


@pytest.mark.parametrize(
    ("told_for", "shown"), [(45 * MINUTE, 45 * MINUTE), (26 * HOUR, 24 * HOUR)], ids=["new", "old"]
)
@pytest.mark.nightly
async def test_the_axis_of_a_robots_charge_begins_where_there_is_something_to_draw(
    quiet_campus, visit, told_for, shown
):
    """A day is asked for; a robot that is new has less to tell."""
    name, now = f"r{told_for // MINUTE}", quiet_campus.scene.clock.utc()
    async with quiet_campus.scene.state.database.transaction() as session:
        session.add(RobotRow(name=name, enrolled_at=now, server_journal=name, post="post5", battery_ratio=0.5))
        await session.flush()
        for minute in range(told_for // MINUTE + 1):
            sample = {"ratio": 0.2 + minute / 2000, "charging": False}
            session.add(BatterySample(robot=name, at=now - minute * MINUTE, **sample))
    dana = await staff(quiet_campus, visit, timezone_id="UTC")
    await dana.page.goto(f"/robots.html?robot={name}")
    ends = dana.page.locator(".battery .ends span")
    await expect(ends).to_have_count(2)
    for text, at in zip(await ends.all_inner_texts(), (now - shown, now), strict=True):
        asked_for_within = {f"{at + n * MINUTE:%-I:%M}" for n in range(3)}
        assert re.search(r"\d+:\d\d", text)[0] in asked_for_within
        assert (f"{at:%b %-d}" in text.replace("\xa0", " ")) == (at.date() < now.date())
    left, right = await dana.page.locator("svg.curve").evaluate(DRAWN_FROM_TO)
    assert left < 0.02
    assert right > 0.98


async def breaks_well(where: Locator, email: str) -> None:
    """It takes several lines, each but the last of which ends at a sign or before one; and it is copied as it is."""
    lines = await where.evaluate(LINES)
    assert "".join(lines) == email
    assert len(lines) > 1, "else this tells nothing"
    assert [line for line, below in pairwise(lines) if line[-1] not in "@._+-" and below[0] != "@"] == []
    assert await where.evaluate(COPIED) == email


@pytest.mark.nightly
async def test_an_address_breaks_at_its_signs_wherever_it_stands_and_is_copied_whole(quiet_campus, visit):
    ada = await visit(LONG, at=quiet_campus.service, on="phone", viewport=NARROW)
    bob = await visit("bob.martin", at=quiet_campus.service)
    page, porter = ada.page, f"porter.{LONG}@campus.example"
    await ada.put(f"/me/contacts/{porter}", {"label": "The porter"})
    order_id = await bob.order(ada.email)
    await ada.name_delegate(order_id, porter)

    await page.goto(f"/follow.html?order={order_id}")
    of_parties = page.locator(".details .address")
    await expect(of_parties).to_have_count(2)
    await breaks_well(of_parties.last, ada.email)
    await page.get_by_text("Let another person meet the robot").click()
    await breaks_well(page.locator("order-delegates .address"), porter)
    await page.locator(".account summary").click()
    await breaks_well(page.locator(".account .address"), ada.email)

    await page.goto("/settings.html")
    await breaks_well(page.locator("my-delegates .address"), porter)
    await breaks_well(page.locator("my-contacts li", has_text="The porter").locator(".address"), porter)

    await page.goto("/")
    await page.get_by_role("combobox", name="Recipient’s email").focus()
    await breaks_well(page.get_by_role("option", name="The porter").locator(".address"), porter)
