"""Ends that lives at random did not come to, told as they went."""

import pytest

from app.dispatch.held_up import SENTENCES, NoRobotComes
from app.dispatch.open_work import HeldUp
from app.models import Alarm, MissionRow, Order, OrderEvent, OrderState
from app.orders.errors import TransitionRefused
from app.robots.alarms import raise_alarm
from tests.app.orders.lives import World
from tests.app.orders.what_holds import Record

WEEK_S = 7 * 86400.0


async def test_mail_that_a_dispatcher_sends_back_can_be_taken_however_old_its_codes_are(world: World) -> None:
    order_id = await world.place("post1", "post2")
    await world.goes_on("r1", "sender")
    world.clock.advance(WEEK_S)
    await world.goes_on("r1", *["sender"] * 6)
    assert await world.state(order_id) is OrderState.ATTENTION, "all codes were too old"
    await world.change(world.orders.intervening.resolve, "dispatcher", order_id, "returning", "Once more.")
    await world.goes_on("r1", *["sender"] * 6)
    assert await world.state(order_id) is OrderState.RETURNED
    assert world.where[order_id] == "sender"
    await Record(world).check()


async def test_mail_that_a_dispatcher_sends_on_can_be_taken_however_old_its_codes_are(world: World) -> None:
    order_id = await world.place("post1", "post2")
    await world.goes_on("r1", "sender", "no way")
    world.clock.advance(WEEK_S)
    await world.goes_on("r1", *["sender"] * 6)
    await world.change(world.orders.intervening.resolve, "dispatcher", order_id, "resume", "Once more.")
    await world.goes_on("r1", *["sender"] * 6)
    assert await world.state(order_id) is OrderState.RETURNED


async def test_an_order_that_a_robot_dropped_and_is_given_again_is_fetched(world: World) -> None:
    first = await world.place("post3", "post4")
    await world.goes_on("r1", "sets out")
    second = await world.place("post3", "post4")
    await world.goes_on("r1")
    assert await world.state(second) is OrderState.ASSIGNED, "it goes along"
    await world.change(world.orders.intervening.reassign, "dispatcher", second, None)
    await world.goes_on("r1")
    await world.change(world.orders.intervening.reassign, "dispatcher", second, "r1")
    await world.goes_on("r1", *["sender"] * 6)
    await Record(world).check()
    assert [await world.state(one) for one in (first, second)] == [OrderState.DELIVERED] * 2


async def left_aboard(world: World) -> str:
    """Mail that neither recipient nor sender took: it is still in r1, which has nothing to do."""
    order_id = await world.place("post3", "post5")
    await world.goes_on("r1", "sender")
    await world.goes_on("r1", *["no person comes"] * 6)
    assert await world.state(order_id) is OrderState.ATTENTION
    assert world.robots["r1"].missions.held.mission is None
    return order_id


async def loaded_too_late(world: World) -> str:
    """Given up on by a dispatcher, while its robot stands where it gets the mail, and gets it."""
    order_id = await world.place("post3", "post5")
    await world.goes_on("r1", "arrives")
    await world.set_online("r1", False)
    await world.change(world.orders.intervening.stop_for_attention, "dispatcher", order_id, "It is not heard of.")
    await world.change(world.orders.intervening.resolve, "dispatcher", order_id, "cancelled", None)
    world.act("r1", "sender")
    await world.set_online("r1", True)
    await world.speak("r1")
    return order_id


async def ringing(world: World) -> set[str]:
    return {alarm.name for alarm in await world.rows(Alarm) if alarm.cleared_at is None}


async def test_mail_that_came_aboard_when_its_order_had_ended_rings_and_is_brought_back(world: World) -> None:
    order_id = await loaded_too_late(world)
    assert "custody_contradicts_order" in await ringing(world)
    for _ in range(3):
        await world.goes_on("r1", *["sender"] * 3)
    assert world.where[order_id] == "sender", "no robot carried it to its recipient"
    assert await world.state(order_id) is OrderState.CANCELLED
    assert "custody_contradicts_order" not in await ringing(world)
    assert await world.rows(MissionRow, state="active") == []
    await Record(world).check()


