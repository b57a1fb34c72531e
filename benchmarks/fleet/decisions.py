"""Time of a decision: the first answer for one event, how well the improvement keeps to its time, and how the
first answer grows with the number of orders."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import islice
from math import inf, log
from random import Random
from statistics import mean, median, quantiles
from time import perf_counter
from typing import Any

from app.cli.serving import settle_memory
from benchmarks.body.report import Wanted, say
from benchmarks.fleet.demand import Saturated
from benchmarks.fleet.grounds import tunnels
from benchmarks.fleet.planned import Planning, so_many
from benchmarks.fleet.samples import Samples
from benchmarks.fleet.world import World
from fleet.assignment.deciding import Decision, decide
from fleet.assignment.improving import improved, within
from fleet.assignment.problem import AssignmentProblem

ROBOTS, ORDERS, BAYS = 20, 200, 3
CAPACITIES = (1, 2, 4)
MORE_ORDERS = (100, 200, 400, 800, 1600, 3200)
BUDGET_S = 0.25
EVENTS, IMPROVED_EVENTS = 400, 60
MOMENTS, MOMENTS_EVERY, REPEATS = 8, 5, 5
WANTED = [
    *(Wanted(f"capacity_{capacity}.first_ms.p99", at_most=20.0, unit="ms") for capacity in CAPACITIES),
    Wanted("improvement.longest_ms", at_most=1e3 * BUDGET_S, unit="ms"),
    Wanted("growth.of_n_log_n", at_most=1.0),
]


class EnoughError(Exception):
    """So many decisions as are wanted have been made."""


class Counted(Planning):
    """Ends the run where one more decision would have to be made."""

    most = 0

    def decide(self, world: World) -> None:
        if len(self.spent) >= self.most:
            raise EnoughError
        super().decide(world)


class InTime(Counted):
    """Improves as long as the service does."""

    def improved(self, first: Decision) -> Decision:
        in_time = within(BUDGET_S, perf_counter)
        return improved(first, self.rng, in_time, in_time)


def measure(samples: Samples) -> dict[str, Any]:
    """Memory is looked through for garbage as in the service: else a look through all that the benchmarks have loaded
    stands still for 30 ms, in the middle of a decision."""
    settle_memory()
    return {
        **{f"capacity_{capacity}": _first_answers(capacity, samples.first_seed) for capacity in CAPACITIES},
        "improvement": _improvements(samples.first_seed),
        "growth": _growth(samples.first_seed),
    }


def _first_answers(capacity: int, seed: int) -> dict[str, Any]:
    """Events of a fleet at work. The very first decision, for everybody at once, is told apart."""
    planning = _at_work(seed, EVENTS, ORDERS, capacity)[0]
    first_ms = [1e3 * one.first_s for one in planning.spent]
    figures = {
        "events": len(first_ms) - 1,
        "everybody_at_once_ms": round(first_ms[0], 2),
        "first_ms": _spread(first_ms[1:]),
    }
    say(f"  {ROBOTS} robots with {capacity} items each, {ORDERS} orders waiting: {figures}")
    return figures


def _improvements(seed: int) -> dict[str, Any]:
    planning = _at_work(seed, IMPROVED_EVENTS, ORDERS, kind=InTime)[0]
    took_ms = [1e3 * one.improvement_s for one in planning.spent]
    gained_s = [one.first_cost_s - one.cost_s for one in planning.spent]
    figures = {
        "events": len(took_ms),
        "longest_ms": round(max(took_ms), 1),
        "gained_s": round(median(gained_s), 1),
        "of_them_gained": round(sum(gained > 0 for gained in gained_s) / len(gained_s), 3),
    }
    say(f"  improvement within {1e3 * BUDGET_S:.0f} ms: {figures}")
    return figures


def _growth(seed: int) -> dict[str, Any]:
    """The same robots at the same moments, with more and more orders that wait: how much longer a decision takes, from
    the fewest to the most, as a share of what n log n would be."""
    at_work = [_at_work(seed, MOMENTS_EVERY * number, max(MORE_ORDERS)) for number in range(1, MOMENTS + 1)]
    scenes = [planning.problem(world) for planning, world in at_work]
    took_ms = {count: mean(_decision_ms(_with_waiting(problem, count)) for problem in scenes) for count in MORE_ORDERS}
    fewest, most = MORE_ORDERS[0], MORE_ORDERS[-1]
    allowed = most * log(most) / (fewest * log(fewest))
    figures = {
        "orders_ms": {str(count): round(one, 2) for count, one in took_ms.items()},
        "of_n_log_n": round(took_ms[most] / took_ms[fewest] / allowed, 4),
    }
    say(f"  growth: {figures}")
    return figures


def _at_work(
    seed: int, events: int, orders: int, capacity: int = 1, kind: type[Counted] = Counted
) -> tuple[Planning, World]:
    """A fleet after so many decisions, at the moment of the next."""
    ground = tunnels(BAYS)
    demand = Saturated(len(ground.network.posts), seed, orders)
    planning = kind(demand, Random(seed), so_many(5), capacity, keeps_waiting=orders)
    planning.most = events
    world = World(ground.network, ground.homes(ROBOTS), Random(seed))
    with suppress(EnoughError):
        world.run(inf, planning.look)
    return planning, world


def _with_waiting(problem: AssignmentProblem, count: int) -> AssignmentProblem:
    placed = {stop.order for robot in problem.robots.values() for stop in robot.route}
    waiting = islice((name for name in problem.orders if name not in placed), count)
    return replace(problem, orders={name: problem.orders[name] for name in (*placed, *waiting)})


def _decision_ms(problem: AssignmentProblem) -> float:
    took_ms = []
    for _ in range(REPEATS):
        begun_s = perf_counter()
        decide(problem)
        took_ms.append(1e3 * (perf_counter() - begun_s))
    return median(took_ms)


def _spread(values: Sequence[float]) -> dict[str, float]:
    cuts = quantiles(values, n=100, method="inclusive")
    return {name: round(value, 2) for name, value in (("p50", cuts[49]), ("p95", cuts[94]), ("p99", cuts[98]))} | {
        "max": round(max(values), 2)
    }
