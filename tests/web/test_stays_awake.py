"""A screen that is looked at without being touched does not go dark."""

import pytest
from playwright.async_api import Route, expect

pytestmark = pytest.mark.browser

WATCH_LOCKS = """() => {
  window.asked = 0;
  window.held = 0;
  navigator.wakeLock.request = async (kind) => {
    window.asked += kind === "screen";
    window.held += 1;
    return { release: async () => { window.held -= 1; } };
  };
}"""
"""In place of the browser's own, which is refused where there is no screen."""
PICTURE = "data:image/svg+xml,%3Csvg xmlns='http://www.w3.org/2000/svg' width='9' height='9'/%3E"


async def test_the_mailroom_on_a_wall_keeps_its_screen_on_and_the_ordinary_one_does_not(visit, quiet_campus):
    dana = await quiet_campus.dispatcher(visit)
    page = dana.page
    await page.add_init_script(f"({WATCH_LOCKS})()")
    await page.goto("/mailroom.html")
    await expect(page.get_by_role("heading", level=1)).to_be_visible()
    await dana.asks_anew()
    assert await page.evaluate("[asked, held]") == [0, 0]
    await page.goto("/mailroom.html?wall")
    await page.wait_for_function("() => asked === 1 && held === 1")


async def test_a_code_keeps_the_screen_on_for_as_long_as_it_is_shown(visit):
    ada = await visit(on="phone")
    page = ada.page
    order_id = await ada.order("bob.martin@campus.example", what="Keys")
    order = await ada.api(f"/orders/{order_id}") | {"version": 1000}
    code = {"purpose": "load", "picture": PICTURE, "digits": "123456", "digits_locked": False, "expires_at": None}

    async def tell_order(route: Route) -> None:
        await route.fulfill(json=order)

    async def tell_code(route: Route) -> None:
        await route.fulfill(json=code)

    await page.route(f"**/api/v1/orders/{order_id}", tell_order)
    await page.route(f"**/api/v1/orders/{order_id}/code", tell_code)
    await page.add_init_script(f"({WATCH_LOCKS})()")
    await page.goto(f"/follow.html?order={order_id}")
    await expect(page.locator(".standing.queued")).to_be_visible()
    assert await page.evaluate("[asked, held]") == [0, 0], "it has no code yet"
    order |= {"state": "at_sender", "version": 1001, "my_code": "load"}
    await ada.asks_anew()
    await expect(page.locator(".qr")).to_be_visible()
    await page.wait_for_function("() => asked === 1 && held === 1")
    order |= {"state": "carrying", "version": 1002, "my_code": None}
    await ada.asks_anew()
    await page.wait_for_function("() => held === 0")
