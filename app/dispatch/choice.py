"""Which robot fetches which order: a pure function of what waits, who is free, and the map.

Thin: who has waited longest first (priority counts like waiting), the nearest idle robot that has the charge for it
(`charge_limits.py`). What is taken along on the way: `insertion.py`.
"""

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from heapq import merge
from typing import Final

from maps.ways import Ways

ENOUGH_CHARGE: Final = 0.30
"""Not for any order: above the ratio at which a robot's own battery plan would take it back to the dock at once (0.25
and hysteresis). What an order needs beyond that: `charge_limits.py`."""


@dataclass(frozen=True)
class WaitingOrder:
    """An order that no robot has been given yet. `wanted` is the only robot that may fetch it, `avoided` may not, nor
    any that is still `dropping` it."""

    id: str
    from_post: str
    to_post: str = ""
    wanted: str | None = None
    avoided: str | None = None
    dropping: frozenset[str] = frozenset()

    def may_go_with(self, robot: str) -> bool:
        if robot in self.dropping:
            return False
        return robot == self.wanted if self.wanted is not None else robot != self.avoided


@dataclass(frozen=True)
class IdleRobot:
    """A robot that is connected and has nothing to do. `post` is where it was last seen, if ever; at `home` (a post) it
    charges when it has nothing to do; `docked`: None if it does not tell."""

    name: str
    post: str | None
    battery_ratio: float | None
    charging: bool = False
    docked: bool | None = None
    home: str | None = None


@dataclass(frozen=True)
class Assignment:
    """This robot fetches this order."""

    order_id: str
    robot: str


MayTake = Callable[[IdleRobot, WaitingOrder], bool]
"""Whether a robot has the charge for an order."""


def choose_robots(
    waiting: Iterable[WaitingOrder], robots: Sequence[IdleRobot], ways: Ways, may_take: MayTake = lambda *_: True
) -> list[Assignment]:
    """Assign robots to orders: the first of `waiting` (longest first) chooses first, the nearest of those who may."""
    free: defaultdict[str | None, list[IdleRobot]] = defaultdict(list)
    for robot in sorted(filter(has_enough_charge, robots), key=_name):
        free[robot.post].append(robot)
    chosen = []
    for order in waiting:
        nearest = _nearest(order, free, ways, may_take)
        if nearest is not None:
            chosen.append(Assignment(order.id, nearest.name))
            free[nearest.post].remove(nearest)
    return chosen


def _nearest(
    order: WaitingOrder, free: Mapping[str | None, Sequence[IdleRobot]], ways: Ways, may_take: MayTake
) -> IdleRobot | None:
    """Of equally near ones the first by name. `free`: by post, in that order; posts are few where robots are many."""
    lengths_m = {post: ways.length_m(post, order.from_post) for post, robots in free.items() if robots}
    for length_m in sorted(set(lengths_m.values())):
        there = (free[post] for post in lengths_m if lengths_m[post] == length_m)
        for robot in merge(*there, key=_name):
            if order.may_go_with(robot.name) and may_take(robot, order):
                return robot
    return None


def _name(robot: IdleRobot) -> str:
    return robot.name


def has_enough_charge(robot: IdleRobot) -> bool:
    """Tell if a robot may be given work; one that has not said how full it is may not."""
    return robot.battery_ratio is not None and robot.battery_ratio >= ENOUGH_CHARGE


def why_nobody_comes(robots: Sequence[IdleRobot], connected: int) -> str:
    """Why an order waits, in words."""
    if connected == 0:
        return NONE_CONNECTED
    if not robots:
        return BUSY
    if not any(has_enough_charge(robot) for robot in robots):
        return CHARGING
    return FETCHER_BUSY


NONE_CONNECTED: Final = "No robot is connected at the moment."
BUSY: Final = "Every robot is busy."
FETCHER_BUSY: Final = "The robot that is to fetch it is busy."
CHARGING: Final = "The free robots are charging first."
NOT_ENOUGH_FOR_IT: Final = "No free robot has enough charge for this way yet."


def lacks_charge(order: WaitingOrder, robots: Sequence[IdleRobot], may_take: MayTake) -> bool:
    """Tell if it is for that alone that no free robot fetches this order, though some could work."""
    able = [robot for robot in robots if has_enough_charge(robot) and order.may_go_with(robot.name)]
    return bool(able) and not any(may_take(robot, order) for robot in able)
