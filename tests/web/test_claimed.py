"""A robot's unproven claim is shown as such until a dispatcher settles it."""

import re

import pytest
from playwright.async_api import Locator, Page, expect

from protocol.envelope import YOUNGER
from protocol.parts import StopAction
from protocol.to_server import Step
from tests.app.robots.playing import PlayedRobot
from tests.web.mailroom_scene import Campus
from tests.web.visitor import Visitor

pytestmark = pytest.mark.browser


def hands_of(page: Page) -> Locator:
    return page.get_by_role("region", name="Chain of custody").get_by_role("listitem")


async def carries_and_claims(robot: PlayedRobot, ada: Visitor, order_id: str) -> None:
    """The sender shows their code; the recipient has shown none when the robot says that they have the letter."""
    mission = await robot.mission()
    stops = {stop.action: stop for stop in mission.stops}
    await robot.ends(await robot.report(mission, Step.ARRIVED, stops[StopAction.LOAD]))
    code = (await ada.api(f"/orders/{order_id}/code"))["text"]
    await robot.ends(await robot.say(robot.proved_receipt(mission, stops[StopAction.LOAD], code)))
    await robot.ends(await robot.report(mission, Step.ARRIVED, stops[StopAction.RECEIVE]))
    await robot.ends(await robot.say(robot.receipt(stops[StopAction.RECEIVE], how="code")))


@pytest.mark.nightly
async def test_a_claim_is_shown_as_one_until_a_dispatcher_has_asked(quiet_campus: Campus, visit) -> None:
    dana = await quiet_campus.dispatcher(visit)
    ada = await visit("ada.king", at=quiet_campus.service)
    bob = await visit("bob.martin", on="phone", at=quiet_campus.service)
    async with quiet_campus.service.connected("r9", understands=YOUNGER) as robot:
        order_id = await ada.order(bob.email)
        await carries_and_claims(robot, ada, order_id)
        await bob.page.goto(f"/follow.html?order={order_id}")
        await expect(bob.page.get_by_role("heading", level=1)).to_have_text("The mailroom is looking into it")
        hands = hands_of(bob.page)
        await expect(hands.nth(1)).to_contain_text("confirmed with the code of Ada King")
        await expect(hands.nth(1)).to_have_class("now")
        await expect(hands.nth(2)).to_contain_text("reported by the robot, not confirmed")
        await expect(hands.nth(2)).not_to_have_class("now")
        await bob.assert_accessible()

        await dana.page.goto("/mailroom.html")
        wrong = dana.page.get_by_role("region", name="Issues")
        await expect(wrong).to_contain_text("nothing shows that the robot has seen the code")
        await dana.page.get_by_role("button", name=re.compile("^Decide")).click()
        dialog = dana.page.get_by_role("dialog", name=re.compile("^Decide about the mail"))
        await dialog.get_by_role("radio", name="It was delivered").check()
        await dialog.get_by_role("button", name="Confirm").click()
        await expect(hands.nth(2)).to_contain_text("reported by the robot, confirmed later")
        assert (await ada.api(f"/orders/{order_id}"))["state"] == "delivered"
        await expect(wrong).to_contain_text("No issues")


@pytest.mark.slow
async def test_what_an_older_robot_tells_is_marked_as_weaker(quiet_campus: Campus, visit) -> None:
    ada = await visit("ada.king", at=quiet_campus.service)
    async with quiet_campus.service.connected("r8", understands=("confirm",)) as robot:
        order_id = await ada.order("carl.sagan@campus.example")
        mission = await robot.mission()
        await robot.ends(await robot.report(mission, Step.ARRIVED, mission.stops[0]))
        await robot.ends(await robot.say(robot.receipt(mission.stops[0])))
        await ada.page.goto(f"/follow.html?order={order_id}")
        said = "with the weaker proof of an older robot"
        await expect(hands_of(ada.page).nth(1)).to_contain_text(said)
