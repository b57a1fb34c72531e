"""Claims answered: no two robots meet, all arrive, and robots are rerouted around what is dead or closed."""

import heapq
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import pairwise
from random import Random

import pytest

from fleet.schedule.controller import ComeIn, Denied, Granted, TrafficController, Waits
from fleet.schedule.journey import Goal
from fleet.schedule.network import Lane, Network
from fleet.schedule.planning import Schedule
from fleet.schedule.validation import problems
from tests.fleet.schedule.test_schedules import random_network


def line(posts: int, bays: int = 1) -> Network:
    """Posts a, b, c … in a row, 100 s apart."""
    lanes: list[list[Lane]] = [[] for _ in range(posts)]
    for at in range(posts - 1):
        lanes[at].append(Lane(at, 0, at, at + 1, 100.0))
        lanes[at + 1].append(Lane(at, 1, at + 1, at, 100.0))
    names = tuple("abcdefgh"[:posts])
    corridors = tuple(f"{one}-{two}" for one, two in pairwise(names))
    return Network(names, (bays,) * posts, corridors, tuple(tuple(out) for out in lanes))


def triangle() -> Network:
    """From a to b it is a little shorter than to c."""
    lanes = (
        (Lane(0, 0, 0, 1, 50.0), Lane(1, 0, 0, 2, 60.0)),
        (Lane(0, 1, 1, 0, 50.0), Lane(2, 0, 1, 2, 60.0)),
        (Lane(1, 1, 2, 0, 60.0), Lane(2, 1, 2, 1, 60.0)),
    )
    return Network(("a", "b", "c"), (1, 1, 1), ("a-b", "a-c", "b-c"), lanes)


def two_at_the_ends() -> TrafficController:
    controller = TrafficController(line(3))
    controller.joins("r1", post="a", home="a", at_home=True, now_s=0.0)
    controller.joins("r2", post="c", home="c", at_home=True, now_s=0.0)
    return controller


def test_one_waits_until_the_other_is_out_and_is_told_for_whom_and_how_long() -> None:
    controller = two_at_the_ends()
    assert controller.give("r1", [Goal(2, 10.0, key="east")], 0.0)
    assert controller.give("r2", [Goal(0, 10.0, key="west")], 0.0)
    first, second = controller.claims("r1", "a", "b", 0.0), controller.claims("r2", "c", "b", 0.0)
    granted, waits = (first, second) if isinstance(first, Granted) else (second, first)
    assert isinstance(granted, Granted)
    assert isinstance(waits, Waits)
    assert waits.robots
    waiting = "r2" if granted is first else "r1"
    assert 100.0 <= controller.go_on_s([waiting], 0.0)[waiting] <= 330.0
    assert controller.grants(50.0) == []


@pytest.mark.parametrize("first", ["r1", "r2"])
def test_a_robot_that_joins_leaves_the_others_in_their_order(first: str) -> None:
    controller, goals = two_at_the_ends(), {"r1": Goal(2, 10.0, key="east"), "r2": Goal(0, 10.0, key="west")}
    for robot in sorted(goals, key=lambda name: name != first):
        assert controller.give(robot, [goals[robot]], 0.0, rounds=0)
    before = controller.journeys(0.0)
    assert before[first].done_s < min(journey.done_s for name, journey in before.items() if name != first)
    controller.joins("r3", post="b", home="b", at_home=True, now_s=0.0)
    after = controller.journeys(0.0)
    assert {name: after[name] for name in before} == before


def test_a_robot_that_is_frozen_in_a_corridor_keeps_it_and_others_go_round_or_wait() -> None:
    controller = two_at_the_ends()
    assert controller.give("r1", [Goal(1, 10.0, key="one")], 0.0)
    assert isinstance(controller.claims("r1", "a", "b", 0.0), Granted)
    controller.freeze("r1", 60.0)
    assert controller.give("r2", [Goal(0, 10.0, key="two")], 61.0) is True
    assert controller.out_of_reach() == {"r2"} or controller.goals("r2")
    answer = controller.claims("r2", "b", "a", 10_000.0)
    assert isinstance(answer, Denied), "no time frees what a frozen robot holds"


