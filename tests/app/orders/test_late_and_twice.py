"""Reports of robots that come late, twice, or after another decision; and the messages to robots meanwhile."""

from contextlib import suppress

import pytest

from app.core.errors import ServiceError
from app.models import Alarm, Handover, MissionRow, Notification, Order, OrderEvent, RobotCommand, StopRow
from app.models import OrderState as S
from protocol.parts import Purpose
from protocol.proofs import ShownCode
from protocol.to_server import CommandAnswer, Event
from tests.app.orders.lives import World
from tests.app.orders.what_holds import Record

ALL_DONE = ["sender"] * 6


async def everything(world: World) -> dict[str, list[str]]:
    return await world.everything(Order, OrderEvent, Notification, Handover, MissionRow, StopRow, Alarm, RobotCommand)


async def two_on_one_way(world: World) -> tuple[str, str]:
    """One whose mail is aboard of r1, and one for which it is still to come."""
    first = await world.place("post3", "post4")
    await world.goes_on("r1", "sets out")
    second = await world.place("post3", "post4")
    await world.goes_on("r1")
    assert await world.state(second) is S.ASSIGNED, "it goes along"
    await world.goes_on("r1", "sender")
    assert [await world.state(one) for one in (first, second)] == [S.CARRYING, S.ASSIGNED]
    return first, second


async def test_an_update_that_crosses_with_an_answer_does_not_give_again_what_was_to_be_dropped(world: World) -> None:
    aboard, waiting = await two_on_one_way(world)
    await world.change(world.orders.cancelling.cancel, "sender", waiting, "")
    await world.dispatch()
    await world.hear("r1")
    await world.change(world.orders.returning.recall, "sender", aboard)
    await world.goes_on("r1")
    assert await world.state(waiting) is S.CANCELLED
    await Record(world).check()
    await world.goes_on("r1", *ALL_DONE)
    assert world.where == {aboard: "sender", waiting: "sender"}
    assert await world.state(aboard) is S.RETURNED
    await Record(world).check()


async def test_who_has_fetched_the_mail_is_its_robot_though_it_was_given_to_another_meanwhile(world: World) -> None:
    order_id = await world.place("post3", "post5")
    await world.goes_on("r1", "arrives")
    await given_to_r2(world, order_id)
    await world.goes_on("r2", "sets out")
    world.act("r1", "sender")
    await world.set_online("r1", True)
    await world.goes_on("r1")
    (order,) = await world.rows(Order)
    assert (order.state, order.robot) == (S.CARRYING, "r1")
    await world.goes_on("r2")
    assert world.robots["r2"].still_to_do() == set(), "the other need not come"
    await Record(world).check()
    await world.goes_on("r1", *ALL_DONE)
    assert await world.state(order_id) is S.DELIVERED
    await Record(world).check()


async def test_a_robot_that_comes_where_it_was_to_go_before_turns_no_mail_round_again(world: World) -> None:
    order_id = await world.place("post3", "post5")
    await world.goes_on("r1", "sender", "sets out")
    await world.change(world.orders.intervening.stop_for_attention, "dispatcher", order_id, "It is not heard of.")
    await world.change(world.orders.intervening.resolve, "dispatcher", order_id, "returning", None)
    world.act("r1", "arrives")
    await world.speak("r1")
    assert await world.state(order_id) is S.RETURNING
    await world.goes_on("r1", *ALL_DONE)
    assert await world.state(order_id) is S.RETURNED
    await Record(world).check()


async def test_an_answer_that_comes_again_drops_nothing_that_was_given_since(world: World) -> None:
    _, waiting = await two_on_one_way(world)
    await world.change(world.orders.intervening.reassign, "dispatcher", waiting, None)
    await world.goes_on("r1")
    await world.change(world.orders.intervening.reassign, "dispatcher", waiting, "r1")
    await world.goes_on("r1")
    assert await world.state(waiting) is S.ASSIGNED
    (answer,) = (one for one in world.robots["r1"].said if isinstance(one.happened, CommandAnswer))
    before = await everything(world)
    await says(world, answer)
    assert await everything(world) == before


async def says(world: World, event: Event) -> None:
    """Once more, in a message of its own."""
    world.robots["r1"].outbox.put(event)
    await world.speak("r1")


