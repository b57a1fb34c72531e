"""A robot goes on without network while people at the service wish for things."""

from app.models import Order, OrderState
from tests.app.orders.lives import World
from tests.app.orders.what_holds import Record


async def test_a_robot_that_is_asked_too_late_to_wait_longer_does_not_go_back_for_mail_that_is_delivered(
    world: World,
) -> None:
    order_id = await world.place("post1", "post2")
    await world.dispatch()
    await world.hear("r1")
    world.act("r1", "arrives")
    await world.speak("r1")
    await world.change(world.orders.waiting.extend_wait, "sender", order_id, None)
    await world.dispatch()
    for _ in range(6):
        world.act("r1", "sender")
    assert world.where[order_id] == "recipient"
    await world.hear("r1")
    assert world.robots["r1"].still_to_do() == set()
    await world.speak("r1")
    assert [order.state for order in await world.rows(Order)] == [OrderState.DELIVERED]
    await Record(world).check()