def test_a_robot_that_was_in_a_corridor_when_all_was_forgotten_is_in_it_still() -> None:
    controller = TrafficController(line(3))
    controller.joins("r1", post="a", home="a", at_home=False, now_s=0.0, towards=["b"])
    controller.joins("r2", post="b", home="c", at_home=False, now_s=0.0)
    controller.joins("r2", post="b", home="c", at_home=False, now_s=0.0)
    assert controller.give("r2", [Goal(0, 10.0, key="west")], 1.0)
    assert not isinstance(controller.claims("r2", "b", "a", 2.0), Granted)
    controller.cleared("r1", "a", "b", 100.0)
    assert controller.leads("r1") == line(3).lane(1, 0), "home, past the robot that stands there"


def test_a_robot_that_goes_for_reasons_of_its_own_may_change_its_mind_and_no_robot_waits_for_what_it_wanted() -> None:
    controller = TrafficController(line(4))
    controller.joins("r1", post="b", home="b", at_home=True, now_s=0.0)
    controller.joins("r2", post="d", home="d", at_home=True, now_s=0.0)
    assert controller.give("r2", [Goal(2, 60.0, key="west")], 0.0)
    assert isinstance(controller.claims("r2", "d", "c", 0.0), Granted)
    assert isinstance(controller.claims("r1", "b", "c", 1.0), Waits), "the only bay there is taken"
    assert isinstance(controller.claims("r1", "b", "a", 2.0), Granted)
    controller.cleared("r1", "b", "a", 102.0)
    assert controller.goals("r1") == ()


@pytest.mark.parametrize("is_known_anew", [False, True])
def test_who_follows_a_late_robot_is_expected_behind_it_and_a_plan_is_found_all_the_same(is_known_anew: bool) -> None:
    network = line(3, bays=2)
    lanes = tuple(tuple(lane._replace(following_s=60.0) for lane in out) for out in network.lanes)
    controller = TrafficController(replace(network, lanes=lanes))
    for robot, at_s in (("r2", 0.0), ("r1", 60.0)):
        if is_known_anew:  # both have been in it since before the service was started
            controller.joins(robot, post="a", home="a", at_home=False, now_s=100.0, towards=["b"])
        else:
            controller.joins(robot, post="a", home="a", at_home=True, now_s=at_s)
            assert controller.give(robot, [Goal(2, 10.0, key=robot)], at_s)
            assert isinstance(controller.claims(robot, "a", "b", at_s), Granted)
    controller.joins("r3", post="c", home="c", at_home=True, now_s=150.0)
    assert controller.give("r3", [Goal(0, 10.0, key="three")], 158.0), "the first is 58 s late by now"
    arrivals_s = sorted(task.start.arrives_s for name, task in controller.tasks(158.0).items() if name != "r3")
    assert arrivals_s[1] - arrivals_s[0] >= 60.0
    assert not isinstance(controller.claims("r3", "c", "b", 159.0), Denied)


def test_a_closed_corridor_is_gone_round_and_open_again_it_is_used() -> None:
    controller, (ab, ac) = TrafficController(triangle()), triangle().lanes[0]
    controller.joins("r1", post="a", home="a", at_home=True, now_s=0.0)
    assert controller.give("r1", [Goal(1, 5.0, key="one")], 0.0)
    controller.close("a-b", 1.0)
    assert controller.claims("r1", "a", "b", 2.0) == Denied(ab, ac)
    controller.open("a-b", 3.0)
    assert isinstance(controller.claims("r1", "a", "b", 4.0), Granted)


