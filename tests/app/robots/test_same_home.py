"""A dock is one robot's: a second one that names it as its home is refused until it names another."""

from collections.abc import AsyncIterator
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed

from app.core.settings import Settings
from app.models import Alarm, GrantRow, MissionRow, Order, RobotRow
from app.robots.service import revoke_tokens
from protocol.both_ways import Error
from protocol.clock import SteppedClock
from protocol.parts import Leg
from protocol.to_server import Claim, Step
from tests.app.robots.playing import PlayedRobot, Service, serving, until
from tests.plain_maps import PLAIN_TUNNELS

TWO_DOCKS = "uc", "canal"
"""Of the map; at azrieli there is none."""
REFUSAL = "its home uc is that of r1, too: give it another in its settings, or take back the other robot's token"
LEG = Leg(from_post="uc", to_post="azrieli")


@pytest.fixture
async def service(settings: Settings, clock: SteppedClock) -> AsyncIterator[Service]:
    """In the tunnels, which have several docks."""
    async with serving(settings.model_copy(update={"map": str(PLAIN_TUNNELS)}), clock) as service:
        yield service


@pytest.fixture
def second(clock: SteppedClock) -> PlayedRobot:
    return PlayedRobot(clock, "r2", "journal-2")


async def is_refused(service: Service, robot: PlayedRobot, **facts: Any) -> None:
    async with robot.connected(service.url, robot.token):
        with pytest.raises(ConnectionClosed) as closed:
            await robot.greet(**facts)
        assert closed.value.rcvd is not None
        assert (closed.value.rcvd.code, closed.value.rcvd.reason) == (4400, "same_home")
        error = robot.heard[-1].body
        assert isinstance(error, Error)
        assert (error.code, error.message) == ("same_home", REFUSAL)


async def rings(service: Service, robot: str) -> bool:
    return bool(await service.rows(Alarm, robot=robot, name="same_home", cleared_at=None))


async def test_the_second_of_two_robots_with_one_home_is_refused_and_the_first_goes_on(
    service: Service, robot: PlayedRobot, second: PlayedRobot
) -> None:
    robot.token, second.token = await service.enrol("r1"), await service.enrol("r2")
    async with robot.connected(service.url, robot.token):
        await robot.greet("canal", home="uc")
        for _ in range(2):  # it tries again, ever more slowly
            await is_refused(service, second, post="uc", home="uc")
        alarm = await service.row(Alarm, name="same_home")
        assert (alarm.robot, alarm.reason, alarm.cleared_at) == ("r2", REFUSAL, None)
        await service.order("uc", "azrieli")
        mission = await robot.mission()  # though the other stands where the mail is
        await robot.ends(await robot.report(mission, Step.DEPARTED, mission.stops[0]))
        await robot.say(Claim(claim_id="c1", legs=(Leg(from_post="canal", to_post="uc"),), goal="uc"))
        await robot.hear("grant")
        assert {row.robot for row in await service.rows(GrantRow)} == {"r1"}
        assert {row.robot for row in await service.rows(MissionRow)} == {"r1"}
        assert not (await service.row(RobotRow, name="r2")).online
        async with second.connected(service.url, second.token):
            await second.greet("canal", home="canal")
            assert not await rings(service, "r2")
            assert (await service.row(RobotRow, name="r2")).online
            assert (await service.row(RobotRow, name="r1")).online


async def test_a_home_is_free_when_its_robot_comes_no_more_or_has_another(
    service: Service, robot: PlayedRobot, second: PlayedRobot, clock: SteppedClock
) -> None:
    robot.token, second.token = await service.enrol("r1"), await service.enrol("r2")
    third = PlayedRobot(clock, "r3", "journal-3", token=await service.enrol("r3"))
    async with robot.connected(service.url, robot.token):
        await robot.greet("uc", home="uc")
    await is_refused(service, second, post="uc", home="uc")
    async with robot.connected(service.url, robot.token):
        await robot.greet("canal", home="canal")
    async with second.connected(service.url, second.token):
        await second.greet("uc", home="uc")
        assert not await rings(service, "r2")
    async with service.app.state.parts.database.transaction() as session:
        await revoke_tokens(session, clock, "r1")
    async with third.connected(service.url, third.token):
        await third.greet("canal", home="canal")
    assert not await rings(service, "r3")


@pytest.mark.parametrize("home", [None, "azrieli", "nowhere"])
async def test_robots_without_a_dock_of_their_own_share_what_they_name(
    service: Service, robot: PlayedRobot, second: PlayedRobot, home: str | None
) -> None:
    for one in (robot, second):
        async with one.connected(service.url, await service.enrol(one.name)):
            await one.greet("azrieli", home=home)
    assert await service.rows(Alarm, name="same_home") == []


@pytest.mark.slow
async def test_one_with_mail_aboard_is_let_in_to_bring_it_and_gets_no_more(
    service: Service, robot: PlayedRobot, second: PlayedRobot, clock: SteppedClock
) -> None:
    """Its settings were changed, or the service is new, while it was under way."""
    robot.token, second.token = await service.enrol("r1"), await service.enrol("r2")
    order_id = await service.order("uc", "azrieli")
    async with second.connected(service.url, second.token):
        await second.greet("uc", home="canal")
        mission = await second.mission()
        load, receive = mission.stops
        await second.report(mission, Step.DEPARTED, load)
        await second.report(mission, Step.ARRIVED, load)
        await second.ends(await second.say(second.receipt(load)))
    async with robot.connected(service.url, robot.token):
        await robot.greet("uc", home="uc")
    async with second.connected(service.url, second.token):
        await second.greet("uc", home="uc", cargo=(order_id,))
        assert await rings(service, "r2")
        assert (await service.row(RobotRow, name="r2")).online
        new_id = await service.order("uc", "azrieli")
        await second.report(mission, Step.DEPARTED, receive)
        clock.advance(600)  # tunnels are long
        await second.report(mission, Step.ARRIVED, receive)
        await second.say(second.receipt(receive))
        await second.ends(await second.report(mission, Step.DONE))
        await service.reaches(order_id, "delivered")
        async with robot.connected(service.url, robot.token):
            await robot.greet("canal", home="uc")

            async def has_a_robot() -> str | None:
                return (await service.row(Order, id=new_id)).robot

            assert await until(has_a_robot) == "r1", "and not the other, which stands nearer"
    await is_refused(service, second, post="azrieli", home="uc")
