"""Which corridors people see taken: those of the robot that has their letter now."""

import re
from collections.abc import AsyncIterator, Iterator
from contextlib import AsyncExitStack

import pytest
import pytest_asyncio
from playwright.async_api import expect

from app.models import Role
from protocol.clock import RealClock
from protocol.parts import Activity, Battery, Leg, Position
from protocol.to_robot import Cancel
from protocol.to_server import Claim, Clear, CommandAnswer, Event, Snapshot, Step
from tests.app.robots.playing import PlayedRobot
from tests.web.service import Service
from tests.web.test_robots import give_roles

pytestmark = pytest.mark.browser
OF_R1, OF_R2 = Leg(from_post="post5", to_post="post3"), Leg(from_post="post2", to_post="post1")


@pytest.fixture(scope="module")
def roads(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    with Service(tmp_path_factory.mktemp("roads")) as service:
        yield service


@pytest_asyncio.fixture(loop_scope="session")
async def robots(roads: Service) -> AsyncIterator[list[PlayedRobot]]:
    """Two that the test plays; the second has not greeted yet."""
    async with AsyncExitStack() as connections:
        played = [PlayedRobot(RealClock(), name, journal=f"journal-of-{name}") for name in ("r1", "r2")]
        for robot in played:
            await connections.enter_async_context(robot.connected(roads.link, await roads.enrol_robot(robot.name)))
        await played[0].greet("post5", home="post5")
        yield played


FLAT, FULL = Battery(ratio=0.1), Battery(ratio=0.9)


async def lets_go(robot: PlayedRobot) -> None:
    cancel = (await robot.hear("cancel")).body
    assert isinstance(cancel, Cancel)
    answer = CommandAnswer(command_id=cancel.command_id, accepted=True, happened_at=robot.clock.utc())
    await robot.ends(await robot.say(Event(happened=answer)))


@pytest.mark.nightly
async def test_when_another_robot_comes_for_a_letter_its_corridors_are_shown_and_no_longer_those_of_the_first(
    roads, robots, visit
):
    first, second = robots
    ada, dana = await visit("ada.king", at=roads, on="phone"), await visit("dana.desk", at=roads)
    await give_roles(roads, dana.email, Role.DISPATCHER)
    await second.greet("post2", home="post2", battery=FLAT)
    await second.say(Claim(claim_id="c2", legs=(OF_R2,)))
    await second.hear("grant")
    order_id = await ada.order("bob.martin@campus.example")
    mission = await first.mission()
    await first.ends(await first.report(mission, Step.ACCEPTED))
    await first.say(Claim(claim_id="c1", legs=(OF_R1,)))
    await first.hear("grant")
    await second.say(Snapshot(position=Position(post="post2"), activity=Activity.DRIVING, battery=FULL))

    page = ada.page
    await page.goto(f"/follow.html?order={order_id}")
    where = page.get_by_role("region", name="Robot location")
    taken = where.locator("path.taken[data-robot]")
    await expect(where.get_by_text(re.compile("^May be in the corridor from Post 5 to Post 3"))).to_be_visible()
    await expect(taken).to_have_count(1)
    await dana.post(f"/orders/{order_id}/reassign", {"robot": "r2"})
    await lets_go(first)
    await expect(page.get_by_role("heading", level=1)).to_have_text("Robot r2 will collect your letter")
    await expect(where.get_by_text(re.compile("^May be in the corridor from Post 2 to Post 1"))).to_be_visible()
    await expect(where.get_by_text(re.compile("from Post 5 to Post 3"))).to_have_count(0)
    await expect(taken).to_have_count(1)
    await second.say(Clear(leg=OF_R2))
    await expect(taken).to_have_count(0)
