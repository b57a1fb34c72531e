"""Robots that know nothing of each other and claim corridor by corridor from the product's traffic controller.

They are late, they fall silent in corridors and at posts and stay there until a person has looked, they are switched
off and on; people close corridors for an hour. It is checked here: a robot that meets another or finds no bay
ends the run, and one that does not move for hours is counted as stuck.
"""

import heapq
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from functools import partial
from itertools import count
from random import Random
from typing import Final

from benchmarks.fleet.claimants_dispatch import Dispatch, nearest, number_of
from benchmarks.fleet.demand import HANDLING_S, Saturated
from benchmarks.fleet.grounds import Ground
from benchmarks.fleet.world import CollisionError
from fleet.schedule.controller import ComeIn, Denied, Granted, TrafficController
from fleet.schedule.journey import Goal
from fleet.schedule.network import Lane

VANISHED_S: Final = 600.0
"""After so much silence the service freezes what a robot holds."""
LOOKED_S: Final = 2700.0
"""So much later a person has looked, and carried the robot home."""
AGAIN_S: Final = 60.0
"""So long a robot waits with another claim when no way is open."""
STUCK_S: Final = 6 * 3600.0


@dataclass(frozen=True, slots=True)
class Faults:
    """Fault rates: of the ways through corridors, of the stops at posts, and by the hour."""

    dies: float = 0.0
    dies_at_a_post: float = 0.0
    closures_an_hour: float = 0.0
    switched_off_an_hour: float = 0.0


@dataclass
class Robot:
    """`busy`: it drives, `handles` something, or is dead. `ahead`: further corridors that it was let into. `claim`:
    what it waits for. `at_home`: it stands at its home place or is on its way there, and needs no bay."""

    name: str
    home: int
    post: int
    goals: list[Goal] = field(default_factory=list)
    lane: Lane | None = None
    ahead: list[Lane] = field(default_factory=list)
    claim: Lane | None = None
    busy: bool = False
    handles: bool = False
    off: bool = False
    at_home: bool = True
    moved_s: float = 0.0


@dataclass(frozen=True, slots=True)
class Delivered:
    age_s: float
    trip_s: float


