"""The forecast of a plan with durations that are not known beforehand: it includes waits for others and charging."""

from collections.abc import Callable
from dataclasses import replace
from random import Random

import pytest

from fleet.eta.forecast import Chance, forecast
from fleet.eta.intervals import Interval
from fleet.schedule.journey import Goal, Start, Task
from fleet.schedule.network import Lane, Network
from fleet.schedule.planning import first_plan
from fleet.schedule.under_way import further

SECONDS = 100.0
NAMES = ("a", "b", "c")


def line(bays: int = 1) -> Network:
    """Three posts in a row."""
    there = tuple(Lane(at, 0, at, at + 1, SECONDS) for at in range(2))
    back = tuple(Lane(at, 1, at + 1, at, SECONDS) for at in range(2))
    return Network(NAMES, (bays,) * 3, ("a-b", "b-c"), ((there[0],), (back[0], there[1]), (back[1],)))


def chance(rng: Random, spread: float = 0.2) -> Chance:
    return Chance(
        lambda _, lane: lane.travel_s * rng.uniform(1 - spread, 1 + spread),
        lambda goal: goal.handling_s,
        lambda _, lane, entered_s: entered_s + lane.travel_s,
    )


def at_home(post: int, *goals: Goal) -> Task:
    return Task(Start(post, True, 0.0, 0.0), goals, post)


def forecast_of(
    tasks: dict[str, Task], *, now_s: float = 0.0, of: Callable[[Random], Chance] = chance
) -> dict[str, Interval]:
    network = line()
    found = first_plan(network, tasks, Random(1))
    assert found is not None
    return forecast(network, tasks, found.journeys, now_s, of(Random(2)), draws=200)


def test_a_robot_alone_comes_when_its_ways_and_stops_are_over() -> None:
    told = forecast_of({"r1": at_home(0, Goal(1, 60.0, key="load"), Goal(2, 60.0, key="receive"))})
    assert told["load"].p50_s == pytest.approx(100.0, abs=4.0)
    assert told["receive"].p50_s == pytest.approx(260.0, abs=6.0)
    assert told["receive"].p10_s < 245.0
    assert told["receive"].p90_s > 275.0


def test_a_robot_that_was_let_into_its_whole_way_comes_through_one_corridor_after_the_other() -> None:
    network = line()
    there, further_on = network.lane(0, 1), network.lane(1, 2)
    start = further(
        further(Start(0, True, 0.0, 0.0), there, at_home=False, now_s=0.0), further_on, at_home=False, now_s=0.0
    )
    told = forecast_of({"r1": Task(start, (Goal(2, 60.0, key="receive"),), 0)}, now_s=30.0)
    assert told["receive"].p50_s == pytest.approx(2 * SECONDS - 30.0, abs=1.0)


def test_who_waits_for_another_to_come_out_is_told_so_and_is_late_if_that_one_is() -> None:
    first, second = Goal(0, 0.0, key="first"), Goal(2, 0.0, key="second")
    both = {"r1": at_home(2, first), "r2": at_home(0, second)}
    alone = forecast_of({"r2": both["r2"]})["second"].p50_s
    told = forecast_of(both)
    assert max(told["first"].p50_s, told["second"].p50_s) > alone + 0.9 * SECONDS

    def slow(rng: Random) -> Chance:
        usual = chance(rng)
        return usual._replace(
            travel_s=lambda robot, lane: 3 * SECONDS if robot == "r1" else usual.travel_s(robot, lane)
        )

    slowed = forecast_of(both, of=slow)
    assert slowed["second"].p50_s > told["second"].p50_s + SECONDS


def test_a_charge_before_an_order_is_in_its_estimate() -> None:
    order = Goal(1, 0.0, key="order")
    charged = forecast_of({"r1": at_home(0, Goal(0, 1800.0, key="charge"), order)})
    assert charged["order"].p50_s == pytest.approx(
        forecast_of({"r1": at_home(0, order)})["order"].p50_s + 1800, abs=8.0
    )


def test_who_is_in_a_corridor_arrives_as_is_usual_since_its_entry() -> None:
    lane = line().lanes[0][0]
    start = Start(1, False, 100.0, 0.0, lane, 100.0)
    task = replace(at_home(0, Goal(1, 0.0, key="order")), start=start)
    assert forecast_of({"r1": task}, now_s=40.0)["order"] == (60.0, 60.0, 60.0)
