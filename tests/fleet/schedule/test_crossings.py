"""The crossing of a post is one robot's until it reports that it is off it, and so is what it leaves."""

from dataclasses import replace
from itertools import pairwise
from random import Random

from fleet.schedule.controller import ComeIn, GoOn, Granted, LetIn, TrafficController, Waits
from fleet.schedule.execution import retimed, waits_to_cross
from fleet.schedule.journey import Goal, Journey, Leg, Start, Task, standing
from fleet.schedule.network import Network
from fleet.schedule.planning import Schedule, plan
from fleet.schedule.validation import problems
from tests.fleet.schedule.test_controller import line
from tests.fleet.schedule.test_schedules import planned, random_network, random_tasks
from tests.fleet.schedule.test_shut_in import star

OVER_S = 10.0


def crossed_line(posts: int, bays: int = 1) -> Network:
    return replace(line(posts, bays), crossing_s=(OVER_S,) * posts)


def one_on_its_way() -> TrafficController:
    """`r1` has been let out of its home at a, to b."""
    controller = TrafficController(crossed_line(3))
    controller.joins("r1", post="a", home="a", at_home=True, now_s=0.0)
    assert controller.give("r1", [Goal(1, 10.0, key="one")], 0.0)
    assert controller.claims("r1", "a", "b", 0.0) == Granted(crossed_line(3).lane(0, 1))
    return controller


def held_crossings(controller: TrafficController, robot: str) -> list[int]:
    return sorted({post for post, _ in controller.tasks(50.0)[robot].start.crossings()})


def test_a_move_takes_a_crossing_from_the_grant_to_the_report_and_a_journey_takes_its_time() -> None:
    controller = one_on_its_way()
    assert controller.journeys(0.0)["r1"].done_s == OVER_S + 100.0 + OVER_S + 10.0
    assert held_crossings(controller, "r1") == [0]
    controller.crossed("r1", "a", 11.0)
    assert held_crossings(controller, "r1") == []
    assert controller.next_move("r1", 105.0) == ComeIn(1, at_home=False)
    assert controller.comes_in("r1", "b", 111.0) == LetIn(1, at_home=False)
    assert held_crossings(controller, "r1") == [1]
    controller.cleared("r1", "a", "b", 112.0)
    assert held_crossings(controller, "r1") == [1], "it is on it"
    assert controller.tasks(113.0)["r1"].start.lane is None
    controller.crossed("r1", "b", 121.0)
    assert held_crossings(controller, "r1") == []
    assert controller.tasks(122.0)["r1"].start.rests


def test_reports_that_come_twice_or_for_nothing_free_nothing() -> None:
    controller = one_on_its_way()
    controller.crossed("r1", "a", 11.0)
    controller.crossed("r1", "a", 12.0)
    controller.crossed("r1", "b", 13.0)
    assert controller.tasks(14.0)["r1"].start.lane == crossed_line(3).lane(0, 1)
    controller.comes_in("r1", "b", 111.0)
    controller.crossed("r1", "a", 112.0)
    assert held_crossings(controller, "r1") == [1]
    controller.crossed("r1", "b", 121.0)
    controller.cleared("r1", "a", "b", 122.0)
    assert controller.tasks(123.0)["r1"].start.rests, "wholly in its bay it is out of the corridor, too"
    assert controller.claims("r1", "b", "a", 130.0) == Granted(crossed_line(3).lane(1, 0), at_home=True)
    controller.crossed("r1", "c", 131.0)
    assert held_crossings(controller, "r1") == [1]


def test_no_robot_leaves_over_a_crossing_before_the_one_on_it_has_reported_however_late() -> None:
    controller = TrafficController(star(3))
    for robot, post in (("r1", 1), ("r3", 3)):
        controller.joins(robot, post=f"p{post}", home=f"p{post}", at_home=False, now_s=0.0, towards=["p0"])
    network = controller.network
    assert controller.comes_in("r1", "p0", 100.0) == LetIn(0, at_home=False)
    waits = controller.comes_in("r3", "p0", 101.0)
    assert isinstance(waits, Waits)
    assert waits.robots == ("r1",)
    controller.cleared("r1", "p1", "p0", 102.0)
    assert controller.grants(10_000.0) == [], "on the crossing"
    assert network.bays[0] == 1, "beside the one bay that is its own it stands at no home here"
    controller.crossed("r1", "p0", 10_001.0)
    assert controller.grants(10_002.0) == [("r3", LetIn(0, at_home=True))]


