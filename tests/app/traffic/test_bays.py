"""Several robots on a map with bays, over real sockets: they are where they say to be, and never meet."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack
from random import Random

import pytest

from app.core.settings import Settings
from app.models import GrantRow, OccupancyRow
from protocol.clock import SteppedClock
from tests.app.robots.playing import PlayedRobot, Service, serving, until
from tests.app.traffic.bay_travelling import MAP, BayTraveller, Floor, all_of

HOMES = "post5_bay2", "post1_bay2", "post4_bay2"
POSTS = "post1", "post2", "post3", "post4", "post5"


@pytest.fixture
async def service(settings: Settings, clock: SteppedClock) -> AsyncIterator[Service]:
    async with serving(settings.model_copy(update={"map": str(MAP)}), clock) as service:
        yield service


def travellers(clock: SteppedClock, floor: Floor, homes: tuple[str, ...] = HOMES) -> list[BayTraveller]:
    return [
        BayTraveller(PlayedRobot(clock, f"r{number}", f"journal-{number}"), floor, home)
        for number, home in enumerate(homes, start=1)
    ]


async def test_a_lone_robot_goes_to_a_bay_and_home(service: Service, clock: SteppedClock) -> None:
    (one,) = travellers(clock, Floor(), HOMES[:1])
    async with one.greeted(service):
        await one.go_to("post4")
        assert one.place == "post4_bay1"
        await one.go_to(one.home)
        assert one.place == "post5_bay2"

        async def holds_nothing() -> bool:
            return all(row.cleared_at is not None for row in await service.rows(GrantRow))

        await until(holds_nothing)


@pytest.mark.parametrize("seed", [1, *(pytest.param(seed, marks=pytest.mark.nightly) for seed in (2, 3))])
async def test_three_robots_never_meet_and_all_arrive(service: Service, clock: SteppedClock, seed: int) -> None:
    floor, random = Floor(), Random(seed)
    robots = travellers(clock, floor)
    ways = [[random.choice(POSTS) for _ in range(4)] for _ in robots]
    async with AsyncExitStack() as stack:
        for one in robots:
            await stack.enter_async_context(one.greeted(service))
        async with asyncio.timeout(100):
            await all_of(robots, ways)
    assert [one.place for one in robots] == list(HOMES)
    assert set(floor.taken) == set(HOMES)


async def test_what_was_reported_on_another_map_stops_nobody(service: Service, clock: SteppedClock) -> None:
    robots = travellers(clock, Floor(), HOMES[:2])
    async with robots[0].greeted(service), robots[1].greeted(service):
        await until(lambda: service.rows(OccupancyRow, robot="r2"))
        async with service.app.state.parts.database.transaction() as session:
            row = await session.get_one(OccupancyRow, "r2")
            row.place = "library_bay1"
        async with asyncio.timeout(60):
            await robots[0].go_to("post4")