def test_a_robot_that_waits_is_told_when_the_way_is_another() -> None:
    controller = TrafficController(triangle())
    controller.joins("r1", post="a", home="a", at_home=True, now_s=0.0)
    controller.joins("r2", post="b", home="b", at_home=True, now_s=0.0)
    assert controller.give("r2", [Goal(0, 5.0, key="two")], 0.0)
    assert isinstance(controller.claims("r2", "b", "a", 0.0), Granted)
    assert controller.give("r1", [Goal(1, 5.0, key="one")], 1.0)
    waits = controller.claims("r1", "a", "b", 1.0)
    assert isinstance(waits, Waits)
    assert waits.robots == ("r2",)
    controller.freeze("r2", 20.0)
    ab, ac = triangle().lanes[0]
    assert controller.grants(21.0) == [("r1", Denied(ab, ac))]
    assert controller.grants(22.0) == [], "once"
    assert isinstance(controller.claims("r1", "a", "c", 23.0), Granted)


def test_of_what_a_robot_has_begun_only_the_rest_is_counted() -> None:
    controller = TrafficController(line(3))
    controller.joins("r1", post="a", home="c", at_home=False, now_s=0.0)
    goals = [Goal(0, 60.0, key="one"), Goal(0, 60.0, key="two"), Goal(2, 60.0, key="three")]

    def done_s(now_s: float) -> float:
        return controller.journeys(now_s)["r1"].done_s

    assert controller.give("r1", goals, 10.0)
    assert done_s(10.0) == done_s(50.0) == 10.0 + 120.0 + 200.0 + 60.0
    assert controller.adopt({"r1": controller.tasks(50.0)["r1"].goals}, Schedule(controller.journeys(50.0), 0.0), 50.0)
    assert controller.goals("r1") == tuple(goals), "as it was told"
    assert done_s(60.0) == 390.0
    assert done_s(100.0) == 100.0 + 5.0 + 60.0 + 200.0 + 60.0, "any moment now"
    controller.served("r1", "one", 110.0)
    assert done_s(120.0) == 110.0 + 60.0 + 200.0 + 60.0
    controller.freeze("r1", 130.0)
    controller.unfreeze("r1", 900.0)
    assert done_s(920.0) == 900.0 + 60.0 + 200.0 + 60.0, "no robot could do anything while it stood"


def test_a_goal_that_is_given_up_is_in_the_way_no_more_though_another_cannot_be_reached() -> None:
    controller = TrafficController(line(4))
    controller.joins("r1", post="b", home="b", at_home=True, now_s=0.0)
    controller.close("c-d", 1.0)
    first, second, beyond = Goal(2, 10.0, key="first"), Goal(0, 10.0, key="second"), Goal(3, 10.0, key="beyond")
    assert controller.give("r1", [first, second, beyond], 2.0)
    controller.served("r1", "first", 3.0)
    assert [goal.key for goal in controller.tasks(4.0)["r1"].goals] == ["second"]
    assert [leg.goals for leg in controller.journeys(4.0)["r1"].legs] == [0, 1, 0]


def test_a_robot_that_goes_for_reasons_of_its_own_is_let_in() -> None:
    controller = TrafficController(line(3))
    controller.joins("r1", post="a", home="a", at_home=True, now_s=0.0)
    assert isinstance(controller.claims("r1", "a", "b", 0.0), Granted)
    controller.cleared("r1", "a", "b", 100.0)
    assert controller.goals("r1") == ()
    assert isinstance(controller.claims("r1", "b", "c", 101.0), Granted)


def test_a_schedule_worked_out_meanwhile_is_taken_if_no_robot_went_elsewhere() -> None:
    controller = two_at_the_ends()
    assert controller.give("r1", [Goal(1, 10.0, key="one")], 0.0)
    tasks, journeys = controller.tasks(0.0), controller.journeys(0.0)
    assert isinstance(controller.claims("r1", "a", "b", 1.0), Granted)
    assert controller.adopt({"r1": tasks["r1"].goals}, Schedule(journeys, 0.0), 2.0)
    controller.cleared("r1", "a", "b", 101.0)
    controller.served("r1", "one", 111.0)
    assert isinstance(controller.claims("r1", "b", "c", 112.0), Denied | Granted)
    assert not controller.adopt({"r1": tasks["r1"].goals}, Schedule({"r1": journeys["r1"]}, 0.0), 113.0)


