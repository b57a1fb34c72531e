"""Robots that cannot come home for now stay where they stand, and all others go on working round them."""

from dataclasses import replace
from random import Random

import pytest

from fleet.schedule.controller import ComeIn, GoOn, Granted, LetIn, TrafficController, Waits
from fleet.schedule.evacuation import evacuate
from fleet.schedule.journey import Goal, Start, Task
from fleet.schedule.network import Lane, Network
from fleet.schedule.planning import plan_what_can_be
from fleet.schedule.validation import problems
from tests.fleet.schedule.test_controller import line


def star(arms: int, bays: int = 1) -> Network:
    """Arms of two corridors each, that begin at post 0: 0–1–2, 0–3–4, …"""
    lanes: list[list[Lane]] = [[] for _ in range(2 * arms + 1)]
    for number, (a, b) in enumerate((0 if post % 2 else post - 1, post) for post in range(1, 2 * arms + 1)):
        lanes[a].append(Lane(number, 0, a, b, 100.0))
        lanes[b].append(Lane(number, 1, b, a, 100.0))
    names = tuple(f"p{post}" for post in range(2 * arms + 1))
    corridors = tuple(f"p{0 if post % 2 else post - 1}-p{post}" for post in range(1, 2 * arms + 1))
    return Network(names, (bays,) * len(names), corridors, tuple(map(tuple, lanes)), crossing_s=(5.0,) * len(names))


def test_with_several_shut_in_all_others_work_and_come_home() -> None:
    """The way between post 1 and 2 is closed, and so is that between 3 and 4: two robots stand behind them."""
    controller = TrafficController(star(4))
    for robot, post, home in (("in2", 2, 5), ("in4", 4, 7), ("free6", 6, 6), ("free8", 8, 8), ("free1", 1, 7)):
        controller.joins(robot, post=f"p{post}", home=f"p{home}", at_home=post == home, now_s=0.0)
        assert controller.give(robot, [Goal((home + 2) % 4 + 5, 60.0, key=robot)], 0.0)
    controller.close("p1-p2", 1.0)
    controller.close("p3-p4", 1.0)
    tasks, journeys = controller.tasks(2.0), controller.journeys(2.0)
    assert {robot for robot, task in tasks.items() if task.home is None} == {"in2", "in4"}
    assert [len(journeys[robot].legs) for robot in ("in2", "in4")] == [1, 1]
    for robot in ("free6", "free8", "free1"):
        assert [goal.key for goal in tasks[robot].goals] == [robot]
        assert journeys[robot].legs[-1].at_home
    assert controller.out_of_reach() == {"in2", "in4"}
    controller.open("p1-p2", 3.0)
    controller.open("p3-p4", 3.0)
    assert controller.out_of_reach() == frozenset()


def at(post: int, home: int | None) -> Task:
    return Task(Start(post, False, 0.0, 0.0), (), home)


def test_as_many_come_home_as_can_however_many_cannot() -> None:
    """On one part of a line of single bays two want to pass each other between two that stay: they cannot. On the other
    one that stays makes way for one that can come home, and another comes home when that has gone."""
    network = replace(line(8), crossing_s=(5.0,) * 8).without({"d-e"})
    tasks = {"a": at(0, None), "b": at(1, 3), "c": at(2, 0), "d": at(3, None)}
    tasks |= {"e": at(4, 7), "f": at(5, None), "h": at(7, 7)}
    schedule, planned = plan_what_can_be(network, tasks, Random(0))
    assert problems(network, planned, schedule.journeys) == []
    assert {robot for robot, task in planned.items() if task.home is None} == {"a", "b", "c", "d", "f"}
    assert [len(schedule.journeys[robot].legs) for robot in "abcd"] == [1, 1, 1, 1], "they stay where they stand"
    assert schedule.journeys["e"].legs[-1].at_home
    assert schedule.journeys["h"].legs[-1].at_home


def test_who_stays_and_who_goes_is_the_same_each_time() -> None:
    network = replace(line(6), crossing_s=(5.0,) * 6)
    tasks = {"r1": at(1, 5), "r2": at(2, 4), "r3": at(3, 0), "r4": at(4, 1)}
    schedule, planned = plan_what_can_be(network, tasks, Random(0))
    again, same = plan_what_can_be(network, dict(reversed(tasks.items())), Random(7))
    assert (schedule.journeys, planned) == (again.journeys, same)


