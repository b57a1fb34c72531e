"""What makes lives at random worth their time: one that failed can be lived again, and looked into."""

from app.tables import MessageToRobot, RobotMessage
from tests.app.orders.test_lives_at_random import LivesOfOrders


def test_a_life_is_lived_again_from_its_choices() -> None:
    """To the last id: robots and orders are found by them."""
    assert lived() == lived()


def lived() -> dict[str, list[str]]:
    life = LivesOfOrders()
    try:
        life.begin(names=7, from_post="post1", step=2, so_far="it sets out", alone=True)
        life.somebody_orders_the_same_way(number=0)
        life.a_dispatcher_reassigns(number=0, robot="r2", so_far=None)
        life.a_robot_goes_on(robot="r1", luck=["sender", "nobody comes"], hears=True)
        life.a_dispatcher_recalls_a_robot(robot="r1")
        life.a_robot_goes_on(robot="r1", luck=["arrives"], hears=True)
        return life.run(life.everything()) | life.run(life.world.everything(MessageToRobot, RobotMessage))
    finally:
        life.teardown()
