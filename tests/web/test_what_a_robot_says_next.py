"""Between two answers of the service a page takes its order's reason from the robot, by the service's own rule."""

import pytest

from app.core.texts.reasons import words_of
from app.models import Order, OrderState, RobotRow
from app.orders.views.reasons import OTHER_STOP_FIRST, why_it_waits

pytestmark = pytest.mark.browser

BEFORE = "Driving towards post2"
NEXT = ["Driving towards post3", "Waiting for the sender at post1", "Waiting for the recipient at post4", "a new word"]
NEXT += ["Waiting at post1 for the mail to be taken back", "Paused"]
SAY = """async (said) => {
  const { asItsRobotSays } = await import("/src/orders/order_words.js");
  return said.map(({ order, before, robot }) => asItsRobotSays(order, before, robot).why);
}"""


async def test_a_page_says_what_the_service_would_say(visit):
    states = [state for state in OrderState if state not in {OrderState.QUEUED, OrderState.ATTENTION}]
    cases = [(state, why) for state in states for why in NEXT]
    by_service = [why_it_waits(Order(state=state), RobotRow(name="r1", why=why)) for state, why in cases]
    ada = await visit(signed_in=False)
    await ada.page.goto("/")
    shown = await ada.page.evaluate(SAY, [news(state, BEFORE, why) for state, why in cases])
    assert shown == [BEFORE if why == OTHER_STOP_FIRST else why for why in by_service]
    assert BEFORE in shown and "Waiting for the sender at post1" in shown


async def test_the_services_own_word_stays(visit):
    own = "The robot serves another stop first."
    ada = await visit(signed_in=False)
    await ada.page.goto("/")
    assert await ada.page.evaluate(SAY, [news(OrderState.CARRYING, own, why) for why in NEXT]) == [own] * len(NEXT)


def news(state: OrderState, of_the_order: str, why: str) -> dict[str, object]:
    words = words_of(why)
    robot = {"why": why, "why_words": words and words.model_dump()}
    return {"order": {"state": state, "why": of_the_order}, "before": {"why": BEFORE}, "robot": robot}