def test_a_bay_is_another_robots_only_when_the_one_in_it_is_wholly_in_its_corridor() -> None:
    controller = TrafficController(crossed_line(4))
    controller.joins("goes", post="b", home="a", at_home=False, now_s=0.0)
    controller.joins("comes", post="d", home="d", at_home=True, now_s=0.0)
    assert controller.give("comes", [Goal(1, 5.0, key="one")], 0.0)
    assert isinstance(controller.claims("comes", "d", "c", 0.0), Granted)
    controller.crossed("comes", "d", 10.0)
    assert isinstance(controller.claims("goes", "b", "a", 20.0), Granted)
    assert controller.next_move("comes", 110.0) == ComeIn(2, at_home=False)
    assert isinstance(controller.claims("comes", "c", "b", 110.0), Waits), "it may still be in the only bay"
    controller.crossed("goes", "b", 300.0)
    [(robot, answer)] = controller.grants(301.0)
    assert (robot, answer) == ("comes", Granted(crossed_line(4).lane(2, 1)))


def test_a_corridor_that_a_robot_goes_straight_on_from_is_its_own_until_it_is_on_the_crossing() -> None:
    controller = TrafficController(crossed_line(4, bays=2))
    controller.joins("r1", post="a", home="a", at_home=False, now_s=0.0, towards=["b"])
    controller.joins("r2", post="a", home="a", at_home=True, now_s=0.0)
    assert controller.give("r1", [Goal(3, 5.0, key="one")], 0.0)
    assert controller.give("r2", [Goal(1, 5.0, key="two")], 0.0)
    assert controller.next_move("r1", 98.0) == GoOn(crossed_line(4).lane(1, 2))
    assert isinstance(controller.claims("r1", "b", "c", 100.0), Granted)
    assert isinstance(controller.claims("r2", "a", "b", 105.0), Waits)
    assert held_crossings(controller, "r1") == [1]
    controller.cleared("r1", "a", "b", 106.0)
    assert [robot for robot, _ in controller.grants(106.0)] == ["r2"], "the crossing behind it is no matter"
    assert held_crossings(controller, "r1") == [1]
    controller.crossed("r1", "b", 112.0)
    assert held_crossings(controller, "r1") == []


def test_a_robot_goes_straight_on_if_it_can_soon_and_comes_in_if_it_cannot() -> None:
    controller = TrafficController(crossed_line(4, bays=2))
    controller.joins("r1", post="a", home="a", at_home=False, now_s=0.0, towards=["b"])
    controller.joins("r2", post="b", home="c", at_home=False, now_s=0.0, towards=["c"])
    assert controller.give("r1", [Goal(3, 5.0, key="one")], 0.0)
    controller.crossed("r2", "b", 1.0)
    assert controller.next_move("r1", 50.0) == ComeIn(1, at_home=False), "the corridor is not free by then"
    controller.comes_in("r2", "c", 60.0)
    controller.crossed("r2", "c", 70.0)
    assert controller.next_move("r1", 95.0) == GoOn(crossed_line(4).lane(1, 2))
    assert controller.give("r1", [Goal(1, 5.0, key="here"), Goal(3, 5.0, key="one")], 96.0)
    assert controller.next_move("r1", 97.0) == ComeIn(1, at_home=False), "it has something to do here"


