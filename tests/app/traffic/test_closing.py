"""A corridor that a dispatcher or a robot has closed: no robot is let in until it is opened again."""

import pytest

from app.core.settings import Settings
from app.models import Person, RobotRow
from app.realtime.feed import FeedEvent
from app.robots.corridors.closures import all_closed
from app.robots.errors import NoSuchCorridor
from app.traffic.closing import close, open_again
from protocol.clock import SteppedClock
from protocol.envelope import YOUNGER
from protocol.parts import Leg
from protocol.to_server import Claim, Event, Fault
from robot.agent.actions.corridors import WAY_BLOCKED, tried_again, turned_back
from tests.app.robots.playing import PlayedRobot, Service, serving, until

ON = Leg(from_post="post2", to_post="post3")
NAME = "post2-post3"


async def the_dispatcher(service: Service) -> Person:
    state = service.app.state.parts
    async with state.database.transaction() as session:
        person: Person = await state.sign_in_service.person(session, "dan@campus.example", state.clock.utc())
    return person


async def close_it(service: Service, name: str = NAME) -> None:
    by = await the_dispatcher(service)
    async with service.app.state.parts.database.transaction() as session:
        await close(session, service.app.state.parts.fleet, name, "The floor is wet.", by)


async def open_it(service: Service) -> None:
    by = await the_dispatcher(service)
    async with service.app.state.parts.database.transaction() as session:
        await open_again(session, service.app.state.parts.fleet, NAME, by)


async def test_robots_wait_before_it_are_seen_to_and_go_on_when_it_is_open(
    settings: Settings, clock: SteppedClock, robot: PlayedRobot
) -> None:
    async with serving(settings, clock) as service:
        token = await service.enrol("r1")
        await close_it(service)
        async with robot.connected(service.url, token):
            await robot.greet("post2", home="post5", understands=("detour",))
            await robot.say(Claim(claim_id="c1", legs=(ON,), goal="post3"))

            async def waits() -> bool:
                row = await service.row(RobotRow, name="r1")
                return bool(row.waits_for and row.waits_for["closed"])

            await until(waits)
            await open_it(service)
            await robot.hear("grant")
            assert (await service.row(RobotRow, name="r1")).waits_for is None


async def found(service: Service) -> list[tuple[str, bool, list[str]]]:
    async with service.app.state.parts.database.reading() as session:
        return [(one.corridor, one.by_person, one.robots) for one in (await all_closed(session)).closed]


async def test_what_a_robot_finds_closed_is_closed_for_all_until_a_person_looks_and_the_robot_has_heard(
    settings: Settings, clock: SteppedClock, robot: PlayedRobot
) -> None:
    other = PlayedRobot(clock, "r2")
    async with serving(settings, clock) as service:
        tokens = {name: await service.enrol(name) for name in ("r1", "r2")}
        async with robot.connected(service.url, tokens["r1"]), other.connected(service.url, tokens["r2"]):
            await robot.greet("post4", home="post5", understands=YOUNGER)  # it has gone another way since
            await other.greet("post2", understands=YOUNGER)
            told = turned_back(Leg(from_post="post3", to_post="post2"), "blocked")
            fault = Fault(name=WAY_BLOCKED, happened_at=clock.utc(), reason=told)
            await robot.ends(await robot.say(Event(happened=fault)))
            assert await found(service) == [(NAME, False, ["r1"])]
            await other.say(Claim(claim_id="c1", legs=(ON,), goal="post3"))

            async def waits() -> bool:
                row = await service.row(RobotRow, name="r2")
                return bool(row.waits_for and row.waits_for["closed"])

            await until(waits)
            await open_it(service)
            assert await found(service) == [(NAME, False, ["r1"])], "r1 may have turned back again since"
            assert set((await robot.hear("open_way")).body.ends) == {"post2", "post3"}  # type: ignore[attr-defined]
            over = Fault(name=WAY_BLOCKED, cleared=True, happened_at=clock.utc(), reason=tried_again(NAME))
            await robot.ends(await robot.say(Event(happened=over)))
            await other.hear("grant")
            assert await found(service) == []
            await robot.ends(await robot.say(Event(happened=fault)))
            assert await found(service) == [(NAME, False, ["r1"])]

        async def is_away() -> bool:
            return not (await service.row(RobotRow, name="r1")).online

        await until(is_away)
        await open_it(service)
        assert await found(service) == [], "a robot that cannot be told keeps no other robot out"


async def test_everybody_hears_of_it_and_a_corridor_that_is_not_there_is_named(service: Service) -> None:
    with service.app.state.parts.feed.listening(await the_dispatcher(service)) as queue:
        await close_it(service)
        await close_it(service)
        await open_it(service)
        await open_it(service)
        news: list[FeedEvent] = [queue.get_nowait().happening for _ in range(queue.qsize())]
    assert [len(one.data.closed) for one in news if one.event == "closed"] == [1, 1, 0, 0]  # type: ignore[union-attr]
    with pytest.raises(NoSuchCorridor, match="post1-post9"):
        await close_it(service, "post1-post9")
