"""Where every corridor is granted as it is asked for: not what a service starts with, but measured with (0085)."""

from collections.abc import AsyncIterator
from datetime import timedelta

import pytest

from app.core.settings import Settings
from app.models import MissionRow, Order
from app.traffic.closing import close
from maps import shortest_route
from protocol.clock import SteppedClock
from protocol.parts import Leg
from protocol.to_robot import Deny, Grant
from protocol.to_server import Claim
from tests.app.dispatch.test_eta_updates import CORRIDOR_S, HANDOVER_S, teach
from tests.app.robots.playing import PlayedRobot, Service, serving, until

WAYS = ("post5", "post1"), ("post1", "post4")
LEG, ON = Leg(from_post="post1", to_post="post2"), Leg(from_post="post2", to_post="post3")


@pytest.fixture
async def service(settings: Settings, clock: SteppedClock) -> AsyncIterator[Service]:
    async with serving(settings.model_copy(update={"traffic": "at_once"}), clock) as service:
        yield service


async def test_the_nearest_robot_gets_the_first_order_and_the_next_one_the_second(
    service: Service, clock: SteppedClock
) -> None:
    near, far = PlayedRobot(clock, "near", "journal-n"), PlayedRobot(clock, "far", "journal-f")
    tokens = [await service.enrol(robot.name) for robot in (near, far)]
    async with far.connected(service.url, tokens[1]), near.connected(service.url, tokens[0]):
        await far.greet("post4")
        await near.greet("post2")
        first = await service.order()
        clock.advance(1.0)
        second = await service.order()
        assert (await near.mission()).stops[0].order_id == first
        assert (await far.mission()).stops[0].order_id == second
    assert [row.robot for row in await service.rows(MissionRow)] == ["near", "far"]


async def test_a_corridor_is_granted_as_it_is_asked_for_unless_it_is_closed(
    service: Service, clock: SteppedClock
) -> None:
    robot, state = PlayedRobot(clock), service.app.state.parts
    async with state.database.transaction() as session:
        person = await state.sign_in_service.person(session, "dan@campus.example", state.clock.utc())
        await close(session, state.fleet, "post2-post3", "The floor is wet.", person)
    async with robot.connected(service.url, await service.enrol("r1")):
        await robot.greet("post1")
        await robot.say(Claim(claim_id="c1", legs=(LEG, ON)))
        denied = (await robot.hear("deny")).body
        assert isinstance(denied, Deny)
        assert (denied.avoid, denied.reason) == ((ON,), "this corridor is closed")
        await robot.say(Claim(claim_id="c2", legs=(LEG,)))
        granted = (await robot.hear("grant")).body
        assert isinstance(granted, Grant)
        assert granted.legs == (LEG,)


async def test_an_order_that_a_robot_has_is_expected_when_its_shortest_way_ends(
    service: Service, clock: SteppedClock
) -> None:
    robot, estimates = PlayedRobot(clock), service.app.state.parts.estimates
    teach(estimates, clock.utc())
    async with robot.connected(service.url, await service.enrol("r1")):
        await robot.greet("post5", home="post5")
        order_id = await service.order("post1", "post4")
        await robot.mission()
        corridors = sum(len(shortest_route(service.app.state.parts.campus, *way).posts) - 1 for way in WAYS)
        comes_at = clock.utc() + timedelta(seconds=corridors * CORRIDOR_S + HANDOVER_S)

        async def is_foreseen() -> bool:
            order = await service.row(Order, id=order_id)
            if order.expected_from is None or order.expected_to is None:
                return False
            slack = timedelta(seconds=10)
            is_narrow = order.expected_to - order.expected_from < timedelta(seconds=120)
            return is_narrow and order.expected_from - slack <= comes_at <= order.expected_to + slack

        await until(is_foreseen)
