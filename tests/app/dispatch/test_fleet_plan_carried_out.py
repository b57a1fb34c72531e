"""A decision is taken over by the traffic, and the traffic is what the next one begins with."""

from dataclasses import replace
from random import Random

from fleet.assignment.adopting import Able, adopt, problem_of
from fleet.assignment.problem import OpenOrder
from fleet.schedule.controller import Denied, Granted, TrafficController
from fleet.schedule.journey import Goal
from fleet.schedule.planning import Schedule, first_plan
from fleet.schedule.validation import problems
from tests.app.dispatch.fleet_life import order
from tests.app.dispatch.test_fleet_plan import decided, street

ABLE = {"r0": Able(), "r1": Able()}


def traffic_on(posts: int) -> TrafficController:
    """One robot at each end."""
    traffic = TrafficController(street(posts))
    traffic.joins("r0", post="p0", home="p0", at_home=True, now_s=0.0)
    traffic.joins("r1", post=f"p{posts - 1}", home=f"p{posts - 1}", at_home=True, now_s=0.0)
    return traffic


def dispatch(traffic: TrafficController, orders: list[OpenOrder], now_s: float) -> dict[str, str]:
    """Which robot has which order, once the traffic has taken it over."""
    decision = decided(problem_of(traffic, ABLE, {one.id: one for one in orders}, now_s))
    assert adopt(traffic, decision, ABLE, now_s)
    return decision.robot_of()


def test_an_order_is_fetched_loaded_and_given_as_the_traffic_lets_the_robot_go() -> None:
    traffic, one = traffic_on(4), order(0, 1, 2)
    assert dispatch(traffic, [one], 0.0) == {one.id: "r0"}
    assert isinstance(traffic.claims("r0", "p0", "p1", 1.0), Granted)
    traffic.cleared("r0", "p0", "p1", 101.0)
    traffic.served("r0", one.load.key, 111.0)
    loaded = replace(one, loaded=True)
    assert dispatch(traffic, [loaded], 112.0) == {one.id: "r0"}
    assert traffic.goals("r0") == (one.give,)
    assert isinstance(traffic.claims("r0", "p1", "p2", 113.0), Granted)


def test_a_frozen_robot_keeps_what_it_has_aboard_and_another_fetches_the_rest() -> None:
    traffic, aboard, other = traffic_on(4), order(0, 0, 2), order(1, 1, 3)
    able = {"r0": Able(capacity=2), "r1": Able()}
    traffic.give("r0", (aboard.give, other.load, other.give), 0.0)
    traffic.freeze("r0", 1.0)
    orders = {aboard.id: replace(aboard, loaded=True), other.id: other}
    decision = decided(problem_of(traffic, able, orders, 2.0))
    assert decision.robot_of() == {other.id: "r1"}
    assert adopt(traffic, decision, able, 2.0)
    assert traffic.goals("r0") == (aboard.give,)
    assert traffic.goals("r1") == other.stops[0][1:2] + other.stops[1][1:2]


def test_what_a_robot_does_for_reasons_of_its_own_stays_and_so_does_what_no_way_leads_to() -> None:
    traffic, aboard, own = traffic_on(4), replace(order(0, 0, 3), loaded=True), Goal(0, 30.0, key="its own")
    traffic.give("r0", (own, aboard.give), 0.0)
    traffic.close("p3", 1.0)
    decision = decided(problem_of(traffic, ABLE, {aboard.id: aboard}, 2.0))
    assert adopt(traffic, decision, ABLE, 2.0)
    assert traffic.goals("r0") == (own, aboard.give)


def test_an_order_that_cannot_be_given_at_the_moment_is_kept_whole() -> None:
    """A dead robot has the only bay where the mail goes: that stop is in no schedule, and is not forgotten."""
    traffic, one, able = TrafficController(street(4, bays=1)), order(0, 1, 2), {"r0": Able()}
    traffic.joins("r0", post="p0", home="p0", at_home=True, now_s=0.0)
    traffic.give("r0", (one.load, one.give), 0.0)
    traffic.joins("dead", post="p2", home="p3", at_home=False, now_s=1.0)
    traffic.freeze("dead", 2.0)
    assert traffic.tasks(3.0)["r0"].goals == (one.load,)
    decision = decided(problem_of(traffic, able, {one.id: one}, 3.0))
    assert adopt(traffic, decision, able, 3.0)
    assert traffic.goals("r0") == (one.load, one.give)
    traffic.unfreeze("dead", 4.0)
    assert traffic.tasks(5.0)["r0"].goals == (one.load, one.give)


def test_a_decision_that_has_come_too_late_changes_nothing() -> None:
    traffic, one = traffic_on(4), order(0, 1, 2)
    decision = decided(problem_of(traffic, ABLE, {one.id: one}, 0.0))
    traffic.stands("r0", "p2", 5.0)  # a person has carried it there
    assert not adopt(traffic, decision, ABLE, 6.0)
    assert traffic.goals("r0") == ()


def test_a_schedule_is_checked_again_before_it_counts() -> None:
    """Between the decision and its coming true a way has been closed, so that it would lead through it."""
    traffic, one = traffic_on(4), order(0, 1, 2)
    decision = decided(problem_of(traffic, ABLE, {one.id: one}, 0.0))
    before = traffic.journeys(5.0)
    traffic.close("p2", 5.0)
    assert not adopt(traffic, decision, ABLE, 6.0)
    assert traffic.goals("r0") == ()
    assert traffic.journeys(6.0).keys() == before.keys()
    assert isinstance(traffic.claims("r0", "p1", "p2", 7.0), Denied)
    traffic.open("p2", 8.0)
    assert adopt(traffic, decision, ABLE, 9.0)


def test_two_that_were_each_planned_alone_are_not_let_into_each_others_bays() -> None:
    """One bay at each post: both want to stand in the middle at the same time."""
    traffic = TrafficController(street(3, bays=1))
    traffic.joins("r0", post="p0", home="p0", at_home=True, now_s=0.0)
    traffic.joins("r1", post="p2", home="p2", at_home=True, now_s=0.0)
    orders = {"r0": order(0, 1, 1, handling_s=500.0), "r1": order(1, 1, 1, handling_s=500.0)}
    tasks = traffic.tasks(0.0)
    alone = {
        name: first_plan(traffic.network, {name: replace(tasks[name], goals=(one.load, one.give))}, Random(0))
        for name, one in orders.items()
    }
    journeys = {name: found.journeys[name] for name, found in alone.items() if found is not None}
    goals = {name: (one.load, one.give) for name, one in orders.items()}
    both = {name: replace(task, goals=goals[name]) for name, task in tasks.items()}
    assert problems(traffic.network, both, journeys)
    assert not traffic.adopt(goals, Schedule(journeys, 0.0, ("r0", "r1")), 0.0)
    assert traffic.goals("r0") == traffic.goals("r1") == ()
    assert problems(traffic.network, traffic.tasks(0.0), traffic.journeys(0.0)) == []