def test_no_question_changes_where_a_robot_is_believed_to_be() -> None:
    """It is to make room before it goes on, and asks whether it may go on at once."""
    controller = TrafficController(crossed_line(3))
    controller.joins("r1", post="b", home="b", at_home=False, now_s=0.0)
    controller.joins("r3", post="b", home="c", at_home=False, now_s=0.0, towards=["c"], to_home=True)
    assert controller.give("r1", [Goal(2, 5.0, key="one")], 0.0)
    journeys = controller.journeys(1.0)
    stays, *further = journeys["r1"].work
    aside = Leg(None, 1.0, 1.0, 1, True, 0, 1.0 + OVER_S, OVER_S)
    journeys["r1"] = replace(journeys["r1"], work=(stays, aside, *further))
    assert controller.adopt({}, Schedule(journeys, 0.0), 1.0)
    before = {name: task.start for name, task in controller.tasks(2.0).items()}
    assert controller.next_move("r1", 2.0) == ComeIn(1, at_home=True)
    assert isinstance(controller.claims("r1", "b", "c", 2.0), Waits)
    assert controller.grants(2.0) == []
    assert controller.leads("r1") == crossed_line(3).lane(1, 2)
    assert {name: task.start for name, task in controller.tasks(2.0).items()} == before


def test_of_robots_that_come_to_a_crossing_together_each_is_planned_for_when_it_is_its_turn() -> None:
    controller = TrafficController(star(3, bays=3))
    for robot, post in (("r1", 1), ("r3", 3), ("r5", 5)):
        controller.joins(robot, post=f"p{post}", home=f"p{post}", at_home=False, now_s=0.0, towards=["p0"])
    ends_s = sorted(task.start.arrives_s for task in controller.tasks(0.0).values())
    assert all(later - sooner >= 5.0 for sooner, later in pairwise(ends_s))
    assert ends_s[0] == 100.0
    assert controller.give("r3", [Goal(6, 5.0, key="three")], 0.0, rounds=0)


def test_a_robot_makes_room_by_its_own_report_alone() -> None:
    controller = TrafficController(crossed_line(3))
    controller.joins("r1", post="b", home="b", at_home=False, now_s=0.0)
    controller.joins("r2", post="a", home="a", at_home=True, now_s=0.0)
    assert controller.give("r2", [Goal(1, 5.0, key="two")], 0.0)
    assert isinstance(controller.claims("r2", "a", "b", 2.0), Waits)
    assert controller.comes_in("r1", "b", 3.0) == LetIn(1, at_home=True)
    assert controller.grants(1_000.0) == [], "the bay is still its own"
    assert held_crossings(controller, "r1") == [1]
    controller.crossed("r1", "b", 1_001.0)
    assert [robot for robot, _ in controller.grants(1_002.0)] == ["r2"]
    assert controller.tasks(1_002.0)["r1"].start.at_home


def about_to_cross(arrives_s: float, entered_s: float = 0.0) -> tuple[Network, dict[str, Start], dict[str, Journey]]:
    """`first` comes along a corridor to the crossing of p0, where `me` stands and is to leave after it."""
    network = star(3, bays=2)
    comes = Start(0, False, arrives_s + 5.0, entered_s, network.lane(1, 0), arrives_s)
    starts = {"first": comes, "me": Start(0, False, 0.0, 0.0)}
    leaves = Leg(network.lane(0, 3), 120.0, 225.0, 3, False, 0, 230.0, 5.0)
    mine = Journey((standing(starts["me"]), leaves), (), 0.0)
    return network, starts, {"first": Journey((standing(comes),), (), 0.0), "me": mine}


def waits(arrives_s: float, now_s: float) -> list[str]:
    network, starts, journeys = about_to_cross(arrives_s)
    return list(waits_to_cross(network, starts, journeys, "me", 0, now_s))


def test_the_order_of_a_crossing_is_kept_with_who_is_about_to_come_and_not_with_who_is_late_or_far() -> None:
    assert waits(arrives_s=100.0, now_s=96.0) == ["first"]
    assert waits(arrives_s=100.0, now_s=100.0) == ["first"]
    assert waits(arrives_s=100.0, now_s=95.0) == [], "over before it comes"
    assert waits(arrives_s=100.0, now_s=100.1) == [], "late"
    assert waits(arrives_s=130.0, now_s=128.0) == [], "it is to come after"


def test_who_is_behind_another_in_a_corridor_is_not_let_over_before_it() -> None:
    network = replace(crossed_line(3, bays=3), lanes=followed(crossed_line(3)))
    controller = TrafficController(network)
    for robot in ("ahead", "behind"):
        controller.joins(robot, post="a", home="a", at_home=False, now_s=0.0, towards=["b"])
    answer = controller.comes_in("behind", "b", 500.0)
    assert isinstance(answer, Waits)
    assert answer.robots == ("ahead",)
    assert controller.comes_in("ahead", "b", 501.0) == LetIn(1, at_home=False)


