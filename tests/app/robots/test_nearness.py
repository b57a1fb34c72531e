"""The sender is told that the robot is near when it is near, on a map that is large enough to be far away."""

import pytest

from app.core.settings import Settings, open_map
from app.models import Notification
from app.orders.nearness import is_near
from maps.ways import Ways
from protocol.clock import SteppedClock
from protocol.to_server import Step
from tests.app.robots.playing import PlayedRobot, Service
from tests.plain_maps import PLAIN_TUNNELS

FAR, NEARER, NEXT_TO_IT, SENDERS = "loeb", "uc", "frontenac", "commons"


@pytest.fixture
def settings(settings: Settings) -> Settings:
    return settings.model_copy(update={"map": str(PLAIN_TUNNELS)})


async def kinds(service: Service) -> list[str]:
    return [str(one.kind) for one in await service.rows(Notification)]


async def test_the_sender_hears_once_that_the_robot_is_near_when_it_has_one_corridor_left(
    service: Service, robot: PlayedRobot
) -> None:
    order_id = await service.order(SENDERS, FAR)
    async with robot.connected(service.url, await service.enrol("r1")):
        await robot.greet(FAR)
        mission = await robot.mission()
        load = mission.stops[0]
        await robot.ends(await robot.report(mission, Step.DEPARTED, load, post=FAR))
        assert (await service.states(order_id))[-1] == "to_sender"
        await robot.ends(await robot.report(mission, Step.PASSED, load, post=NEARER))
        assert await kinds(service) == ["accepted"], "it is on its way, but far off"
        for _ in range(2):
            await robot.ends(await robot.report(mission, Step.PASSED, load, post=NEXT_TO_IT))
            assert await kinds(service) == ["accepted", "robot_near"]
        await robot.ends(await robot.report(mission, Step.ARRIVED, load))
        await robot.ends(await robot.report(mission, Step.PASSED, load, post=NEXT_TO_IT))
    assert await kinds(service) == ["accepted", "robot_near", "robot_here"]


async def test_what_is_told_on_the_way_is_told_at_the_time_at_which_it_is(
    service: Service, robot: PlayedRobot, clock: SteppedClock
) -> None:
    """Not when the robot set out, perhaps half an hour before."""
    await service.order(SENDERS, FAR)
    async with robot.connected(service.url, await service.enrol("r1")):
        await robot.greet(FAR)
        mission = await robot.mission()
        load = mission.stops[0]
        await robot.ends(await robot.report(mission, Step.DEPARTED, load, post=FAR))
        clock.advance(1800.0)
        await robot.ends(await robot.report(mission, Step.PASSED, load, post=NEXT_TO_IT))
    near = (await service.rows(Notification))[-1]
    assert (near.kind, near.at) == ("robot_near", clock.utc())


async def test_a_robot_that_sets_out_next_door_is_near_at_once(service: Service, robot: PlayedRobot) -> None:
    await service.order(SENDERS, FAR)
    async with robot.connected(service.url, await service.enrol("r1")):
        await robot.greet(NEXT_TO_IT)
        mission = await robot.mission()
        await robot.ends(await robot.report(mission, Step.DEPARTED, mission.stops[0], post=NEXT_TO_IT))
    assert await kinds(service) == ["accepted", "robot_near"]


@pytest.mark.parametrize(
    ("post", "speed_m_s", "near"),
    [
        (NEXT_TO_IT, 0.0, True),  # 70 m, but nothing is heard of it before it is there
        ("mackenzie", 0.749, False),  # 135 m in 180 s are 0.75 m/s
        ("mackenzie", 0.751, True),
        (SENDERS, 0, True),
        (None, 0, True),  # rather too early than not at all
        ("a post of another map", 0, True),
    ],
)
def test_near_is_one_corridor_or_a_few_minutes(
    settings: Settings, post: str | None, speed_m_s: float, near: bool
) -> None:
    ways = Ways(open_map(settings))
    assert is_near(ways, post, SENDERS, speed_m_s) is near
