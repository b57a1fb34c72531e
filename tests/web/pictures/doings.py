"""Steps on a page before its picture is taken."""

import re
from collections.abc import Awaitable, Callable

from playwright.async_api import Page, expect

Doing = Callable[[Page], Awaitable[None]]


async def fill_in_the_order(page: Page) -> None:
    await page.locator("form [name=from_post]").select_option("library")
    await page.locator("form [name=to_post]").select_option("nicol")
    await page.locator("form [name=recipient]").fill("bob.martin@campus.example")
    await page.locator("form [name=description]").fill("Signed forms")
    await page.locator(".estimate strong").wait_for()
    await page.evaluate("() => (document.activeElement.blur(), scrollTo(0, 0))")


async def order_without_network(page: Page) -> None:
    """It is kept on the device. The network is away from now on."""
    await fill_in_the_order(page)
    await page.route("**/api/v1/orders", lambda route: route.abort())
    await page.locator("order-form button.main").click()
    await page.locator(".kept li").wait_for()


async def open_the_desk(page: Page) -> None:
    """An order for a visitor at the mailroom's desk."""
    await page.locator(".tools .primary").click()
    await page.locator("input[role=combobox]").first.fill("grace")
    await page.locator(".people li").first.wait_for()


async def come_to_the_faults(page: Page) -> None:
    """Down to them: on both screens they lie below what the picture of the charge shows."""
    await page.locator("robot-faults").evaluate("(faults) => faults.scrollIntoView({block: 'start'})")


async def come_to_the_mind(page: Page) -> None:
    """Down to where the robot tells what it intends; it drives by then."""
    follows = page.locator(".intends").get_by_text(re.compile("follow_line")).first
    await expect(follows).to_be_visible(timeout=40_000)
    await expect(page.locator(".believes .count")).not_to_have_text("0")  # who comes second asks for all of them anew
    await expect(page.locator(".senses details")).to_be_visible()  # with every tenth report
    await page.locator("robot-diagnostics").evaluate("(watch) => watch.scrollIntoView({block: 'start'})")


async def all_drawn(page: Page) -> None:
    """Images have come, fonts too, and nothing slides any more."""
    await page.wait_for_load_state("load")
    await page.mouse.move(0, 0)
    await page.evaluate(
        """async () => {
          const isSeen = (map) => map.getBoundingClientRect().top < innerHeight;
          const isDrawn = (map) => map.querySelector("svg .post");
          for (let tries = 0; tries < 300; tries += 1) {
            if ([...document.querySelectorAll("campus-map")].filter(isSeen).every(isDrawn)) break;
            await new Promise((drawn) => requestAnimationFrame(drawn));
          }
          await document.fonts.ready;
          await Promise.all([...document.images].filter(({complete}) => !complete).map(
            (image) => new Promise((come) => { image.onload = image.onerror = come; })));
          await new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)));
        }"""
    )
