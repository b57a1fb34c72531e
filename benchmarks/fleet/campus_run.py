"""One simulated campus for some days: robots, their links, the service, orders in rush hours, and what goes wrong."""

from collections import Counter
from dataclasses import dataclass
from random import Random
from typing import Final

from benchmarks.fleet.campus_core import Core
from benchmarks.fleet.campus_ground import Faults, Ground, homes, orders_an_hour
from benchmarks.fleet.campus_known import known_robots
from benchmarks.fleet.campus_link import Link
from benchmarks.fleet.campus_robot import Robot
from benchmarks.fleet.charging_world import DAY_S, Clockwork
from benchmarks.fleet.packs import Pack, some_pack

LOOKED_S: Final = 2700.0
CLOSED_S: Final = (600.0, 3600.0)
AWAY_S: Final = (10.0, 300.0)
MOST: Final = 6.0
"""The busiest hour has no more than so many times the orders of the mean."""


@dataclass(frozen=True, slots=True)
class Fleet:
    """So many robots with so many items each, orders in an hour of the week on average, and packs that last so many
    times as long as the usual one."""

    robots: int
    capacity: int
    orders_h: float
    lasts: float = 1.0


class CampusRun:
    """Of the same seed orders, packs and paces are the same whatever the robots do."""

    def __init__(self, seed: int, fleet: Fleet, faults: Faults) -> None:
        self.clock, self.messages = Clockwork(), Counter[str]()
        self.ground = Ground(self.clock, Random(f"{seed} ground"), faults)
        self._orders, self._faults, self._orders_h = Random(f"{seed} orders"), Random(f"{seed} faults"), fleet.orders_h
        where = dict(homes(self.ground.campus, fleet.robots))
        links = {name: Link(name, self.clock, self.messages) for name in where}
        packs = Random(f"{seed} packs")
        self.robots = {
            name: Robot(name, home, self.ground, links[name], _pack(packs, fleet)) for name, home in where.items()
        }
        self.core = Core(self.ground, known_robots(links, where), fleet.capacity, Random(seed), fleet.lasts)
        self.ground.needs_it_more = self.core.charges.needs_it_more
        self.ground.makes_room = self._makes_room
        self.ground.is_sent = lambda robot, dock: self.core.robots[robot].bound_for == dock
        self.ground.takes_bay = self._takes_bay
        for robot in self.robots.values():
            robot.on_death = self._died
            robot.switch_on()
            self._be_away(robot)

    def run(self, days: float) -> None:
        self.clock.at(self._next_order_s(), self._order)
        if self.ground.faults.closed_every_s:
            self.clock.at(self._faults.expovariate(1 / self.ground.faults.closed_every_s), self._close)
        self.clock.run(days * DAY_S)

    # Orders.

    def _next_order_s(self) -> float:
        at_s, most = self.clock.now_s, MOST * self._orders_h
        while True:
            at_s += self._orders.expovariate(most / 3600.0)
            if self._orders.random() < orders_an_hour(at_s, self._orders_h) / most:
                return at_s

    def _order(self) -> None:
        self.core.place(*self._orders.sample(range(len(self.ground.network.posts)), 2))
        self.clock.at(self._next_order_s(), self._order)

    # What goes wrong.

    def _close(self) -> None:
        corridor, now_s = self._faults.choice(self.ground.network.corridors), self.clock.now_s
        self.core.close(corridor)
        self.clock.at(now_s + self._faults.uniform(*CLOSED_S), lambda: self.core.reopen(corridor))
        self.clock.at(now_s + self._faults.expovariate(1 / self.ground.faults.closed_every_s), self._close)

    def _be_away(self, robot: Robot) -> None:
        """Now and then its network is gone."""
        every_s = self.ground.faults.away_every_s
        if not every_s:
            return
        away_s = self.clock.now_s + self._faults.expovariate(1 / every_s)
        back_s = away_s + self._faults.uniform(*AWAY_S)
        self.clock.at(away_s, robot.link.disconnect)
        self.clock.at(back_s, lambda: self._is_back(robot))

    def _is_back(self, robot: Robot) -> None:
        if not robot.is_dead:
            robot.link.connect()
        self._be_away(robot)

    def _died(self, robot: Robot) -> None:
        def found() -> None:
            self.core.has_been_looked_for(robot.name)
            robot.is_brought_home()

        self.clock.at(self.clock.now_s + LOOKED_S, found)

    # What is asked of robots beside messages.

    def _makes_room(self, robot: str) -> bool:
        """Unless its own battery plan has put it there."""
        if self.robots[robot].recharging:
            return False
        self.robots[robot].makes_room()
        return True

    def _takes_bay(self, robot: str) -> bool:
        known, its = self.core.robots[robot], self.robots[robot]
        if known.frozen or its.is_dead:
            return True
        return not self.core.controller.tasks(self.clock.now_s)[robot].start.at_home


def _pack(rng: Random, fleet: Fleet) -> Pack:
    pack = some_pack(rng)
    pack.capacity_mah, pack.charger_ma = pack.capacity_mah * fleet.lasts, pack.charger_ma * fleet.lasts
    return pack
