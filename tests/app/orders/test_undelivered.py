"""Where mail goes that is not taken, as the campus has set it."""

from collections.abc import AsyncIterator
from dataclasses import replace
from pathlib import Path

import pytest

from app.models import Order, OrderState
from tests.app.orders.lives import TRACK, World
from tests.app.orders.what_holds import Record

MAILROOM = "post3"


@pytest.fixture
async def world(sqlite_at_head: Path, tmp_path: Path) -> AsyncIterator[World]:
    posts = {name: replace(post, mailroom=name == MAILROOM) for name, post in TRACK.posts.items()}
    world = World(sqlite_at_head, tmp_path / "data", replace(TRACK, posts=posts), undelivered_to="mailroom")
    await world.begin()
    await world.set_online("r2", False)
    yield world
    await world.end()


async def test_mail_that_is_not_taken_goes_to_the_mailroom_where_the_campus_wants_it(world: World) -> None:
    order_id = await world.place("post1", "post2")
    await world.goes_on("r1", "sender", "no person comes")
    [order] = await world.rows(Order, id=order_id)
    assert (order.state, order.return_post) == (OrderState.RETURNING, MAILROOM)
    await world.goes_on("r1", "mailroom", "mailroom")
    assert await world.state(order_id) is OrderState.HELD
    assert world.where[order_id] == "mailroom"
    await Record(world).check()