async def test_a_message_that_was_not_acknowledged_comes_again_and_changes_nothing(world: World) -> None:
    """A fault that is over rings no second time."""
    order_id = await world.place("post3", "post5")
    await world.goes_on("r1", "sender")
    for is_over in (False, True):
        world.robots["r1"].missions.report_fault("wheel_drop", "The robot was lifted.", "post3", cleared=is_over)
    await world.speak("r1", is_heard=False)
    before = await everything(world)
    assert [event.state for event in await world.rows(OrderEvent, order_id=order_id)][-2:] == [S.ATTENTION, S.CARRYING]
    await world.speak("r1")
    assert await everything(world) == before


async def test_a_robot_gives_only_what_it_was_given(world: World) -> None:
    order_id = await world.place("post3", "post5")
    await world.goes_on("r1", "arrives")
    missions = world.robots["r1"].missions
    assert missions.held.mission is not None
    place = missions.at_stop(missions.held.mission.stops[1].id)
    missions.handed_over(
        place, Purpose.RECEIVE, "post5", ShownCode(missions.codes(order_id, Purpose.RECEIVE)[0], b"key")
    )
    await world.speak("r1")
    assert [one.code for one in world.robots["r1"].refused] == ["transition_refused"]
    assert await world.rows(Handover) == []
    assert await world.state(order_id) is S.AT_SENDER


async def test_mail_comes_aboard_once_whichever_robot_says_that_it_has_it_too(world: World) -> None:
    order_id = await world.place("post3", "post5")
    await world.goes_on("r1", "arrives")
    await given_to_r2(world, order_id)
    await world.goes_on("r2", "sender")
    assert await world.state(order_id) is S.CARRYING
    world.where[order_id] = "sender"  # or so r1 thinks
    world.act("r1", "sender")
    world.where[order_id] = "r2"
    await world.set_online("r1", True)
    await world.speak("r1")
    assert [one.code for one in world.robots["r1"].refused] == ["transition_refused"]
    assert [one.robot for one in await world.rows(Handover)] == ["r2"]
    await Record(world).check()


async def test_an_update_that_crosses_with_the_robots_own_way_back_is_what_it_does_and_all_of_it_ends(
    world: World,
) -> None:
    order_id = await world.place("post3", "post5")
    await world.goes_on("r1", "sender")
    world.act("r1", "no way")
    world.act("r1", "")  # it has finished, and goes back by itself
    await world.change(world.orders.returning.recall, "sender", order_id)
    await world.goes_on("r1")
    await Record(world).check()
    await world.goes_on("r1", *ALL_DONE)
    assert await world.state(order_id) is S.RETURNED
    assert await world.rows(MissionRow, state="active") == []
    await Record(world).check()


async def given_to_r2(world: World, order_id: str) -> None:
    """By a dispatcher, while r1 is out of network."""
    await world.set_online("r1", False)
    await world.set_online("r2", True)
    await world.change(world.orders.intervening.stop_for_attention, "dispatcher", order_id, "It is not heard of.")
    await world.change(world.orders.intervening.resolve, "dispatcher", order_id, "queued", None)


@pytest.mark.parametrize("end", ["delivered", "returned", "held", "cancelled", "expired"])
@pytest.mark.slow
async def test_what_has_ended_has_ended_for_everybody(world: World, end: str) -> None:
    order_id = await ended(world, end)
    assert await world.state(order_id) == end
    orders, before = world.orders, await everything(world)
    wishes = (
        (orders.intervening.stop_for_attention, "It does not move."),
        *((orders.intervening.resolve, to, None) for to in ("resume", "returning", "held", "queued", "cancelled")),
        (orders.intervening.hold, None),
        (orders.intervening.reassign, "r2"),
        (orders.returning.recall,),
        (orders.cancelling.cancel, ""),
        (orders.waiting.extend_wait, None),
    )
    for what, *arguments in wishes:
        with suppress(ServiceError):  # refused, or granted because it is so already
            await world.change(what, "dispatcher", order_id, *arguments)
        assert await everything(world) == before, what
    await Record(world).check()


async def ended(world: World, end: str) -> str:
    order_id = await world.place("post3", "post5")
    if end == "cancelled":
        await world.change(world.orders.cancelling.cancel, "sender", order_id, "")
    elif end == "expired":
        await world.goes_on("r1", "no person comes")
    elif end == "delivered":
        await world.goes_on("r1", *ALL_DONE)
    else:
        await world.goes_on("r1", "sender")
        await world.change(world.orders.returning.recall, "sender", order_id)
        await world.goes_on("r1", {"held": "mailroom", "returned": "sender"}[end])
    return order_id
