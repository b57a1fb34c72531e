"""An order goes to a robot for which it is better, as long as the first has not begun it, and never after."""

from collections.abc import AsyncIterator
from pathlib import Path

import pytest

from app.models import Order, OrderState
from tests.app.orders.lives import World


@pytest.fixture
async def world(sqlite_at_head: Path, tmp_path: Path) -> AsyncIterator[World]:
    """Ways take long. r1 is at post5, and r2, at post2, cannot be reached yet."""
    world = World(sqlite_at_head, tmp_path / "data", assumed_speed_m_s=0.02)
    await world.begin()
    await world.set_online("r2", False)
    yield world
    await world.end()


async def given(world: World) -> tuple[str, str]:
    """Two orders for r1: it is told of both, and sets out for the first."""
    first, second = await world.place("post5", "post4"), await world.place("post2", "post3")
    await world.goes_on("r1", "sets out")
    assert await robots_of(world, first, second) == ["r1", "r1"]
    return first, second


async def robots_of(world: World, *order_ids: str) -> list[str | None]:
    orders = {order.id: order for order in await world.rows(Order)}
    return [orders[one].robot for one in order_ids]


async def test_it_goes_to_the_better_robot_once_the_first_has_let_it_go(world: World) -> None:
    first, second = await given(world)
    await world.set_online("r2", True)
    await world.dispatch()
    assert await robots_of(world, first, second) == ["r1", "r1"], "no other robot fetches it before r1 has answered"
    await world.goes_on("r1")
    await world.dispatch()
    assert await robots_of(world, first, second) == ["r1", "r2"]
    await world.goes_on("r2", "sender", "recipient")
    await world.goes_on("r2", "sender", "recipient")
    assert (await world.rows(Order, id=second))[0].state is OrderState.DELIVERED


async def test_it_stays_with_the_robot_that_has_set_out_for_it(world: World) -> None:
    first, second = await given(world)
    await world.goes_on("r1", "sender", "sender", "sets out")
    begun = [order.id for order in await world.rows(Order) if order.state is not OrderState.ASSIGNED]
    assert sorted(begun) == sorted([first, second])
    await world.set_online("r2", True)
    for _ in range(3):
        await world.dispatch()
        await world.goes_on("r1")
    assert await robots_of(world, first, second) == ["r1", "r1"]
