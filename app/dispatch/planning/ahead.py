"""Who is likely to carry the orders that nobody can take on yet, once there is charge for them: for estimates alone.

An order goes to whoever has the charge for it first, whether that is a robot that charges now or one that is still to
come to a dock; the next one then finds that robot farther away and with less. Nobody is told to do any of it.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from math import inf
from typing import Final, NamedTuple

from app.charging.acceptance import Answer, Charge, accepts
from app.charging.curve import ChargeCurve
from app.charging.energy import Use
from app.charging.levels import Thresholds
from app.dispatch.planning.scene import OpenOrder, Route, Stop
from app.traffic.journey import Goal
from app.traffic.network import Network

MOST: Final = 40
"""So many orders are looked at, the longest waiting first: who comes behind them is told what the last of them is."""
CHARGE_KEY: Final = "-ahead"
"""Ends the keys of charges that are expected here."""


@dataclass(frozen=True, slots=True)
class Free:
    """A robot from `at_s` on, when it has done all that it has: at `post`, with this charge."""

    post: int
    at_s: float
    charge: Charge
    curve: ChargeCurve


class Dock(NamedTuple):
    """From when it is free, for others than the one that has it."""

    free_s: float
    robot: str | None = None


@dataclass(frozen=True, slots=True)
class Charging:
    """Docks by their posts; and what a way of so many seconds costs."""

    docks: Mapping[int, Dock]
    thresholds: Thresholds
    drive: Callable[[float], Use]


class _Turn(NamedTuple):
    """One order with one robot: from when it has the charge for it, at `dock` if it has to go there, and when and with
    what charge it has done. Compared by the time."""

    ready_s: float
    done_s: float
    order: str
    robot: str
    ratio: float
    dock: int | None = None
    charge_s: float = 0.0


def carried_ahead(
    network: Network, free: Mapping[str, Free], orders: Iterable[OpenOrder], charging: Charging
) -> dict[str, Route]:
    """What each robot will do then, charges included; without orders that nobody ever has the charge for."""
    left = {order.id: order for order in sorted(orders, key=lambda one: (one.since_s, one.id))[:MOST]}
    robots, docks = dict(free), dict(charging.docks)
    routes: dict[str, Route] = dict.fromkeys(free, ())
    while left:
        look = _Look(network, replace(charging, docks=docks))
        turns = (look.turn(name, robot, order) for name, robot in robots.items() for order in left.values())
        turn = min((one for one in turns if one is not None), default=None)
        if turn is None:
            break
        order = left.pop(turn.order)
        robot = robots[turn.robot]
        charge = replace(robot.charge, ratio=turn.ratio, docked=False, until_full=False)
        robots[turn.robot] = replace(robot, post=order.give.post, at_s=turn.done_s, charge=charge)
        if turn.dock is not None:
            docks[turn.dock] = Dock(turn.ready_s, turn.robot)
            goal = Goal(turn.dock, turn.charge_s, key=f"{order.id}{CHARGE_KEY}")
            routes[turn.robot] += (Stop("", goal, 0),)
        routes[turn.robot] += order.stops
    return routes


@dataclass(frozen=True, slots=True)
class _Look:
    network: Network
    charging: Charging

    def turn(self, name: str, robot: Free, order: OpenOrder) -> _Turn | None:
        """None if it never has the charge."""
        if not order.may_go_with(name):
            return None
        its = self._answer(robot.post, robot, order)
        if its is None:
            return None
        if its.is_accepted:
            return self._does(name, robot, order, robot.at_s)
        turns = (self._charged(name, robot, order, dock) for dock in self.charging.docks)
        return min((turn for turn in turns if turn is not None), default=None)

    def _charged(self, name: str, robot: Free, order: OpenOrder, dock: int) -> _Turn | None:
        """It goes to this dock first."""
        way_s = self.network.shortest_s[robot.post][dock]
        there = replace(robot.charge, docked=True, ratio=self._after(robot, way_s, 0.0))
        charged = replace(robot, post=dock, charge=there)
        needed = self._answer(dock, charged, order)
        if way_s == inf or needed is None:
            return None
        thresholds = self.charging.thresholds
        wanted = thresholds.full if there.until_full else needed.needed
        comes_s = robot.at_s + way_s
        its = self.charging.docks[dock]
        begins_s = comes_s if its.robot == name else max(comes_s, its.free_s)
        ready_s = begins_s + robot.curve.time_s(there.ratio, wanted)
        full_enough = replace(charged, charge=replace(there, ratio=max(wanted, there.ratio)))
        turn = self._does(name, full_enough, order, ready_s)
        return turn._replace(dock=dock, charge_s=ready_s - comes_s)

    def _does(self, name: str, robot: Free, order: OpenOrder, ready_s: float) -> _Turn:
        drive_s, stand_s = self._work(robot.post, order)
        begins_s = max(ready_s, order.load.not_before_s - drive_s)
        return _Turn(ready_s, begins_s + drive_s + stand_s, order.id, name, self._after(robot, drive_s, stand_s))

    def _answer(self, post: int, robot: Free, order: OpenOrder) -> "_Needed | None":
        drive_s, stand_s = self._work(post, order)
        to_dock_s = self._to_dock_s(order.give.post)
        if drive_s + to_dock_s == inf:
            return None
        work = self.charging.drive(drive_s) + Use(0.0, stand_s)
        parts = [self.charging.drive(2 * self._to_dock_s(goal.post)) for goal in (order.load, order.give)]
        verdict = accepts(robot.charge, work, self.charging.drive(to_dock_s), self.charging.thresholds, parts)
        if verdict.answer is Answer.TOO_FAR:
            return None
        return _Needed(verdict.is_accepted, min(verdict.needed, self.charging.thresholds.full))

    def _work(self, post: int, order: OpenOrder) -> tuple[float, float]:
        """Seconds of driving, and of standing."""
        shortest_s = self.network.shortest_s
        drive_s = shortest_s[post][order.load.post] + shortest_s[order.load.post][order.give.post]
        return drive_s, order.load.handling_s + order.give.handling_s

    def _to_dock_s(self, post: int) -> float:
        return min((self.network.shortest_s[post][dock] for dock in self.charging.docks), default=inf)

    def _after(self, robot: Free, drive_s: float, stand_s: float) -> float:
        if drive_s == inf:
            return 0.0
        use = self.charging.drive(drive_s) + Use(0.0, stand_s)
        return max(self.charging.thresholds.critical, robot.charge.ratio - robot.charge.rates.expected(use))


class _Needed(NamedTuple):
    is_accepted: bool
    needed: float
