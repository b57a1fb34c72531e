"""Which robot fetches which order: a pure function of what waits, who is free, and the map.

Thin: the oldest order first, the nearest idle robot, one order per mission. Predicted charge, several items per robot
and timetables come later behind the same function.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from maps import CampusMap, CampusMapError, shortest_route

ENOUGH_CHARGE: Final = 0.30
"""Above the ratio at which a robot's own battery plan would take it back to the dock at once (0.25 and hysteresis)."""


@dataclass(frozen=True)
class WaitingOrder:
    """An order that no robot has been given yet."""

    id: str
    from_post: str


@dataclass(frozen=True)
class IdleRobot:
    """A robot that is connected and has nothing to do. `post` is where it was last seen, if ever."""

    name: str
    post: str | None
    battery_ratio: float | None


@dataclass(frozen=True)
class Assignment:
    """This robot fetches this order."""

    order_id: str
    robot: str


def choose_robot(waiting: Sequence[WaitingOrder], robots: Sequence[IdleRobot], campus: CampusMap) -> Assignment | None:
    """The next assignment, for the first of `waiting` (longest first); None if there is none to make."""
    able = [robot for robot in robots if has_enough_charge(robot)]
    if not waiting or not able:
        return None
    order = waiting[0]
    nearest = min(able, key=lambda robot: (_way_m(robot, order, campus), robot.name))
    return Assignment(order.id, nearest.name)


def has_enough_charge(robot: IdleRobot) -> bool:
    """Whether a robot may be given work; one that has not said how full it is may not."""
    return robot.battery_ratio is not None and robot.battery_ratio >= ENOUGH_CHARGE


def why_nobody_comes(robots: Sequence[IdleRobot], connected: int) -> str:
    """Why an order waits, in words."""
    if connected == 0:
        return "No robot is connected at the moment."
    if not robots:
        return "Every robot is busy."
    return "The free robots are charging first."


def _way_m(robot: IdleRobot, order: WaitingOrder, campus: CampusMap) -> float:
    """A robot that has not been seen yet, or where our map does not reach, is the last choice."""
    if robot.post is None:
        return math.inf
    try:
        return shortest_route(campus, robot.post, order.from_post).length_m
    except CampusMapError:
        return math.inf
