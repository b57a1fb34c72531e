"""Reasons why an order waits, from its own row and its robot's; never from another order's stop."""

from datetime import datetime
from typing import Final

from app.core.texts.reasons import words_of
from app.models import Order, OrderState, RobotRow
from app.orders.views.robot_view import RobotView, why_of_robot
from protocol.parts import Activity

OTHER_STOP_FIRST: Final = "The robot serves another stop first."
FOR_LATER: Final = "It is ordered for later."
NO_ROBOT_YET: Final = "A robot is being chosen."
NO_NETWORK: Final = "The robot has no network at the moment. The time is known again when it reports."
TAKES_LONGER: Final = "It takes longer than expected. A new time is being worked out."
WORKED_OUT: Final = "The time is being worked out."
AT_A_STOP: Final = frozenset({OrderState.AT_SENDER, OrderState.AT_RECIPIENT, OrderState.AT_RETURN})
OF_A_STOP: Final = frozenset({"why.sender", "why.recipient", "why.to_return"})
"""Texts that name the person for whom a robot waits."""
STANDS: Final = frozenset({Activity.WAITING, Activity.CHARGING, Activity.STOPPED})
PAUSED: Final = frozenset({"why.paused", "why.paused_at"})


def why_it_waits(order: Order, robot: RobotRow | None) -> str | None:
    """The reason kept with the order, else its robot's, unless that is about another order's stop."""
    if order.why or robot is None:
        return order.why
    why = why_of_robot(robot)
    return OTHER_STOP_FIRST if order.state not in AT_A_STOP and is_about_a_stop(why) else why


def as_of_order(robot: RobotView, why: str | None) -> RobotView:
    """The robot as the people of one order see it: without the stop of another."""
    if why != OTHER_STOP_FIRST:
        return robot
    return robot.model_copy(update={"why": why, "why_words": words_of(why)})


def is_about_a_stop(why: str | None) -> bool:
    words = words_of(why) if why else None
    return words is not None and words.key in OF_A_STOP


def why_no_time(order: Order, robot: RobotRow | None, now: datetime) -> str:
    """The reason for which no time is known, where nothing else is said of the order."""
    if order.state is OrderState.QUEUED:
        return FOR_LATER if order.not_before is not None and order.not_before > now else NO_ROBOT_YET
    if robot is not None and not robot.online:
        return NO_NETWORK
    return WORKED_OUT if order.expected_to is None else TAKES_LONGER


def is_waiting(robot: RobotRow) -> bool:
    """A robot that stands for a reason; one that drives says what it does, which is no reason to wait."""
    return robot.activity in STANDS or robot.waits_for is not None or robot.taken_out_at is not None


def is_held_up(robot: RobotRow) -> bool:
    """A robot that goes on only when a person has helped it, or has let it go on."""
    words = words_of(robot.why) if robot.why else None
    is_paused = words is not None and words.key in PAUSED
    return robot.activity == Activity.STOPPED or robot.taken_out_at is not None or is_paused
