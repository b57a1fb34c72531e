"""No machine word reaches people: every reason that robots and the service can give, as the pages show it."""

import re

import pytest
from playwright.async_api import Page, expect

from app.core.texts.reasons import in_language, words_of
from app.models import Alarm, Order, OrderEvent, OrderState, RobotCommand, RobotRow
from app.orders.service import Actor
from app.orders.transitions import By
from tests.app.notifications.every_reason import RAW, every_reason, refusals_of_robots
from tests.web.mailroom_scene import Campus, Scene

pytestmark = pytest.mark.browser

BOB = "bob.martin@campus.example"
TYPED = "stuck_lid"
"""A dispatcher's text is shown as it was typed, even if it looks like a code."""


def shown(language: str, reason: str) -> str:
    """As mails say it, but for the posts: pages know their titles."""
    return re.sub(r"\bpost(\d)\b", r"Post \1", in_language(language, reason))


def key_of(reason: str) -> str:
    words = words_of(reason)
    return words.key if words else ""


async def has_gone_through(scene: Scene, order_id: str, robot: str, reasons: list[str], alarms: list[str]) -> None:
    """Its robot gave every reason, one after the other, rang every alarm and refused whatever it was told."""
    now = scene.clock.utc()
    async with scene.state.database.transaction() as session:
        known = {"why": "no_one_came", "activity": "waiting", "server_journal": robot}
        session.add(RobotRow(name=robot, enrolled_at=now, **known))
        order = await session.get_one(Order, order_id)
        happened = {"order_id": order_id, "state": order.state, "kind": "return_requested", "by": By.ROBOT, "at": now}
        for reason in reasons:
            order.version += 1
            session.add(OrderEvent(**happened, seq=order.version, robot=robot, reason=reason))
        session.add_all(Alarm(robot=robot, name="stuck", reason=reason, at=now) for reason in alarms)
        answered = {"kind": "cancel", "asked_at": now, "answered_at": now, "accepted": False}
        for n, refusal in enumerate(refusals_of_robots()):
            session.add(RobotCommand(command_id=f"{robot}-{n}", robot=robot, reason=refusal, **answered))


async def stops(scene: Scene, order_id: str, actor: Actor) -> None:
    async with scene.state.database.transaction() as session:
        await scene.state.orders.ledger.move(
            session, order_id, OrderState.ASSIGNED, Actor(By.DISPATCHER, robot=actor.robot)
        )
        await scene.state.orders.ledger.move(session, order_id, OrderState.ATTENTION, actor)


async def texts(page: Page, selector: str) -> list[str]:
    await expect(page.locator(selector).first).to_be_visible()
    return [text.strip() for text in await page.locator(selector).all_inner_texts()]


@pytest.mark.parametrize(("language", "locale"), [("en", "en-CA"), ("fr", "fr-CA")])
@pytest.mark.nightly
async def test_every_reason_is_said_in_words_on_every_page(quiet_campus: Campus, visit, language, locale):
    reasons, scene = every_reason(), quiet_campus.scene
    of_orders = [reason for reason in reasons if not key_of(reason).startswith("alarm.")]
    rung = [one for one in reasons if key_of(one).startswith("alarm.") and one not in refusals_of_robots()]
    rung.append("The robot met a problem: line_lost.")
    dana = await quiet_campus.dispatcher(visit, locale=locale)
    robot, page = f"r-{language}", dana.page
    ids = [await dana.order(BOB), await dana.order(BOB)]
    await has_gone_through(scene, ids[0], robot, of_orders, rung)
    await stops(scene, ids[0], Actor(By.ROBOT, robot=robot, reason="no_one_came"))
    me = (await dana.api("/me"))["id"]
    await stops(scene, ids[1], Actor(By.DISPATCHER, person_id=me, robot=robot, reason=TYPED))

    await page.goto(f"/follow.html?order={ids[0]}")
    remarks = await texts(page, ".timeline .remark")
    assert remarks == [shown(language, reason) for reason in [*of_orders, "no_one_came"]]
    assert RAW.findall(" ".join(remarks)) == []
    why = page.locator(".standing .window .remark")
    await expect(why).to_have_text(shown(language, "no_one_came"))
    await page.goto(f"/follow.html?order={ids[1]}")
    await expect(page.locator(".timeline .remark")).to_have_text(TYPED)

    await page.goto("/mailroom.html")
    alarms = await texts(page, f".issues li.alarm:has-text('{robot}') .what span")
    told = " ".join(alarms)
    assert [one for one in rung if shown(language, one).lower() not in told.lower()] == []
    assert RAW.findall(told) == []
    queue = await texts(page, ".queue .why-now")
    assert any(shown(language, "no_one_came") in one for one in queue) and any(TYPED in one.lower() for one in queue)

    await page.goto(f"/robots.html?robot={robot}")
    answers = " ".join(await texts(page, ".told li span"))
    assert [refusal for refusal in refusals_of_robots() if shown(language, refusal) not in answers] == []