class Campus:
    """`age_limit_s`: an order that has waited so long is the next that is taken. `far`: robots are let into as much of
    their way as no other enters before them. `served`: the keys of all goals that
    are behind their robots."""

    def __init__(
        self,
        ground: Ground,
        robots: int,
        seed: int,
        faults: Faults,
        *,
        spread: float = 0.2,
        age_limit_s: float,
        far: bool = False,
        dispatch: Dispatch = nearest,
    ) -> None:
        self._dispatch, self._far = dispatch, far
        self.network, self.faults, self.age_limit_s = ground.network, faults, age_limit_s
        self.rng, self._spread = Random(seed), spread
        self.controller = TrafficController(ground.network, Random(seed))
        self.demand = Saturated(len(ground.network.posts), seed, waiting=robots + 1)
        self.now_s = 0.0
        self.delivered: list[Delivered] = []
        self.served: set[str] = set()
        self._placed_s: dict[int, float] = {}
        self._taken_s: dict[int, float] = {}
        self.entries = self.ahead = self.deaths = self.deaths_at_posts = 0
        self.closures = self.switched_off = self.refused = self.stuck = 0
        self._events: list[tuple[float, int, Callable[[], None]]] = []
        self._count = count()
        self.robots = {name: Robot(name, home, home) for name, home in ground.homes(robots).items()}
        for robot in self.robots.values():
            self._joins(robot)
        if faults.closures_an_hour:
            self._later(self.rng.expovariate(faults.closures_an_hour / 3600), self._close_some)
        if faults.switched_off_an_hour:
            self._later(self.rng.expovariate(faults.switched_off_an_hour / 3600), self._switch_one_off)

    def run(self, until_s: float) -> None:
        while self._events and self._events[0][0] <= until_s:
            self.now_s, _, action = heapq.heappop(self._events)
            action()
            self._grant()
        self.now_s = until_s

    def ages_s(self) -> list[float]:
        """Of all orders that are not delivered."""
        waiting_s = (order.placed_s for order in self.demand.waiting)
        return [self.now_s - placed_s for placed_s in (*waiting_s, *self._placed_s.values())]

    def note_taken(self, numbers: Iterable[int]) -> None:
        """These orders have a robot now. Those that had one before keep the time at which they got it."""
        for order in [order for order in self.demand.waiting if order.number in set(numbers)]:
            self.demand.take(order, self.now_s)
            self._placed_s[order.number], self._taken_s[order.number] = order.placed_s, self.now_s

    def _later(self, after_s: float, action: Callable[[], None]) -> None:
        heapq.heappush(self._events, (self.now_s + after_s, next(self._count), action))

    # What a robot does.

    def _go_on(self, robot: Robot) -> None:
        if robot.busy or robot.off or robot.claim is not None:
            return
        if not robot.goals and not self._dispatch(self, robot):
            self._later(AGAIN_S, partial(self._go_on, robot))
        elif robot.goals[0].post == robot.post:
            self._handle(robot)
        else:
            self._claim(robot)

    def _claim(self, robot: Robot) -> None:
        """The way that the map calls shortest, or what it is told instead."""
        self._make_room(robot)
        lane: Lane | None = self._shortest(robot)
        while lane is not None:
            answer = self.controller.claims(robot.name, *self._ends(lane), self.now_s)
            if isinstance(answer, Granted):
                self._enter(robot, lane)
                self.look_for_others(robot, lane)
                return
            if not isinstance(answer, Denied):
                robot.claim = lane
                return
            lane = answer.instead
        self._look_at(robot)
        self._later(AGAIN_S, partial(self._go_on, robot))

    def _make_room(self, robot: Robot) -> None:
        """Home places here are nowhere on the floor: a robot that is to go from a bay to its own is there at once."""
        if isinstance(self.controller.next_move(robot.name, self.now_s), ComeIn):
            self.controller.comes_in(robot.name, self.network.posts[robot.post], self.now_s)

    def _handle(self, robot: Robot) -> None:
        robot.busy = True
        if self.faults.dies_at_a_post and self.rng.random() < self.faults.dies_at_a_post:
            self.deaths_at_posts += 1
            self._later(VANISHED_S, partial(self._vanished, robot))
        else:
            robot.handles = True
            self._later(HANDLING_S, partial(self._served, robot))

    def _shortest(self, robot: Robot) -> Lane:
        return self._towards(robot.post, robot.goals[0].post)

    def _towards(self, post: int, to: int) -> Lane:
        to_s = self.network.shortest_s
        return min(self.network.lanes[post], key=lambda lane: (lane.travel_s + to_s[lane.end][to], lane.corridor))

    def _enter(self, robot: Robot, lane: Lane) -> None:
        robot.claim = None
        if self._far:
            way = [self._ends(one) for one in self._way(lane.end, robot.goals[0].post)]
            robot.ahead = self.controller.goes_on(robot.name, way, self.now_s)
            self.ahead += len(robot.ahead)
        self._drive(robot, lane)

    def _way(self, post: int, to: int) -> Iterator[Lane]:
        while post != to:
            lane = self._towards(post, to)
            yield lane
            post = lane.end

    def _drive(self, robot: Robot, lane: Lane) -> None:
        self.entries += 1
        robot.lane, robot.busy, robot.moved_s = lane, True, self.now_s
        travel_s = lane.travel_s * self.rng.uniform(1 - self._spread, 1 + self._spread)
        if self.rng.random() < self.faults.dies:
            self._later(travel_s / 2 + VANISHED_S, partial(self._vanished, robot))
        else:
            self._later(travel_s, partial(self._arrived, robot))

    def _arrived(self, robot: Robot) -> None:
        lane = robot.lane
        assert lane is not None
        if lane.following_s is not None and self._ahead_of(robot, lane):
            self._later(lane.following_s, partial(self._arrived, robot))  # no robot overtakes
            return
        robot.lane, robot.post, robot.busy = None, lane.end, False
        self.controller.cleared(robot.name, *self._ends(lane), self.now_s)
        if robot.ahead:
            self._drive(robot, further := robot.ahead.pop(0))
            self.look_for_others(robot, further)
        else:
            self._go_on(robot)

    def _ahead_of(self, robot: Robot, lane: Lane) -> bool:
        return any(other.lane == lane and other.moved_s < robot.moved_s for other in self.robots.values())

    def _served(self, robot: Robot) -> None:
        goal = robot.goals.pop(0)
        robot.busy, robot.handles, robot.moved_s = False, False, self.now_s
        self.controller.served(robot.name, goal.key, self.now_s)
        self.served.add(goal.key)
        if goal.key.endswith("give"):
            placed_s, taken_s = (of.pop(number_of(goal)) for of in (self._placed_s, self._taken_s))
            self.delivered.append(Delivered(self.now_s - placed_s, self.now_s - taken_s))
        self._go_on(robot)

    # What the service answers later.

    def _grant(self) -> None:
        for robot in self.robots.values():
            if robot.claim is not None:
                self._make_room(robot)
        answers = [(self.robots[name], answer) for name, answer in self.controller.grants(self.now_s)]
        granted = [(robot, answer.lane) for robot, answer in answers if isinstance(answer, Granted)]
        for robot, lane in granted:
            self._enter(robot, lane)
        for robot, lane in granted:
            self.look_for_others(robot, lane)
        for robot, answer in answers:
            if isinstance(answer, Denied):  # the schedule goes another way now
                robot.claim = None
                self._go_on(robot)
        for robot in self.robots.values():
            if robot.claim is not None:
                self._look_at(robot)

    def _look_at(self, robot: Robot) -> None:
        if self.now_s - robot.moved_s > STUCK_S:
            self.stuck += 1
            robot.moved_s = self.now_s

    # What goes wrong.

    def _vanished(self, robot: Robot) -> None:
        self.deaths += 1
        self.controller.freeze(robot.name, self.now_s)
        self._later(LOOKED_S, partial(self._joins, robot))

    def _joins(self, robot: Robot) -> None:
        """It is switched on at its home, with what it carries."""
        home = self.network.posts[robot.home]
        robot.post, robot.lane, robot.claim, robot.busy = robot.home, None, None, False
        robot.at_home, robot.ahead = True, []
        robot.moved_s = self.now_s
        self.controller.joins(robot.name, post=home, home=home, at_home=True, now_s=self.now_s)
        self._later(0.0, partial(self._takes_up, robot))

    def _takes_up(self, robot: Robot) -> None:
        """Take the robot up again: what it carried when it was taken away it still has."""
        forgotten = robot.goals and not self.controller.goals(robot.name)
        if forgotten and not self.controller.give(robot.name, robot.goals, self.now_s, rounds=0):
            self._later(AGAIN_S, partial(self._takes_up, robot))
        else:
            robot.off = False
            self._go_on(robot)

    def _switch_one_off(self) -> None:
        """Of those that wait for a corridor; a person takes it away, and brings it to its home an hour later."""
        self._later(self.rng.expovariate(self.faults.switched_off_an_hour / 3600), self._switch_one_off)
        able = [robot for robot in self.robots.values() if robot.claim is not None]
        if able:
            robot = self.rng.choice(able)
            self.switched_off += 1
            robot.off, robot.claim = True, None
            self.controller.leaves(robot.name, self.now_s)
            self._later(3600.0, partial(self._joins, robot))

    def _close_some(self) -> None:
        self._later(self.rng.expovariate(self.faults.closures_an_hour / 3600), self._close_some)
        self.closures += 1
        corridor = self.rng.choice(self.network.corridors)
        self.controller.close(corridor, self.now_s)
        self._later(3600.0, partial(self._open, corridor))

    def _open(self, corridor: str) -> None:
        self.controller.open(corridor, self.now_s)

    # What is looked at.

    def look_for_others(self, robot: Robot, lane: Lane) -> None:
        others = [other for other in self.robots.values() if other is not robot and not other.off]
        inside = [other.lane for other in others if other.lane is not None and other.lane.corridor == lane.corridor]
        if any(lane.following_s is None or other != lane for other in inside):
            raise CollisionError(f"{robot.name} meets another in {self.network.corridors[lane.corridor]}")
        for name, task in self.controller.tasks(self.now_s).items():
            other = self.robots[name]
            other.at_home = task.start.at_home and not other.ahead  # of those that are dead: as it was
        places = [other.lane.end if other.lane else other.post for other in others if not other.at_home]
        if not robot.at_home and places.count(lane.end) >= self.network.bays[lane.end]:
            raise CollisionError(f"{robot.name} finds no bay at {self.network.posts[lane.end]}")

    def _ends(self, lane: Lane) -> tuple[str, str]:
        return self.network.posts[lane.start], self.network.posts[lane.end]
