"""Marks of orders where many stand together: late in words and with a drawing, low priority without a warning."""

from datetime import timedelta

import pytest
from playwright.async_api import Locator, expect

from app.models import Order, Priority
from tests.web.mailroom_scene import Scene

pytestmark = pytest.mark.browser

COLOURS = "(mark) => [getComputedStyle(mark).color, getComputedStyle(mark).backgroundColor]"
NEUTRAL = """() => {
  const probe = document.body.appendChild(document.createElement("span"));
  probe.style.color = "var(--ink-soft)";
  probe.style.backgroundColor = "var(--paper-low)";
  const {color, backgroundColor} = getComputedStyle(probe);
  probe.remove();
  return [color, backgroundColor];
}"""


async def colours(mark: Locator) -> list[str]:
    found: list[str] = await mark.evaluate(COLOURS)
    return found


@pytest.mark.parametrize(("locale", "late", "low"), [("en-CA", "Late", "Low priority"), ("fr-CA", "En retard", None)])
@pytest.mark.nightly
async def test_what_is_late_bears_a_mark_and_low_priority_no_warning(visit, quiet_campus, locale, late, low) -> None:
    ada = await visit("ada", on="desk", at=quiet_campus.service, locale=locale, color_scheme="light")
    desk = await quiet_campus.dispatcher(visit, on="desk", locale=locale)
    scene: Scene = quiet_campus.scene
    whats = [f"{what} {locale}" for what in ("Overdue", "In time", "Low", "High")]
    ids = [await ada.order("bob.martin@campus.example", what=what) for what in whats]
    async with scene.state.database.transaction() as session:
        rows = [await session.get_one(Order, order_id) for order_id in ids]
        rows[0].window_to = scene.clock.utc() - timedelta(minutes=2)
        rows[1].window_to = scene.clock.utc() + timedelta(minutes=20)
        rows[2].priority, rows[3].priority = Priority.LOW, Priority.HIGH
    for page, lines in ((desk.page, ".queue > li"), (ada.page, ".order")):
        await page.goto("/mailroom.html" if page is desk.page else "/mail.html")
        overdue = page.locator(lines, has_text=whats[0])
        await expect(overdue.locator(".late")).to_have_text(late)
        await expect(overdue.locator(".late svg")).to_be_visible()
        await expect(page.locator(lines, has_text=whats[1]).locator(".late")).to_have_count(0)
    queue = desk.page.locator(".queue > li")
    marks = [queue.filter(has_text=what).locator(".mark") for what in whats[2:]]
    low_colours, high_colours = [await colours(mark.first) for mark in marks]
    assert low_colours != high_colours
    assert low_colours == await desk.page.evaluate(NEUTRAL)
    if low:
        await expect(marks[0].first).to_have_text(low)
        await desk.assert_accessible()
        await ada.assert_accessible()