async def test_what_was_not_taken_back_of_an_order_that_has_ended_is_brought_again_by_a_robot_that_is_recalled(
    world: World,
) -> None:
    order_id = await loaded_too_late(world)
    for _ in range(3):
        await world.goes_on("r1", *["no person comes"] * 6)
    assert world.where[order_id] == "r1"
    assert {"custody_contradicts_order", "mail_aboard"} <= await ringing(world)
    await world.recall("r1")
    await world.goes_on("r1", *["sender"] * 6)
    assert world.where[order_id] == "sender"
    assert not {"custody_contradicts_order", "mail_aboard", "transition_refused"} & await ringing(world)
    await Record(world).check()


async def given_back_by_one_and_offered_to_another(world: World) -> str:
    """Its sender has it again and the order has ended; r1, given up on, stands there still and has heard nothing."""
    order_id = await world.place("post3", "post5")
    await world.goes_on("r1", "arrives")
    await world.set_online("r1", False)
    await world.change(world.orders.intervening.stop_for_attention, "dispatcher", order_id, "It is not heard of.")
    await world.change(world.orders.intervening.resolve, "dispatcher", order_id, "queued", None)
    await world.set_online("r2", True)
    await world.goes_on("r2", "sender")
    await world.change(world.orders.returning.recall, "sender", order_id)
    await world.goes_on("r2", *["sender"] * 4)
    assert await world.state(order_id) is OrderState.RETURNED
    return order_id


async def test_mail_that_was_given_back_and_loaded_again_is_known_to_be_aboard_and_rings_until_it_is_out(
    world: World,
) -> None:
    order_id = await given_back_by_one_and_offered_to_another(world)
    world.act("r1", "sender")
    await world.set_online("r1", True)
    await world.speak("r1")
    await Record(world).check()
    assert "custody_contradicts_order" in await ringing(world)
    assert world.where[order_id] == "r1"
    for _ in range(3):
        await world.goes_on("r1", *["sender"] * 6)
    assert world.where[order_id] == "recipient", "the robot was on its way there before it heard"
    assert await world.state(order_id) is OrderState.RETURNED, "ended means ended"
    assert "custody_contradicts_order" not in await ringing(world)
    assert await world.rows(MissionRow, state="active") == []
    await Record(world).check()


async def test_mail_that_was_given_back_loaded_again_and_delivered_unheard_is_with_its_recipient(world: World) -> None:
    order_id = await given_back_by_one_and_offered_to_another(world)
    for luck in ("sender", "recipient", "recipient"):
        world.act("r1", luck)
    assert world.where[order_id] == "recipient"
    await world.set_online("r1", True)
    await world.speak("r1")
    await Record(world).check()
    assert await world.state(order_id) is OrderState.RETURNED, "ended means ended"
    assert world.robots["r1"].missions.held.cargo == ()


async def test_mail_of_an_order_that_has_ended_is_taken_out_by_hand_and_its_robot_is_free(world: World) -> None:
    order_id = await loaded_too_late(world)
    await world.change(world.orders.intervening.hold, "dispatcher", order_id, "Fetched at the post.")
    world.where[order_id] = "mailroom"
    await world.goes_on("r1")
    await world.goes_on("r1")
    assert await world.state(order_id) is OrderState.CANCELLED, "ended means ended"
    (order,) = await world.rows(Order, id=order_id)
    (told,) = [one for one in await world.rows(OrderEvent, order_id=order_id) if one.seq == order.version]
    assert (told.kind, told.reason) == ("taken_out", "Fetched at the post.")
    assert world.robots["r1"].missions.held.cargo == ()
    assert await ringing(world) == set()
    assert await world.rows(MissionRow, state="active") == []
    await Record(world).check()
    with pytest.raises(TransitionRefused, match="no robot has its mail"):
        await world.change(world.orders.intervening.hold, "dispatcher", order_id, "Once more.")
    another = await world.place("post3", "post5")
    await world.goes_on("r1", *["sender"] * 6)
    assert await world.state(another) is OrderState.DELIVERED