@dataclass
class Campus:
    """Robots that claim the way that the map calls shortest, and take another when they are denied."""

    controller: TrafficController
    network: Network
    rng: Random
    now_s: float = 0.0
    in_corridors: dict[str, Lane] = field(default_factory=dict)
    at: dict[str, int] = field(default_factory=dict)
    goals: dict[str, list[Goal]] = field(default_factory=dict)
    _ahead: list[tuple[float, int, str]] = field(default_factory=list)
    _count: int = 0

    def later(self, robot: str, after_s: float) -> None:
        self._count += 1
        heapq.heappush(self._ahead, (self.now_s + after_s, self._count, robot))

    def run(self, at_most: int) -> int:
        """-> so many goals were served."""
        served = 0
        for _ in range(at_most):
            if not self._ahead:
                break
            self.now_s, _, robot = heapq.heappop(self._ahead)
            self._arrive(robot)
            served += self._serve(robot)
            self._make_room()
            for name, answer in self.controller.grants(self.now_s):
                if isinstance(answer, Granted):
                    self._enter(name, answer.lane)
                else:
                    self.later(name, 1.0)
        return served

    def _make_room(self) -> None:
        """Who is to go from a bay to its home place does so, without a crossing at once."""
        for robot, post in self.at.items():
            is_there = robot not in self.in_corridors
            if is_there and isinstance(self.controller.next_move(robot, self.now_s), ComeIn):
                self.controller.comes_in(robot, self.network.posts[post], self.now_s)

    def _arrive(self, robot: str) -> None:
        lane = self.in_corridors.pop(robot, None)
        if lane is not None:
            self.at[robot] = lane.end
            self.controller.cleared(robot, *(self.network.posts[post] for post in (lane.start, lane.end)), self.now_s)

    def _serve(self, robot: str) -> int:
        goals = self.goals[robot]
        if goals and goals[0].post == self.at[robot]:
            goal = goals.pop(0)
            self.controller.served(robot, goal.key, self.now_s)
            self.later(robot, 1.0)
            return 1
        if goals:
            self._claim(robot, min(self._ways(robot, goals[0].post))[1])
        elif (lane := self.controller.leads(robot)) is not None:
            self._claim(robot, lane)  # home
        return 0

    def _claim(self, robot: str, lane: Lane) -> None:
        answer = self.controller.claims(robot, *self._names(lane), self.now_s)
        if isinstance(answer, Denied) and answer.instead is not None:
            answer = self.controller.claims(robot, *self._names(answer.instead), self.now_s)
        if isinstance(answer, Granted):
            self._enter(robot, answer.lane)
        elif isinstance(answer, Denied):
            self.later(robot, 15.0)

    def _ways(self, robot: str, to: int) -> Iterator[tuple[float, Lane]]:
        for lane in self.network.lanes[self.at[robot]]:
            yield lane.travel_s + self.network.shortest_s[lane.end][to], lane

    def _names(self, lane: Lane) -> tuple[str, str]:
        return self.network.posts[lane.start], self.network.posts[lane.end]

    def _enter(self, robot: str, lane: Lane) -> None:
        for other in self.in_corridors.values():
            follows = other == lane and lane.following_s is not None
            assert other.corridor != lane.corridor or follows, f"{robot} meets another in {lane}"
        self.in_corridors[robot] = lane
        self.later(robot, lane.travel_s * self.rng.uniform(0.8, 2.0))