def dead_on_the_crossing(bays: int) -> TrafficController:
    """`dead` has left its bay at b and stands on the crossing there; `r1` is in the corridor from a to b."""
    controller = TrafficController(replace(line(3, bays), crossing_s=(5.0,) * 3))
    controller.joins("dead", post="b", home="c", at_home=False, now_s=0.0, towards=["c"], on_crossing=True)
    controller.joins("r1", post="a", home="c", at_home=False, now_s=0.0, towards=["b"])
    controller.freeze("dead", 10.0)
    return controller


def test_before_a_crossing_on_which_a_robot_is_dead_another_turns_round_if_there_is_room() -> None:
    controller = dead_on_the_crossing(bays=2)
    assert controller.network.shut == {1}
    assert controller.next_move("r1", 11.0) == ComeIn(0, at_home=False)
    assert isinstance(controller.comes_in("r1", "b", 12.0), Waits), "not over the crossing that is shut"
    assert controller.comes_in("r1", "a", 20.0) == LetIn(0, at_home=False)
    controller.cleared("r1", "b", "a", 21.0)
    controller.crossed("r1", "a", 26.0)
    assert controller.tasks(27.0)["r1"].start.rests
    controller.unfreeze("dead", 30.0)
    controller.crossed("dead", "b", 31.0)
    assert isinstance(controller.claims("r1", "a", "b", 32.0), Granted)


def test_one_that_finds_no_room_behind_it_waits_where_it_is_and_its_corridor_stays_its_own() -> None:
    controller = dead_on_the_crossing(bays=1)
    controller.leaves("r1", 11.0)
    controller.joins("r2", post="a", home="b", at_home=False, now_s=11.0)
    controller.joins("r1", post="a", home="c", at_home=False, now_s=11.0, towards=["b"])
    assert controller.next_move("r1", 12.0) is None
    assert controller.out_of_reach() == {"r1", "r2"}
    assert "r1" not in controller.tasks(12.0)
    assert controller.network.lanes[0] == ()
    controller.leaves("r2", 13.0)
    assert controller.next_move("r1", 14.0) == ComeIn(0, at_home=False), "now there is room"


@pytest.mark.parametrize("is_let_in", [False, True])
def test_a_robot_that_is_dead_at_the_end_of_its_corridor_shuts_the_crossing_only_if_it_was_let_onto_it(
    is_let_in: bool,
) -> None:
    controller = TrafficController(replace(line(3, 2), crossing_s=(5.0,) * 3))
    controller.joins("dead", post="a", home="a", at_home=False, now_s=0.0, towards=["b"], is_let_in=is_let_in)
    controller.joins("r1", post="c", home="c", at_home=True, now_s=0.0)
    controller.freeze("dead", 10.0)
    assert controller.network.shut == ({1} if is_let_in else frozenset())
    assert controller.give("r1", [Goal(1, 5.0, key="one")], 11.0)
    assert (controller.out_of_reach() == {"r1"}) == is_let_in


def test_what_was_asked_at_one_end_of_a_corridor_is_not_granted_at_the_other() -> None:
    controller = TrafficController(replace(line(3, 2), crossing_s=(5.0,) * 3))
    controller.joins("dead", post="b", home="c", at_home=False, now_s=0.0, towards=["c"], on_crossing=True)
    controller.joins("r1", post="a", home="c", at_home=False, now_s=0.0, towards=["b"])
    assert isinstance(controller.comes_in("r1", "b", 5.0), Waits)
    controller.freeze("dead", 10.0)
    assert controller.grants(11.0) == [], "it does not know yet that it is to turn round"
    assert controller.comes_in("r1", "a", 20.0) == LetIn(0, at_home=False)


def test_who_has_turned_round_comes_in_before_it_goes_anywhere_else() -> None:
    controller = TrafficController(replace(line(4, 2), crossing_s=(5.0,) * 4))
    controller.joins("dead", post="c", home="d", at_home=False, now_s=0.0, towards=["d"], on_crossing=True)
    controller.joins("r1", post="b", home="a", at_home=False, now_s=0.0, towards=["c"])
    controller.freeze("dead", 10.0)
    assert controller.next_move("r1", 100.0) == ComeIn(1, at_home=False)
    assert isinstance(controller.claims("r1", "b", "a", 101.0), Waits)
    assert controller.comes_in("r1", "b", 102.0) == LetIn(1, at_home=False)
    controller.cleared("r1", "c", "b", 103.0)
    controller.crossed("r1", "b", 108.0)
    assert isinstance(controller.claims("r1", "b", "a", 109.0), Granted)


