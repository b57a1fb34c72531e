"""A dead robot's bay and corridor are unavailable to all; robots that need neither go on."""

from fleet.schedule.controller import Denied, Granted, TrafficController
from fleet.schedule.journey import Goal
from tests.fleet.schedule.test_controller import line


def test_a_dead_robot_in_the_only_bay_of_a_post_lets_no_robot_pass_and_all_are_told() -> None:
    controller = TrafficController(line(4))
    controller.joins("dead", post="b", home="b", at_home=False, now_s=0.0)
    controller.joins("r1", post="d", home="d", at_home=True, now_s=0.0)
    controller.freeze("dead", 1.0)
    beyond, before = Goal(0, 10.0, key="beyond"), Goal(2, 10.0, key="before")
    assert controller.give("r1", [beyond, before], 2.0)
    assert controller.out_of_reach() == {"r1"}
    assert [goal.key for goal in controller.tasks(2.0)["r1"].goals] == ["before"]
    assert isinstance(controller.claims("r1", "d", "c", 3.0), Granted)
    controller.cleared("r1", "d", "c", 103.0)
    assert isinstance(controller.claims("r1", "c", "b", 104.0), Denied)
    controller.served("r1", "before", 114.0)
    controller.unfreeze("dead", 115.0)
    assert controller.out_of_reach() == frozenset()


def test_where_there_is_one_more_bay_a_dead_robot_is_passed() -> None:
    controller = TrafficController(line(4, bays=2))
    controller.joins("dead", post="b", home="b", at_home=False, now_s=0.0)
    controller.joins("r1", post="d", home="d", at_home=True, now_s=0.0)
    controller.freeze("dead", 1.0)
    assert controller.give("r1", [Goal(0, 10.0, key="beyond")], 2.0)
    assert controller.out_of_reach() == frozenset()
    for now_s, (start, end) in zip((3.0, 110.0, 220.0), ("dc", "cb", "ba"), strict=True):
        assert isinstance(controller.claims("r1", start, end, now_s), Granted)
        controller.cleared("r1", start, end, now_s + 100.0)


def test_what_is_given_to_a_robot_that_stands_is_planned_for_when_it_goes_on() -> None:
    controller = TrafficController(line(4))
    controller.joins("r1", post="a", home="a", at_home=True, now_s=0.0)
    controller.freeze("r1", 1.0)
    goal = Goal(3, 10.0, key="later")
    assert controller.give("r1", [goal], 2.0)
    assert (controller.goals("r1"), controller.leads("r1")) == ((goal,), None)
    controller.unfreeze("r1", 3.0)
    assert [left.key for left in controller.tasks(3.0)["r1"].goals] == ["later"]
    assert isinstance(controller.claims("r1", "a", "b", 4.0), Granted)
