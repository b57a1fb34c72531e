"""People who see which robot holds which corridor, and are notified of it."""

from collections.abc import AsyncIterator

import pytest

from app.models import Person, Role
from app.realtime.feed import FeedEvent
from app.robots.corridors.occupied import traffic_for
from protocol.parts import Leg
from protocol.to_server import Claim, Clear, Step
from tests.app.robots.playing import PlayedRobot, Service

FIRST, SECOND = Leg(from_post="post3", to_post="post2"), Leg(from_post="post2", to_post="post1")
STRANGER = Person(id="stranger", email="stranger@campus.example", name="S", roles=["member"])
DISPATCHER = Person(id="dan", email="dan@campus.example", name="Dan", roles=[Role.MEMBER, Role.DISPATCHER])
MAINTAINER = Person(id="mia", email="mia@campus.example", name="Mia", roles=[Role.MEMBER, Role.MAINTAINER])


@pytest.fixture
async def with_an_order(service: Service, robot: PlayedRobot) -> AsyncIterator[PlayedRobot]:
    """The robot is on its way to the sender's mail."""
    token = await service.enrol("r1")
    await service.order()
    async with robot.connected(service.url, token):
        await robot.greet()
        mission = await robot.mission()
        await robot.ends(await robot.report(mission, Step.ACCEPTED))
        yield robot


async def party(service: Service, email: str) -> Person:
    row: Person = await service.row(Person, email=email)
    return row


async def seen_by(service: Service, person: Person) -> list[tuple[str, str, str]]:
    async with service.app.state.parts.database.reading() as session:
        taken = (await traffic_for(session, person)).taken
    return [(one.robot, one.from_post, one.to_post) for one in taken]


async def test_members_see_the_corridors_of_the_robot_on_their_order_and_no_others(
    service: Service, with_an_order: PlayedRobot
) -> None:
    await with_an_order.say(Claim(claim_id="c1", legs=(FIRST, SECOND)))
    await with_an_order.hear("grant")
    all_of_it = [("r1", "post3", "post2"), ("r1", "post2", "post1")]
    for email in ("sender@campus.example", "recipient@campus.example"):
        assert await seen_by(service, await party(service, email)) == all_of_it
    assert await seen_by(service, STRANGER) == []
    assert await seen_by(service, DISPATCHER) == await seen_by(service, MAINTAINER) == all_of_it
    await with_an_order.ends(await with_an_order.say(Clear(leg=FIRST)))
    assert await seen_by(service, DISPATCHER) == all_of_it[1:]


async def test_pages_hear_of_it_as_soon_as_a_corridor_is_taken_or_left(
    service: Service, with_an_order: PlayedRobot
) -> None:
    feed = service.app.state.parts.feed
    people = [await party(service, "sender@campus.example"), STRANGER, DISPATCHER, MAINTAINER]
    heard: dict[str, list[FeedEvent]] = {}
    for person in people:
        with feed.listening(person) as queue:
            claim = Claim(claim_id=f"c-{person.name}", legs=(FIRST, FIRST))
            await with_an_order.say(claim)
            await with_an_order.hear("grant")
            await with_an_order.ends(await with_an_order.say(Clear(leg=FIRST)))
            news = [queue.get_nowait().happening for _ in range(queue.qsize())]
            heard[person.email] = [one for one in news if one.event == "traffic"]
    assert heard.pop(STRANGER.email) == []
    for told in heard.values():
        assert [(one.data.robot, len(one.data.taken)) for one in told] == [("r1", 1), ("r1", 0)]
