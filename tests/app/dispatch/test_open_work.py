"""Open work, read again for a few robots: what a decision is checked by before it is written."""

from collections.abc import AsyncIterator
from contextlib import suppress
from pathlib import Path
from random import Random

import pytest

from app.core.errors import ServiceError
from app.dispatch.open_work import OpenWork, read_open_work, read_part
from app.models import MissionRow, Order, OrderState, StopRow
from protocol.parts import StopAction
from tests.app.orders.lives import World

POSTS = ("post1", "post2", "post3", "post4")
LUCK = ("sets out", "arrives", "no way", "no person comes", "sender", "sender", "recipient")
STEPS = 30


@pytest.fixture
async def world(sqlite_at_head: Path, tmp_path: Path) -> AsyncIterator[World]:
    world = World(sqlite_at_head, tmp_path / "data")
    await world.begin()
    yield world
    await world.end()


def seen_of(work: OpenWork, robot: str) -> dict[str, object]:
    """Return all that is known of a robot and of what it has before it."""
    return {
        "robot": work.robots.get(robot),
        "mission": work.missions.get(robot),
        "stops": work.stops.get(robot),
        "orders": {order.id: order for order in work.orders.values() if order.robot == robot},
        "stops of orders": {
            order.id: work.of_orders.get(order.id) for order in work.orders.values() if order.robot == robot
        },
    }


async def something_happens(world: World, rng: Random, orders: list[str]) -> None:
    robot = rng.choice(sorted(world.robots))
    match rng.randrange(7) if orders else 0:
        case 0:
            orders.append(await world.place(*rng.sample(POSTS, 2)))
        case 1:
            await world.dispatch()
        case 2:
            cancels, reassigns = world.orders.cancelling.cancel, world.orders.intervening.reassign
            what, who, how = rng.choice(((cancels, "sender", ""), (reassigns, "dispatcher", None)))
            await world.change(what, who, rng.choice(orders), how)
        case 3 if rng.random() < 0.1:  # it answers at once only if it has nothing aboard
            await world.recall(robot)
        case 4:
            await world.set_online(robot, rng.random() < 0.7)
        case _:
            await world.goes_on(robot, *rng.choices(LUCK, k=rng.randrange(4)))


@pytest.mark.parametrize("seed", range(3))
async def test_a_robot_read_alone_is_what_it_is_among_all(world: World, seed: int) -> None:
    rng, orders, busy = Random(seed), list[str](), 0
    for _ in range(STEPS):
        with suppress(ServiceError):  # not every request can be granted
            await something_happens(world, rng, orders)
        now = world.clock.utc()
        async with world.database.reading() as session:
            whole = await read_open_work(session, now)
            waiting = {order.id for order in whole.waiting}
            for robot in world.robots:
                theirs = {order.id for order in whole.orders.values() if order.robot == robot}
                part = await read_part(session, now, [robot], waiting | theirs)
                assert seen_of(part, robot) == seen_of(whole, robot)
                assert {order.id for order in part.waiting} == waiting
                assert part.robots.keys() == {robot}, "and no other is read"
                busy += bool(whole.stops.get(robot))
    assert busy > STEPS / 3, "robots had something to do"


async def test_a_stop_is_read_for_its_robot_and_for_its_order(world: World) -> None:
    """A stop to charge is no order's; and while an order needs a person, another robot may have a stop of it."""
    order_id = await world.place("post1", "post2")
    async with world.database.transaction() as session:
        for robot, action, order in (("r1", StopAction.DOCK, None), ("r2", StopAction.LOAD, order_id)):
            session.add(MissionRow(id=f"of-{robot}", robot=robot, created_at=world.clock.utc()))
            stop = StopRow(id=f"at-{robot}", mission_id=f"of-{robot}", position=0, post="post1", action=action)
            stop.order_id = order
            session.add(stop)
        row = await session.get_one(Order, order_id)
        row.robot, row.state = "r1", OrderState.ATTENTION
    async with world.database.reading() as session:
        whole = await read_open_work(session, world.clock.utc())
        part = await read_part(session, world.clock.utc(), ["r1"], [order_id])
    assert [stop.id for stop in whole.stops["r1"]] == ["at-r1"]
    assert order_id in whole.orders, "its robot is not free for other work"
    assert seen_of(part, "r1") == seen_of(whole, "r1")
