"""Why orders wait that no robot has yet, in the sentences that pages know in each language; and when they are likely to
arrive, from the same decision."""

from collections.abc import Sequence
from typing import Final, NamedTuple

from app.dispatch.held_up import NONE_CONNECTED, why_held_up
from app.dispatch.open_work import OpenWork
from fleet.assignment.comes_next import Likely
from fleet.assignment.deciding import Decision
from fleet.assignment.why import Why, why_orders_wait

BUSY: Final = "Every robot is busy."
FETCHER_BUSY: Final = "The robot that is to fetch it is busy."
ONE_AHEAD: Final = "Every robot is busy, and one order is ahead of this one."
SOME_AHEAD: Final = "Every robot is busy, and {orders} orders are ahead of this one."
MANY_AHEAD: Final = "Every robot is busy, and many orders are ahead of this one."
MOST_COUNTED: Final = 5
"""A longer queue is not counted: it changes with every order that is fetched."""
NOT_PLANNED_FOR: Final = "No robot can be planned for at the moment."
TAKES_ITS_TURN: Final = frozenset({"next", "turn", "sooner", "overdue"})
"""Codes of orders that wait for nothing but their turn: a time can be told of these."""


class Answer(NamedTuple):
    """The answer for one order. `has_time`: it only waits for its turn; `comes_in_s`: until it is given, if known."""

    order_id: str
    why: str
    has_time: bool
    comes_in_s: float | None = None


def answers(work: OpenWork, decision: Decision | None, orders: Sequence[str], likely: Likely) -> list[Answer]:
    """One for each of these orders, from one decision and what is likely after it."""
    whys = why_orders_wait(decision) if decision is not None else {}
    said = [(order, *_said(work, whys.get(order))) for order in orders]
    return [
        Answer(order, why, has_time, likely.comes_in_s.get(order) if has_time else None)
        for order, why, has_time in said
    ]


def _said(work: OpenWork, why: Why | None) -> tuple[str, bool]:
    """The sentence, and whether the order only waits for its turn."""
    if not work.connected:
        return NONE_CONNECTED, False
    known = [work.robots[name] for name in why.robots if name in work.robots] if why is not None else []
    if held_up := why_held_up(known or work.robots.values()):
        return held_up, False
    if why is None or why.code == "no_robot":
        return (BUSY, True) if _is_any_busy(work) else (NOT_PLANNED_FOR, False)
    if why.code == "robot_absent" and any(robot.is_there for robot in known):
        return BUSY, True
    if why.code == "robot_paused" and not any(robot.gives_away for robot in known):
        return BUSY, True  # each has just something to do in which it must not be disturbed
    if why.code == "turn":
        return _ahead(why.before), True
    if why.code == "sooner":
        return FETCHER_BUSY, True
    said = BUSY if why.code in ("next", "fetched", "fetched_after") else why.sentence(lambda at_s: f"{at_s:.0f} s")
    return said, why.code in TAKES_ITS_TURN


def _ahead(orders: int) -> str:
    if orders > MOST_COUNTED:
        return MANY_AHEAD
    return ONE_AHEAD if orders == 1 else SOME_AHEAD.format(orders=orders)


def _is_any_busy(work: OpenWork) -> bool:
    """A connected robot has something to do, or a person stands at it."""
    return any(
        robot.is_there and robot.held_up is None and (work.missions.get(name) or not robot.takes_work)
        for name, robot in work.robots.items()
    )
