"""The right to hand over now: pure decisions on an order, its delegates and a person."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Final

from app.handover import errors
from app.models import Delegate, Order, OrderState, Person, Role
from app.orders.custody.codes import TURNS, HandoverCode, Holder, codes_of, mailrooms_turn, turn_of
from app.orders.transitions import ENDED, NOTHING_ABOARD
from app.orders.views.views import HANDOVER_PURPOSES, MyRole
from protocol.parts import Purpose

WAITS: Final[Mapping[OrderState, Purpose]] = {
    OrderState.AT_SENDER: Purpose.LOAD,
    OrderState.AT_RECIPIENT: Purpose.RECEIVE,
    OrderState.AT_RETURN: Purpose.RETURN,
}
"""Where the robot waits for a hand-over."""


def code_for(order: Order, person: Person, delegates: Iterable[Delegate]) -> HandoverCode | None:
    """The code that this person may show or tap with, as things stand."""
    turn = TURNS.get(order.state)
    codes = [code for code in codes_of(order, delegates) if code.purpose is turn]
    if turn is not None and turn_of(order, person.id) is turn:
        return next(code for code in codes if code.holder in (Holder.SENDER, Holder.RECIPIENT))
    if (turn is Purpose.RETURN or mailrooms_turn(order)) and person.has_role(Role.DISPATCHER):
        return next(code for code in codes if code.holder is Holder.MAILROOM)
    return next((code for code in codes if code.delegate and code.delegate.email == person.email), None)


def codes_by_digits(order: Order, delegates: Iterable[Delegate]) -> Sequence[HandoverCode]:
    """The codes whose digits open the hand-over that the robot waits for."""
    purpose = WAITS.get(order.state)
    return [code for code in codes_of(order, delegates) if code.purpose is purpose]


def check_waits(order: Order) -> Purpose:
    """Return what the robot waits for. Raises RobotNotThere."""
    if order.state not in WAITS:
        raise errors.RobotNotThere("The robot does not wait for a hand-over of this order now.")
    return WAITS[order.state]


def purpose_to_delegate(order: Order, role: MyRole, requested: Purpose | None) -> Purpose:
    """Return the purpose of a new delegate. Raises NotYoursToDelegate, TooLateToDelegate."""
    purpose = requested or HANDOVER_PURPOSES[role][0]
    if purpose not in HANDOVER_PURPOSES[role]:
        raise errors.NotYoursToDelegate("The sender names who loads or takes back, the recipient who receives.")
    loading_is_over = order.state not in NOTHING_ABOARD or order.is_passed_on
    if order.state in ENDED or (purpose is Purpose.LOAD and loading_is_over):
        raise errors.TooLateToDelegate("This hand-over is over: there is nothing left that a delegate could do.")
    return purpose


def may_see(delegate: Delegate, role: MyRole) -> bool:
    """Sender and recipient see whom they may name themselves."""
    return Purpose(delegate.purpose) in HANDOVER_PURPOSES[role]
