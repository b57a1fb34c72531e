"""On a map with bays: what robots say to occupy is kept, people see posts alone, and a home is one robot's bay."""

from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed

from app.core.settings import Settings
from app.models import Alarm, OccupancyRow, RobotRow
from app.robots.corridors.occupied import traffic_for
from app.robots.enrolment.errors import NoHomeForRobot
from app.robots.service import known_robot, revoke_tokens
from app.traffic.out_of_service import take_out
from protocol.both_ways import Error
from protocol.clock import SteppedClock
from protocol.parts import Leg
from protocol.to_server import Clear, Occupancy
from tests.app.robots.playing import PlayedRobot, Service, serving, until
from tests.app.robots.test_occupied import DISPATCHER, STRANGER

MAP = Path(__file__).parents[2] / "bays.toml"


@pytest.fixture
async def service(settings: Settings, clock: SteppedClock) -> AsyncIterator[Service]:
    async with serving(settings.model_copy(update={"map": str(MAP)}), clock) as service:
        yield service


def occupies(robot: PlayedRobot, where: str, post: str, towards: str | None = None) -> Occupancy:
    return Occupancy.model_validate(
        {"where": where, "post": post, "towards": towards, "evidence": "marker", "happened_at": robot.clock.utc()}
    )


async def test_the_last_word_of_a_robot_is_kept(service: Service, robot: PlayedRobot) -> None:
    robot.token = await service.enrol("r1")
    async with robot.connected(service.url, robot.token):
        await robot.greet("post1_bay1", home="post5_bay2")
        await robot.say(occupies(robot, "bay", "post1_bay1"))
        await robot.say(occupies(robot, "corridor", "post1", "post2"))

        async def kept() -> OccupancyRow | None:
            rows = await service.rows(OccupancyRow, kind="corridor")
            return rows[0] if rows else None

        row = await until(kept)
        assert (row.robot, row.place, row.towards, row.evidence) == ("r1", "post1", "post2", "marker")
        assert row.at == robot.clock.utc()


@pytest.mark.parametrize(
    ("where", "post", "towards"),
    [
        ("bay", "post1", None),
        ("crossing", "post1_bay1", None),
        ("corridor", "post1", "post4"),
        ("corridor", "post1", None),
        ("bay", "post9_bay1", None),
    ],
)
async def test_what_the_map_does_not_have_is_not_believed(
    service: Service, robot: PlayedRobot, where: str, post: str, towards: str | None
) -> None:
    robot.token = await service.enrol("r1")
    async with robot.connected(service.url, robot.token):
        await robot.greet("post1_bay1", home="post5_bay2")
        await robot.say(occupies(robot, where, post, towards))
        error = (await robot.hear("error")).body
        assert isinstance(error, Error)
        assert error.code == "unknown_corridor"
        assert await service.rows(OccupancyRow) == []


async def test_dispatchers_see_what_a_robot_reports_to_be_in_and_members_without_an_order_do_not(
    service: Service, robot: PlayedRobot
) -> None:
    robot.token = await service.enrol("r1")
    feed = service.app.state.parts.feed
    async with robot.connected(service.url, robot.token):
        await robot.greet("post1_bay1", home="post5_bay2")
        with feed.listening(DISPATCHER) as dispatchers, feed.listening(STRANGER) as strangers:
            await robot.ends(await robot.say(occupies(robot, "corridor", "post1", "post2")))
            heard = [queue.get_nowait().happening for queue in (dispatchers, strangers) for _ in range(queue.qsize())]
    (news,) = [one.data for one in heard if one.event == "traffic"]
    assert (news.robot, news.taken, news.reported.kind) == ("r1", [], "corridor")
    async with service.app.state.parts.database.reading() as session:
        (place,) = (await traffic_for(session, DISPATCHER)).reported
        assert (place.robot, place.place, place.towards) == ("r1", "post1", "post2")
        assert (await traffic_for(session, STRANGER)).reported == []


async def test_people_see_a_robot_in_a_bay_at_its_post(service: Service, robot: PlayedRobot) -> None:
    robot.token = await service.enrol("r1")
    async with robot.connected(service.url, robot.token):
        await robot.greet("post4_bay1", home="post5_bay2")
        row = await service.row(RobotRow, name="r1")
        assert (row.post, row.home, row.home_bay) == ("post4", "post5", "post5_bay2")


async def test_a_spur_is_cleared_like_a_corridor(service: Service, robot: PlayedRobot) -> None:
    robot.token = await service.enrol("r1")
    async with robot.connected(service.url, robot.token):
        await robot.greet("post4_bay1", home="post5_bay2")
        await robot.say(Clear(leg=Leg(from_post="post4_bay1", to_post="post4"), post="post4"))
        await robot.say(occupies(robot, "crossing", "post4"))
        await until(lambda: service.rows(OccupancyRow, kind="crossing"))
        assert not [envelope for envelope in robot.heard if envelope.type == "error"]