def test_one_that_is_shut_in_is_looked_at_again_when_another_has_moved() -> None:
    controller = TrafficController(star(2))
    controller.joins("dead", post="p0", home="p4", at_home=False, now_s=0.0, towards=["p3"], on_crossing=True)
    controller.joins("r1", post="p1", home="p4", at_home=False, now_s=0.0, towards=["p0"])
    controller.joins("r2", post="p1", home="p2", at_home=False, now_s=0.0)
    controller.freeze("dead", 10.0)
    assert controller.next_move("r1", 11.0) is None
    assert isinstance(controller.claims("r2", "p1", "p2", 12.0), Granted)
    assert controller.next_move("r1", 13.0) is None, "its bay is still its own"
    controller.crossed("r2", "p1", 20.0)
    assert controller.next_move("r1", 21.0) == ComeIn(1, at_home=False)


def test_no_robot_is_brought_home_over_a_crossing_that_is_shut() -> None:
    network = replace(line(2), crossing_s=(5.0, 5.0))
    assert evacuate(network, {"r1": at(0, 0)}) is not None
    assert evacuate(network.without((), shut={0}), {"r1": at(0, 0)}) is None


def test_no_robot_follows_one_that_is_to_turn_round_and_may_not_know_it_yet() -> None:
    network = replace(line(3, 3), crossing_s=(5.0,) * 3)
    lanes = tuple(tuple(lane._replace(following_s=20.0) for lane in out) for out in network.lanes)
    controller = TrafficController(replace(network, lanes=lanes))
    controller.joins("dead", post="b", home="c", at_home=False, now_s=0.0, towards=["c"], on_crossing=True)
    controller.joins("r1", post="a", home="c", at_home=False, now_s=0.0, towards=["b"])
    controller.joins("r2", post="b", home="a", at_home=False, now_s=0.0)
    controller.freeze("dead", 10.0)
    controller.unfreeze("dead", 20.0)
    controller.crossed("dead", "b", 30.0)
    answer = controller.claims("r2", "b", "a", 500.0)
    assert isinstance(answer, Waits)
    assert "r1" in answer.robots
    controller.comes_in("r1", "a", 600.0)
    controller.cleared("r1", "b", "a", 601.0)
    assert [robot for robot, _ in controller.grants(602.0)] == ["r2"]


def test_beside_posts_where_crossings_are_nobodys_robots_come_in_and_go_straight_on() -> None:
    controller = TrafficController(replace(line(4), crossing_s=(5.0, 0.0, 5.0, 5.0)))
    controller.joins("r1", post="a", home="a", at_home=True, now_s=0.0)
    assert controller.give("r1", [Goal(3, 5.0, key="far")], 0.0)
    assert isinstance(controller.claims("r1", "a", "b", 0.0), Granted)
    assert [lane.end for lane in controller.goes_on("r1", [("b", "c")], 0.0)] == [2]
    controller.crossed("r1", "a", 5.0)
    controller.cleared("r1", "a", "b", 105.0)
    assert controller.next_move("r1", 204.0) == GoOn(line(4).lane(2, 3))
    assert isinstance(controller.claims("r1", "c", "d", 205.0), Granted)
    controller.cleared("r1", "b", "c", 206.0)
    controller.crossed("r1", "c", 211.0)
    assert controller.comes_in("r1", "d", 310.0) == LetIn(3, at_home=False)


def test_a_bay_that_was_passed_where_crossings_are_nobodys_keeps_no_robot_from_coming_in() -> None:
    controller = TrafficController(replace(line(3), crossing_s=(5.0, 0.0, 5.0)))
    controller.joins("r1", post="a", home="a", at_home=True, now_s=0.0)
    assert controller.give("r1", [Goal(2, 5.0, key="here")], 0.0)
    assert isinstance(controller.claims("r1", "a", "b", 0.0), Granted)
    assert [lane.end for lane in controller.goes_on("r1", [("b", "c")], 0.0)] == [2]
    controller.cleared("r1", "a", "b", 105.0)
    assert controller.comes_in("r1", "c", 205.0) == LetIn(2, at_home=False)
