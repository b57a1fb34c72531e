"""Following a letter: every state that there is, for everybody who may look."""

import re

import pytest
from playwright.async_api import Route, expect

from tests.web.visitor import Visitor

pytestmark = pytest.mark.browser

STATES = ("queued", "assigned", "to_sender", "at_sender", "carrying", "at_recipient", "delivered", "returning")
STATES += ("at_return", "returned", "held", "expired", "cancelled", "attention")
CODES = {"sender": {"at_sender": "load", "at_return": "return"}, "recipient": {"at_recipient": "receive"}}
GAPS = re.compile(r"\{\w+\}|\b(state|next|badge|timeline|follow|code|stage)\.[a-z_]+")


@pytest.mark.parametrize(("role", "theme"), [("sender", "light"), ("recipient", "dark")])
@pytest.mark.slow
async def test_every_state_is_said_in_words_with_what_comes_next(visit, role, theme):
    """The service's own answer, as it is in each state; how an order comes there is seen in test_delivery."""
    ada: Visitor = await visit(on="phone", color_scheme=theme)
    page = ada.page
    order_id = await ada.order("bob.martin@campus.example", what="Keys")
    order = await ada.api(f"/orders/{order_id}") | {"my_role": role, "version": 1000}
    ada.refusals_expected.add(f"/api/v1/orders/{order_id}/code")  # which this order does not have yet

    async def tell(route: Route) -> None:
        await route.fulfill(json=order)

    await page.route(f"**/api/v1/orders/{order_id}", tell)
    await page.goto(f"/follow.html?order={order_id}")
    said: dict[str, str] = {}
    heading = page.get_by_role("heading", level=1)
    for state in STATES:
        order |= {"state": state, "version": order["version"] + 1, "my_code": CODES[role].get(state)}
        await ada.asks_anew()
        await expect(page.locator(f".standing.{state}")).to_be_visible()
        await expect(heading).not_to_have_text("")
        said[state] = f"{await heading.inner_text()} {await page.locator('.standing .next').inner_text()}"
        assert not GAPS.search(await page.locator("main").inner_text()), state
        if state in ("at_sender", "attention", "returned"):
            await ada.assert_accessible()
    assert len(set(said.values())) >= len(STATES) - 2, "a robot on its way elsewhere is one thing to a recipient"
