"""While a decision is worked out the campus goes on: what comes too late is refused, and the traffic is sound whatever
was adopted."""

from dataclasses import dataclass, field, replace
from random import Random

import pytest

from fleet.assignment.adopting import Able, adopt, problem_of
from fleet.assignment.deciding import decide
from fleet.assignment.problem import OpenOrder
from fleet.schedule.controller import TrafficController
from fleet.schedule.validation import problems
from tests.app.dispatch.fleet_life import order
from tests.fleet.schedule.test_schedules import random_network


@dataclass
class Campus:
    """Anything happens, at any moment."""

    rng: Random
    robots: list[str]
    now_s: float = 0.0
    placed: int = 0
    orders: dict[str, OpenOrder] = field(default_factory=dict)
    frozen: set[str] = field(default_factory=set)
    closed: set[str] = field(default_factory=set)
    inside: dict[str, tuple[str, str]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.network = random_network(self.rng)
        self.traffic = TrafficController(self.network, Random(0))
        for robot in self.robots:
            home = self.rng.choice(self.network.posts)
            self.traffic.joins(robot, post=home, home=home, at_home=True, now_s=0.0)

    def decide_and_adopt(self) -> None:
        one = order(self.placed, *self.rng.sample(range(len(self.network.posts)), 2), since_s=self.now_s)
        self.orders[one.id], self.placed = one, self.placed + 1
        able = dict.fromkeys(self.robots, Able(capacity=2))
        decision = decide(problem_of(self.traffic, able, dict(self.orders), self.now_s))
        for _ in range(self.rng.randint(0, 4)):
            self.goes_on()
        if decision is not None:
            adopt(self.traffic, decision, able, self.now_s)
        now = self.traffic.tasks(self.now_s), self.traffic.journeys(self.now_s)
        assert problems(self.traffic.network, *now) == []

    def goes_on(self) -> None:
        self.now_s += self.rng.uniform(0.0, 60.0)
        robot, happens = self.rng.choice(self.robots), self.rng.random()
        if happens < 0.7:
            self._moves(robot)
        elif happens < 0.8:
            self._dies_or_wakes(robot)
        elif happens < 0.9:
            self._closed_or_open(self.rng.choice(self.network.corridors))
        elif robot not in self.inside:
            self.traffic.stands(robot, self.rng.choice(self.network.posts), self.now_s)

    def _moves(self, robot: str) -> None:
        if robot in self.inside:
            self.traffic.cleared(robot, *self.inside.pop(robot), self.now_s)
            return
        here, goals = self.traffic.tasks(self.now_s).get(robot), self.traffic.goals(robot)
        if here is not None and goals and goals[0].post == here.start.post and self.rng.random() < 0.9:
            self._serves(robot, goals[0].key)
        elif (lane := self.traffic.leads(robot)) is not None and robot not in self.frozen:
            self.traffic.claims(robot, self.network.posts[lane.start], self.network.posts[lane.end], self.now_s)
        self._note_who_is_inside()

    def _note_who_is_inside(self) -> None:
        for robot, task in self.traffic.tasks(self.now_s).items():
            if (lane := task.start.lane) is not None:
                self.inside[robot] = self.network.posts[lane.start], self.network.posts[lane.end]

    def _serves(self, robot: str, key: str) -> None:
        self.traffic.served(robot, key, self.now_s)
        one = self.orders[key.split(maxsplit=1)[0]]
        if key == one.give.key:
            del self.orders[one.id]
        else:
            self.orders[one.id] = replace(one, loaded=True)

    def _dies_or_wakes(self, robot: str) -> None:
        change = self.traffic.unfreeze if robot in self.frozen else self.traffic.freeze
        self.frozen ^= {robot}
        change(robot, self.now_s)

    def _closed_or_open(self, corridor: str) -> None:
        change = self.traffic.open if corridor in self.closed else self.traffic.close
        self.closed ^= {corridor}
        change(corridor, self.now_s)


@pytest.mark.parametrize("seed", range(40))
@pytest.mark.slow
def test_whatever_happens_meanwhile_the_traffic_stays_sound(seed: int) -> None:
    campus = Campus(Random(seed), [f"r{number}" for number in range(1 + seed % 5)])
    for _ in range(25):
        campus.decide_and_adopt()
        campus.goes_on()
