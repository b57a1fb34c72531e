"""A robot that can go no further is relieved of its letter at the mailroom's word, and another carries it on: what the
dispatcher does, and what sender and recipient see of it."""

import re
from collections.abc import Iterator

import pytest
from playwright.async_api import expect

from maps import find_map
from protocol.clock import RealClock
from protocol.parts import StopAction
from protocol.to_server import Step
from tests.app.robots.playing import PlayedRobot
from tests.web.mailroom_scene import Campus
from tests.web.service import ALL_BUT_PROOFS, Service

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def campus(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Campus]:
    with Service(tmp_path_factory.mktemp("passing")) as service:
        yield Campus(service)


@pytest.mark.nightly
async def test_a_letter_changes_robots_and_everybody_sees_who_has_it(campus, visit):
    dana = await campus.dispatcher(visit)
    ada = await visit("ada.king", at=campus.service)
    link, version = campus.service.link, find_map("test_track").version
    first, second = [PlayedRobot(RealClock(), name, journal=f"journal-{name}") for name in ("r1", "r2")]
    async with first.connected(link, await campus.service.enrol_robot("r1")):
        await first.greet("post5", map_version=version, understands=ALL_BUT_PROOFS)
        order_id = await ada.order("bob.martin@campus.example", what="Signed forms")
        mission = await first.mission()
        load = next(stop for stop in mission.stops if stop.action is StopAction.LOAD)
        await first.report(mission, Step.ACCEPTED)
        await first.report(mission, Step.ARRIVED, load, post=load.post)
        await first.ends(await first.say(first.receipt(load)))

        page = dana.page
        await page.goto("/mailroom.html")
        queue = page.get_by_role("region", name=re.compile("^In progress"))
        await expect(queue.get_by_text("On its way").first).to_be_visible()
        await queue.get_by_role("button", name=re.compile("^Actions")).click()
        await page.get_by_role("button", name="Move to another robot").click()
        await expect(page.get_by_role("radio", name="Post 1")).to_be_checked()  # where the robot was seen last
        await page.get_by_role("radio", name="Post 2").check()
        await dana.assert_accessible()
        await page.get_by_role("button", name="Move", exact=True).click()
        await expect(queue.get_by_text("In the mailroom at Post 2")).to_be_visible()
        await first.hear("cancel")

        await ada.page.goto(f"/follow.html?order={order_id}")
        await expect(ada.page.get_by_role("heading", name="Your letter is changing robots at Post 2")).to_be_visible()
        await expect(ada.page.get_by_text("Taken out at Post 2, for another robot")).to_be_visible()
        async with second.connected(link, await campus.service.enrol_robot("r2")):
            await second.greet("post5", map_version=version, understands=ALL_BUT_PROOFS)
            mission = await second.mission()
            load = mission.stops[0]
            assert load.post == "post2"
            await second.report(mission, Step.ACCEPTED)
            await second.ends(await second.report(mission, Step.ARRIVED, load, post=load.post))
            await page.goto(f"/follow.html?order={order_id}")
            await expect(page.get_by_text("show the code to its camera")).to_be_visible()
            await expect(page.get_by_role("img", name=re.compile("code", re.IGNORECASE)).first).to_be_visible()
            await expect(
                ada.page.get_by_role("heading", name="Your letter is changing robots at Post 2")
            ).to_be_visible()
            await expect(ada.page.get_by_text("Robot r2 at Post 2")).to_be_visible()
            await second.ends(await second.say(second.receipt(load, code_sha256=second.codes(load)[-1])))
            await expect(ada.page.get_by_role("heading", name="Your letter is on its way to Post 4")).to_be_visible()