def test_who_follows_one_that_had_to_wait_before_a_crossing_is_expected_behind_it() -> None:
    network = star(3, bays=3)
    controller = TrafficController(replace(network, lanes=followed(network)))
    for robot, post, now_s in (("first", 3, 0.0), ("ahead", 1, 1.0), ("behind", 1, 1.0)):
        controller.joins(robot, post=f"p{post}", home=None, at_home=False, now_s=now_s, towards=["p0"])
    ends_s = {robot: task.start.arrives_s for robot, task in controller.tasks(2.0).items()}
    assert ends_s["ahead"] > ends_s["first"] + 5.0
    assert ends_s["behind"] >= ends_s["ahead"] + 20.0


def followed(network: Network) -> tuple[tuple, ...]:  # type: ignore[type-arg]
    return tuple(tuple(lane._replace(following_s=20.0) for lane in out) for out in network.lanes)


def test_several_corridors_are_granted_with_the_crossings_between_if_no_robot_crosses_before() -> None:
    way = [("p1", "p0"), ("p0", "p5"), ("p5", "p6")]
    for leaves_first, granted, crossings in ((False, [0, 5, 6], [0, 1, 2, 5]), (True, [0], [1, 2])):
        controller = TrafficController(star(3, bays=2))
        controller.joins("r2", post="p2", home="p2", at_home=True, now_s=0.0)
        if leaves_first:  # it is done in its bay at p0 before r2 comes by
            controller.joins("r4", post="p0", home="p4", at_home=False, now_s=0.0)
            assert controller.give("r4", [Goal(0, 150.0, key="here")], 0.0)
        assert controller.give("r2", [Goal(6, 5.0, key="far")], 0.0, rounds=0)
        assert isinstance(controller.claims("r2", "p2", "p1", 0.0), Granted)
        assert [lane.end for lane in controller.goes_on("r2", way, 0.0)] == granted
        assert held_crossings(controller, "r2") == crossings


def test_after_a_restart_all_is_held_that_was_held_before() -> None:
    controller = TrafficController(crossed_line(4))
    controller.joins("out", post="a", home="a", at_home=False, now_s=0.0, towards=["b"], on_crossing=True)
    controller.joins("in", post="c", home="c", at_home=True, now_s=0.0, on_crossing=True)
    controller.joins("aside", post="d", home="d", at_home=False, now_s=0.0, on_crossing=True, to_home=True)
    assert {robot: held_crossings(controller, robot) for robot in ("out", "in", "aside")} == {
        "out": [0],
        "in": [2],
        "aside": [3],
    }
    bays = {robot: _bays(task.start) for robot, task in controller.tasks(1.0).items()}
    assert bays == {"out": [0, 1], "in": [], "aside": [3]}
    controller.crossed("out", "a", 10.0)
    controller.crossed("aside", "d", 10.0)
    bays = {robot: _bays(task.start) for robot, task in controller.tasks(11.0).items()}
    assert bays == {"out": [1], "in": [], "aside": []}
    controller.joins("home", post="c", home="d", at_home=False, now_s=20.0, towards=["d"], to_home=True, is_let_in=True)
    assert _bays(controller.tasks(21.0)["home"].start) == []
    assert held_crossings(controller, "home") == [3]


def _bays(start: Start) -> list[int]:
    return [one.post for one in (*start.on_the_way(), start) if not one.at_home]


def two_that_meet_on_a_crossing(after_s: float) -> list[str]:
    """One drives from p1 over p0 to p3 without a stop, another leaves its bay at p0 for p5 `after_s` later."""
    network = star(3, bays=2)
    first = Start(0, False, 105.0, 0.0, network.lane(1, 0), 100.0)
    other = Start(0, False, 0.0, 0.0)
    at_s = 100.0 + after_s
    straight_on = Leg(network.lane(0, 3), 100.0, 205.0, 3, True, 0, 210.0, 5.0)
    leaves = Leg(network.lane(0, 5), at_s, at_s + 105.0, 5, True, 0, at_s + 110.0, 5.0)
    passing = standing(first)._replace(ready_s=100.0, over_s=0.0)
    tasks = {"r1": Task(first, (), 3), "r2": Task(other, (), 5)}
    journeys = {
        "r1": Journey((passing, straight_on), (), 0.0),
        "r2": Journey((standing(other), leaves), (), 0.0),
    }
    return problems(network, tasks, journeys)


