"""Replay of random lives: one that failed can be lived again, and examined."""

import pytest

from app.models import MessageToRobot, Order, OrderState, RobotMessage
from tests.app.orders.test_lives_at_random import LivesOfOrders


@pytest.mark.slow
def test_a_life_is_lived_again_from_its_choices() -> None:
    """To the last id: robots and orders are found by them."""
    assert lived() == lived()


def lived() -> dict[str, list[str]]:
    life = LivesOfOrders()
    try:
        life.begin(names=7, from_post="post1", step=2, so_far="it sets out", alone=True)
        life.a_sender_orders_the_same_way(number=0)
        life.a_dispatcher_reassigns(number=0, robot="r2", so_far=None)
        life.a_robot_goes_on(robot="r1", luck=["sender", "no person comes"], hears=True)
        life.a_dispatcher_recalls_a_robot(robot="r1")
        life.a_robot_goes_on(robot="r1", luck=["arrives"], hears=True)
        return life.run(life.everything()) | life.run(life.world.everything(MessageToRobot, RobotMessage))
    finally:
        life.teardown()


def test_mail_that_was_passed_on_may_be_delivered_after_its_order_has_ended() -> None:
    """Custody follows the receipts; the order stays as it ended (decision 0044)."""
    life = LivesOfOrders()
    life.begin(names=421, from_post="post4", step=3, so_far="it sets out with it", alone=False)
    life.a_dispatcher_passes_mail_on(number=0, post="post4", so_far=None)
    life.dispatch_looks()
    (order,) = life.run(life.world.rows(Order))
    life.a_robot_hears(robot=order.robot, count=4)
    life.the_network_comes_and_goes(robot=order.robot, online=False)
    life.a_dispatcher_stops_an_order(number=0, so_far=None)
    assert life.tries(life.world.orders.intervening.resolve, "dispatcher", order.id, "held", "It is in the mailroom.")
    for luck in ("arrives", "mailroom", "arrives", "recipient"):
        life.a_robot_acts(robot=order.robot, luck=luck)
    life.the_network_comes_and_goes(robot=order.robot, online=True)
    life.a_robot_speaks(robot=order.robot, count=40, is_heard=True)
    (order,) = life.run(life.world.rows(Order))
    assert (order.state, life.world.where[order.id]) == (OrderState.HELD, "recipient")
    life.everything_holds()
    life.teardown()