async def test_two_homes_at_one_post_are_two_robots(service: Service, robot: PlayedRobot, clock: SteppedClock) -> None:
    second = PlayedRobot(clock, "r2", "journal-2")
    robot.token, second.token = await service.enrol("r1"), await service.enrol("r2")
    async with robot.connected(service.url, robot.token):
        await robot.greet("post4_bay2", home="post4_bay2")
        async with second.connected(service.url, second.token):
            with pytest.raises(ConnectionClosed):
                await second.greet("post4_bay2", home="post4_bay2")
        async with second.connected(service.url, second.token):
            await second.greet("post1_bay2", home="post1_bay2")
        assert await service.rows(Alarm, robot="r2", name="same_home", cleared_at=None) == []


async def test_a_person_who_has_looked_frees_what_a_robot_occupied(service: Service, robot: PlayedRobot) -> None:
    robot.token = await service.enrol("r1")
    async with robot.connected(service.url, robot.token):
        await robot.greet("post1_bay1", home="post5_bay2")
        await robot.say(occupies(robot, "bay", "post1_bay1"))
        await until(lambda: service.rows(OccupancyRow))
    await until(lambda: service.rows(RobotRow, online=False))
    parts = service.app.state.parts
    async with parts.database.transaction() as session:
        by = await parts.sign_in_service.person(session, "dan@campus.example", parts.clock.utc())
        row = await known_robot(session, "r1", to_change=True)
        await take_out(session, parts.fleet, row, "Carried into the workshop.", by)
    assert await service.rows(OccupancyRow) == []


def takes_its_home(number: int, clock: SteppedClock) -> PlayedRobot:
    return PlayedRobot(clock, f"r{number}", f"journal-{number}")


async def given_home(service: Service, robot: PlayedRobot, **facts: Any) -> str | None:
    """The home that the service tells it; its connection is closed again."""
    robot.token = robot.token or await service.enrol(robot.name)
    async with robot.connected(service.url, robot.token):
        return (await robot.greet("post3_bay1", understands=("home",), **facts)).home


async def test_each_robot_is_given_a_home_those_with_docks_first(service: Service, clock: SteppedClock) -> None:
    robots = [takes_its_home(number, clock) for number in (1, 2, 3)]
    homes = [await given_home(service, robot) for robot in robots]
    assert homes == ["post5_bay2", "post1_bay2", "post4_bay2"]
    assert [await given_home(service, robot) for robot in robots] == homes, "it keeps the home that it has"


async def test_a_robot_gets_the_home_that_it_names_if_that_is_free(service: Service, clock: SteppedClock) -> None:
    assert await given_home(service, takes_its_home(1, clock), home="post4_bay2") == "post4_bay2"
    assert await given_home(service, takes_its_home(2, clock), home="post4_bay2") == "post5_bay2"


async def test_a_robot_that_names_none_gets_the_one_in_which_it_stands(service: Service, clock: SteppedClock) -> None:
    robot = takes_its_home(1, clock)
    robot.token = await service.enrol(robot.name)
    async with robot.connected(service.url, robot.token):
        assert (await robot.greet("post4_bay2", understands=("home",))).home == "post4_bay2"


async def test_more_robots_than_homes_are_refused_with_the_reason(service: Service, clock: SteppedClock) -> None:
    for number in (1, 2, 3):
        await given_home(service, takes_its_home(number, clock))
    fourth = takes_its_home(4, clock)
    fourth.token = await service.enrol("r4")
    async with fourth.connected(service.url, fourth.token):
        with pytest.raises(ConnectionClosed) as closed:
            await fourth.greet("post3_bay1", understands=("home",))
    assert closed.value.rcvd is not None
    assert closed.value.rcvd.reason == "no_home_left"
    error = fourth.heard[-1].body
    assert isinstance(error, Error)
    assert "the map bays has 3 homes, and each is another robot's" in error.message


async def test_no_code_is_made_for_a_robot_without_a_home(service: Service, clock: SteppedClock) -> None:
    parts = service.app.state.parts
    for number in (1, 2, 3):
        await given_home(service, takes_its_home(number, clock))
    async with parts.database.transaction() as session:
        with pytest.raises(NoHomeForRobot, match=r"has 3 homes.*add a bay with home = true"):
            await parts.enrolment_service.make_code(session, "r4")
        await parts.enrolment_service.make_code(session, "r2")  # a known one gets a new token


async def test_a_home_is_free_when_its_robot_does_not_come_any_more(service: Service, clock: SteppedClock) -> None:
    assert await given_home(service, takes_its_home(1, clock)) == "post5_bay2"
    parts = service.app.state.parts
    async with parts.database.transaction() as session:
        await revoke_tokens(session, parts.clock, "r1")
    assert await given_home(service, takes_its_home(2, clock)) == "post5_bay2"


async def test_an_older_robot_is_told_no_home(service: Service, robot: PlayedRobot) -> None:
    robot.token = await service.enrol("r1")
    async with robot.connected(service.url, robot.token):
        await robot.greet("post5_bay2", home="post5_bay2")
    assert '"home"' not in next(one for one in robot.heard if one.type == "welcome").to_text()
