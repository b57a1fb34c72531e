"""Why an order waits, in words: of everything that a decision has weighed."""

from dataclasses import replace

import pytest

from fleet.assignment.problem import OpenOrder, RobotAtWork
from fleet.assignment.why import why_orders_wait
from tests.app.dispatch.fleet_life import order
from tests.app.dispatch.test_fleet_plan import decided, problem_of, robot, street

OLD, WAITS, YOUNG = order(0, 1, 2, since_s=-9000.0), order(1, 1, 2, since_s=-300.0), order(2, 1, 2)
OVERDUE = replace(WAITS, since_s=-30_000.0)
LATER = replace(WAITS, load=WAITS.load._replace(not_before_s=5000.0))
WANTED = replace(WAITS, wanted=frozenset({"r7"}))
BRINGS = replace(order(3, 0, 4), loaded=True)


def told(robots: dict[str, RobotAtWork], orders: list[OpenOrder], about: OpenOrder, closed: str = "") -> str:
    problem = problem_of(street(5), robots, orders)
    problem = replace(problem, network=problem.network.without({closed}))
    return why_orders_wait(decided(problem))[about.id].sentence(lambda at_s: f"{at_s:.0f} s")


@pytest.mark.parametrize(
    ("robots", "orders", "sentence"),
    [
        ({"r0": robot(0)}, [WAITS], "r0 fetches it at about 100 s."),
        (
            {"r0": robot(0, route=BRINGS.stops[1:], begun=1, capacity=2)},
            [BRINGS, WAITS],
            "r0 fetches it at about 710 s, after 1 other stop.",
        ),
        ({"r0": robot(0)}, [OLD, WAITS, YOUNG], "It is fetched as soon as a robot has room."),
        (
            {"r0": robot(0)},
            [OLD, replace(YOUNG, id="o9", since_s=-400.0), WAITS],
            "Every robot is busy, and 1 other order will be fetched first.",
        ),
        ({"r0": robot(0)}, [LATER], "It is to be fetched at 5000 s."),
        ({"r0": robot(0)}, [WANTED], "It is to go with r7, which is not connected."),
        (
            {"r0": robot(0, route=BRINGS.stops[1:])},
            [BRINGS, OVERDUE],
            "It has waited too long and is fetched next, as soon as a robot has room.",
        ),
        ({}, [WAITS], "No robot is connected at the moment."),
        ({"r0": robot(0, accepts=False)}, [WAITS], "The robots that may fetch it take no orders at the moment."),
        ({"r0": robot(0, drives_s=10.0)}, [WAITS], "The free robots are charging first."),
    ],
)
def test_people_are_told_why_an_order_waits(
    robots: dict[str, RobotAtWork], orders: list[OpenOrder], sentence: str
) -> None:
    assert told(robots, orders, next(one for one in orders if one.id == WAITS.id)) == sentence


def test_people_are_told_that_no_way_leads_there() -> None:
    assert told({"r0": robot(0)}, [WAITS], WAITS, closed="p2") == "No way that is open leads there."
