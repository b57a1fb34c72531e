"""Until the service says more about an order, a page takes its reason from the robot, by the service's own rule."""

import re

import pytest
from playwright.async_api import expect

from app.core.texts.reasons import words_of
from app.models import Order, OrderState, RobotRow
from app.orders.views.reasons import OTHER_STOP_FIRST, why_it_waits
from protocol.parts import Activity, Battery, Position, StopAction
from protocol.to_server import Snapshot, Step, Why

pytestmark = pytest.mark.browser

BEFORE = "Driving towards post2"
NEXT = ["Driving towards post3", "Waiting for the sender at post1", "Waiting for the recipient at post4", "a new word"]
NEXT += ["Waiting at post1 for the mail to be taken back", "Paused"]
SAY = """async (said) => {
  const { asItsRobotSays } = await import("/src/orders/order_words.js");
  return said.map(({ order, before, robot }) => asItsRobotSays(order, before, robot).why);
}"""

THE_SERVICE_IS_LATE = """
  const listen = EventSource.prototype.addEventListener;
  EventSource.prototype.addEventListener = function (kind, hear) {
    return listen.call(this, kind, kind === "order" ? (event) => window.isLate || hear(event) : hear);
  };
"""


async def test_what_the_robot_says_is_shown_though_the_service_is_late(quiet_campus, robot, visit):
    ada = await visit("ada.king", at=quiet_campus.service)
    dana = await quiet_campus.dispatcher(visit)
    order_id = await ada.order("bob.martin@campus.example")
    mission = await robot.mission()
    (load,) = [stop for stop in mission.stops if stop.action is StopAction.LOAD]
    for step, stop in ((Step.ACCEPTED, None), (Step.DEPARTED, load), (Step.ARRIVED, load)):
        await robot.ends(await robot.report(mission, step, stop))
    here = Position(post=load.post, seen_at=robot.clock.utc())
    await robot.say(Snapshot(position=here, activity=Activity.WAITING, battery=Battery(ratio=0.9)))
    await robot.say(Why(sentence=BEFORE))

    reasons = []
    for person, address, region in (
        (ada, f"/follow.html?order={order_id}", "Why it is waiting"),
        (dana, "/mailroom.html", re.compile("^In progress")),
    ):
        await person.page.add_init_script(THE_SERVICE_IS_LATE)
        await person.page.goto(address)
        reasons.append(person.page.get_by_role("region", name=region))
        await expect(reasons[-1]).to_contain_text("Driving towards Post 2")
        await person.page.evaluate("window.isLate = true")
    await robot.say(Why(sentence=f"Waiting for the sender at {load.post}"))
    for reason in reasons:
        await expect(reason).to_contain_text(re.compile(r"Waiting for the sender at Post \d"))


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