async def test_mail_of_an_order_that_has_ended_is_brought_again_when_it_is_called_back(world: World) -> None:
    order_id = await loaded_too_late(world)
    for _ in range(3):
        await world.goes_on("r1", *["no person comes"] * 6)
    assert world.where[order_id] == "r1"
    await world.change(world.orders.returning.recall, "dispatcher", order_id)
    await world.change(world.orders.returning.recall, "dispatcher", order_id)
    for _ in range(3):
        await world.goes_on("r1", *["sender"] * 6)
    assert world.where[order_id] == "sender"
    assert await world.state(order_id) is OrderState.CANCELLED
    assert not {"custody_contradicts_order", "mail_aboard"} & await ringing(world)
    await Record(world).check()


async def test_two_mails_that_should_not_be_aboard_ring_apart_until_each_is_out(world: World) -> None:
    one = await loaded_too_late(world)
    now = world.clock.utc()
    async with world.database.transaction() as session:
        await raise_alarm(session, "r1", "custody_contradicts_order", "Order another is cancelled. But …", now=now)
    assert [alarm.name for alarm in await world.rows(Alarm, cleared_at=None)] == ["custody_contradicts_order"] * 2
    await world.change(world.orders.intervening.hold, "dispatcher", one, None)
    world.where[one] = "mailroom"
    await world.goes_on("r1")
    (left,) = await world.rows(Alarm, cleared_at=None)
    assert left.reason.startswith("Order another")


async def test_a_mission_whose_mail_is_out_before_it_is_told_is_over(world: World) -> None:
    order_id = await left_aboard(world)
    await world.recall("r1")
    await world.hear("r1")
    world.clock.advance(1.0)
    await world.change(world.orders.intervening.resolve, "dispatcher", order_id, "returning", "Once more.")
    for _ in range(3):
        world.act("r1", "sender")
    await world.goes_on("r1")
    assert await world.state(order_id) is OrderState.RETURNED
    assert await world.rows(MissionRow, state="active") == [], "the robot is free"
    another = await world.place("post3", "post5")
    await world.goes_on("r1", *["sender"] * 6)
    assert await world.state(another) is OrderState.DELIVERED


async def test_a_robot_that_could_not_get_to_two_senders_takes_other_work_while_a_dispatcher_decides(
    world: World,
) -> None:
    """As many as it can carry: none of them is aboard, so none takes a place in it or keeps it where it is."""
    given_up = [await world.place("post3", "post4"), await world.place("post3", "post4")]
    await world.goes_on("r1", *["no way"] * 4, "")  # to each sender, and to no recipient
    assert [await world.state(one) for one in given_up] == [OrderState.ATTENTION] * 2
    others = [await world.place("post3", "post5"), await world.place("post3", "post5")]
    await world.dispatch()
    async with world.database.reading() as session:
        assert await NoRobotComes(world.fleet).why(session) is None
    assert [await world.state(one) for one in others] == [OrderState.ASSIGNED] * 2
    for _ in range(3):
        await world.goes_on("r1", *["sender"] * 6)
    assert [await world.state(one) for one in others] == [OrderState.DELIVERED] * 2
    await Record(world).check()


async def test_a_robot_with_stuck_mail_is_kept_from_other_work_and_the_reason_says_so(world: World) -> None:
    await left_aboard(world)
    other = await world.place("post3", "post5")
    await world.dispatch()
    (order,) = await world.rows(Order, id=other)
    assert (order.state, order.why) == (OrderState.QUEUED, SENTENCES[HeldUp.STUCK_MAIL])