def test_the_check_sees_robots_that_meet_on_a_crossing() -> None:
    assert two_that_meet_on_a_crossing(after_s=5.1) == []
    assert two_that_meet_on_a_crossing(after_s=-5.1) == []
    for after_s in (5.0, 1.0, -1.0, -5.0):
        assert any("meet on the crossing of p0" in said for said in two_that_meet_on_a_crossing(after_s)), after_s


def test_the_check_sees_moves_that_are_too_quick_or_end_on_the_line() -> None:
    network = crossed_line(3)
    task = Task(Start(0, True, 0.0, 0.0), (Goal(2, 5.0),), 0)
    found = plan(network, {"r1": task}, ["r1"])
    assert found is not None
    journey = found.journeys["r1"]
    assert problems(network, {"r1": task}, {"r1": journey}) == []
    stays, on, last = journey.work
    assert (on.over_s, last.over_s) == (0.0, OVER_S), "it goes straight on at b"

    def said(*legs: Leg) -> list[str]:
        return problems(network, {"r1": replace(task, home=None)}, {"r1": Journey(legs, (), 0.0)})

    assert said(stays, on, last) == []
    assert said(stays, on, last._replace(over_s=1.0)) == ["r1 is too fast over the crossing of c"]
    assert "r1 is too fast on its way to b" in said(stays, on._replace(arrive_s=on.arrive_s - 5.0), last)
    later = last._replace(enter_s=last.enter_s + 5.0, arrive_s=last.arrive_s + 5.0, ready_s=last.ready_s + 5.0)
    assert said(stays, on, later) == ["r1 stops on the line before b"]
    assert "r1 does not come in at c, where it is to stop" in said(stays, on, last._replace(over_s=0.0))
    shut = replace(network, shut=frozenset({2}))
    assert problems(shut, {"r1": task}, {"r1": journey}) == ["r1 moves over the crossing of c, which is shut"]


def test_a_bay_that_is_left_is_taken_until_the_crossing_is_over_also_in_a_plan() -> None:
    network = star(3)
    goes, comes = Start(0, False, 0.0, 0.0), Start(3, False, 0.0, 0.0)
    tasks = {"goes": Task(goes, (), 1), "comes": Task(comes, (), 3)}
    leaves = Leg(network.lane(0, 1), 100.0, 205.0, 1, True, 0, 210.0, 5.0)

    def said(enter_s: float) -> list[str]:
        into = Leg(network.lane(3, 0), enter_s, enter_s + 105.0, 0, False, 0, enter_s + 110.0, 5.0)
        back = Leg(network.lane(0, 3), enter_s + 110.0, enter_s + 215.0, 3, True, 0, enter_s + 220.0, 5.0)
        journeys = {
            "goes": Journey((standing(goes), leaves), (), 0.0),
            "comes": Journey((standing(comes), into, back), (), 0.0),
        }
        return problems(network, tasks, journeys)

    assert said(105.1) == []
    assert said(104.0) == ["comes finds no bay at p0 at 104.0 s"]


def test_a_robot_without_work_comes_in_where_its_corridor_ends() -> None:
    controller = TrafficController(star(3))
    controller.joins("r1", post="p1", home=None, at_home=False, now_s=0.0, towards=["p0"])
    assert controller.next_move("r1", 99.0) == ComeIn(0, at_home=False)
    assert controller.leads("r1") is None


def test_whatever_is_planned_over_crossings_can_be_carried_out() -> None:
    for seed in range(20):
        rng = Random(seed)
        network = random_network(rng, crossing=True, following=seed % 3 == 0)
        tasks = random_tasks(rng, network, 5)
        found = planned(rng, network, tasks)
        assert problems(network, tasks, found.journeys) == [], seed
        assert problems(network, tasks, retimed(network, tasks, found.journeys)) == [], seed