def send_out(campus: Campus, robots: int) -> dict[str, int]:
    """Robots at home, each with up to three goals. -> the homes"""
    posts, homes = range(len(campus.network.posts)), {}
    for number in range(robots):
        home, name = campus.rng.choice(posts), f"r{number}"
        goals = [Goal(campus.rng.choice(posts), 1.0, key=f"{number}.{at}") for at in range(campus.rng.randint(0, 3))]
        post = campus.network.posts[home]
        campus.controller.joins(name, post=post, home=post, at_home=True, now_s=0)
        assert campus.controller.give(name, goals, 0.0)
        campus.at[name], campus.goals[name], homes[name] = home, goals, home
        campus.later(name, campus.rng.uniform(0.0, 5.0))
    return homes


@pytest.mark.parametrize("seed", range(60))
def test_robots_that_only_claim_serve_everything_without_meeting(seed: int) -> None:
    rng, robots = Random(seed), 1 + seed % 5
    network = random_network(rng, following=seed % 3 == 0)
    controller = TrafficController(network, rng)
    campus = Campus(controller, network, rng)
    homes = send_out(campus, robots)
    wanted = sum(len(goals) for goals in campus.goals.values())
    assert campus.run(at_most=2000) == wanted
    assert campus.at == homes, "and then they go home"
    assert problems(network, controller.tasks(campus.now_s), controller.journeys(campus.now_s)) == []


@pytest.mark.parametrize("seed", range(40))
@pytest.mark.slow
def test_whatever_is_frozen_or_closed_meanwhile_all_is_served_in_the_end(seed: int) -> None:
    rng, robots = Random(seed), 2 + seed % 4
    network = random_network(rng)
    controller = TrafficController(network, rng)
    campus = Campus(controller, network, rng)
    send_out(campus, robots)
    wanted = sum(len(goals) for goals in campus.goals.values())
    served, frozen, closed = 0, None, None
    for _ in range(12):
        served += campus.run(at_most=3)
        if frozen is not None:
            controller.unfreeze(frozen, campus.now_s)
        if closed is not None:
            controller.open(closed, campus.now_s)
        frozen = rng.choice(sorted(campus.at)) if rng.random() < 0.4 else None
        closed = rng.choice(network.corridors) if rng.random() < 0.4 else None
        if frozen is not None:
            controller.freeze(frozen, campus.now_s)
        if closed is not None:
            controller.close(closed, campus.now_s)
        assert problems(controller.network, controller.tasks(campus.now_s), controller.journeys(campus.now_s)) == []
    if frozen is not None:
        controller.unfreeze(frozen, campus.now_s)
    if closed is not None:
        controller.open(closed, campus.now_s)
    for robot in campus.at:
        campus.later(robot, 1.0)  # a robot that was told that no way is open asks again
    assert served + campus.run(at_most=3000) == wanted


def test_a_corridor_is_closed_before_any_robot_is_there() -> None:
    controller = TrafficController(line(3))
    controller.close("a-b", 0.0)
    controller.joins("r1", post="a", home="a", at_home=True, now_s=1.0)
    assert controller.claims("r1", "a", "b", 2.0) == Denied(line(3).lane(0, 1), None)


@pytest.mark.parametrize("first", ["r0", "r1"])
def test_what_a_closure_does_not_concern_goes_its_way_as_before(first: str) -> None:
    """Two change places at one end of a line, and two are at the other end."""
    network = line(6)
    controller = TrafficController(network)
    goals = {"r0": 1, "r1": 0, "r2": 5, "r3": 4}
    for name, post in zip(goals, "abef", strict=True):
        controller.joins(name, post=post, home=post, at_home=True, now_s=0.0)
    for name in sorted(goals, key=lambda name: name != first):
        assert controller.give(name, [Goal(goals[name], 10.0, key=name)], 0.0, rounds=0)
    before = controller.journeys(1.0)
    controller.close("e-f", 1.0)
    after = controller.journeys(1.0)
    assert (after["r0"], after["r1"]) == (before["r0"], before["r1"])
    assert min(("r0", "r1"), key=lambda name: after[name].done_s) == first
    assert (len(after["r2"].legs), len(after["r3"].legs)) == (1, 1)
