"""Messages in the outbox of a connected robot are sent without polling, and none out of turn."""

from app.robots.conversation.conversation import MAX_UNACKNOWLEDGED
from app.robots.service import Fleet, known_robot
from protocol.both_ways import Ack
from protocol.parts import Part
from protocol.to_robot import Deny
from tests.app.robots.playing import PlayedRobot, Service


def deny(number: int) -> Deny:
    return Deny(claim_id=f"claim-{number}", avoid=(), reason="so")


async def tell(fleet: Fleet, *messages: Part) -> None:
    async with fleet.database.transaction() as session:
        robot = await known_robot(session, "r1", to_change=True)
        for message in messages:
            await fleet.tell(session, robot, message)


async def numbers(robot: PlayedRobot, how_many: int) -> list[int | None]:
    return [(await robot.hear("deny")).seq for _ in range(how_many)]


async def test_what_is_told_goes_out_in_the_order_of_its_numbers(service: Service, robot: PlayedRobot) -> None:
    token = await service.enrol("r1")
    fleet: Fleet = service.app.state.parts.fleet
    async with robot.connected(service.url, token):
        await robot.greet()
        for number in range(0, 40, 4):
            await tell(fleet, deny(number), deny(number + 1))
            await tell(fleet, deny(number + 2))
            await tell(fleet, deny(number + 3))
        assert await numbers(robot, 40) == list(range(1, 41))
    assert [envelope.body for envelope in robot.heard if envelope.type == "deny"] == [deny(one) for one in range(40)]


async def test_a_robot_that_acknowledges_late_is_told_the_rest_when_it_has(
    service: Service, robot: PlayedRobot
) -> None:
    token = await service.enrol("r1")
    fleet: Fleet = service.app.state.parts.fleet
    async with robot.connected(service.url, token):
        await robot.greet()
        for number in range(MAX_UNACKNOWLEDGED + 7):
            await tell(fleet, deny(number))
        assert await numbers(robot, MAX_UNACKNOWLEDGED) == list(range(1, MAX_UNACKNOWLEDGED + 1))
        await robot.say(Ack())
        assert await numbers(robot, 7) == list(range(MAX_UNACKNOWLEDGED + 1, MAX_UNACKNOWLEDGED + 8))


async def test_who_is_not_there_finds_it_all_in_the_outbox(service: Service, robot: PlayedRobot) -> None:
    token = await service.enrol("r1")
    await tell(service.app.state.parts.fleet, deny(1), deny(2))
    async with robot.connected(service.url, token):
        await robot.greet()
        await tell(service.app.state.parts.fleet, deny(3))
        assert await numbers(robot, 3) == [1, 2, 3]
