"""Throughput as a share of what robots would do that could pass through each other: tunnels, saturated demand.

Three shares are reported, since each says something else: of first come first served without conflicts; of the same
rule without conflicts (always the nearest order that waits: the hardest, and what is judged); and of the time of the
orders that were taken (what they would take alone, of what they took; of our own rules, since the planner changes its
mind about who takes what).
"""

from dataclasses import dataclass
from math import inf
from random import Random
from statistics import mean
from typing import Any

from benchmarks.body.report import Wanted, say
from benchmarks.fleet import plots, without_conflicts
from benchmarks.fleet.assigning import AGE_LIMIT_S, Assigning, Rule
from benchmarks.fleet.demand import Saturated
from benchmarks.fleet.grounds import Ground, tunnels
from benchmarks.fleet.planned import Planning, so_many
from benchmarks.fleet.planned import delivered as delivered_by_planner
from benchmarks.fleet.samples import Samples
from benchmarks.fleet.world import World

FOLLOWING_S = 60.0
PLAIN = Rule("first come", age_limit_s=inf)
JOINT = Rule("quickest", orders=5, rounds=30)
ROUNDS = 60
"""Of the planner, for each decision: about what it has time for in its budget."""


@dataclass(frozen=True, slots=True)
class Case:
    """`rule` None: the product's planner."""

    robots: int
    bays: int
    rule: Rule | None = None
    spread: float = 0.0
    following_s: float | None = None


CASES = {
    "plain_2_bays": [Case(robots, 2, PLAIN) for robots in (4, 6, 8)],
    "joint_2_bays": [Case(robots, 2, JOINT) for robots in (4, 6, 8)],
    "1_bay": [Case(robots, 1) for robots in (4, 6, 8)],
    "2_bays": [Case(robots, 2) for robots in (4, 6, 8)],
    "3_bays": [Case(robots, 3) for robots in (4, 6, 8)],
    "2_bays_late": [Case(robots, 2, spread=0.2) for robots in (4, 6)],
    "2_bays_following": [Case(robots, 2, following_s=FOLLOWING_S) for robots in (4, 6)],
    "3_bays_following": [Case(robots, 3, following_s=FOLLOWING_S) for robots in (4, 6)],
}
_LEAST = {
    "2_bays": (0.92, 0.85, 0.73),
    "3_bays": (0.92, 0.86, 0.77),
    "2_bays_late": (0.90, 0.83),
    "2_bays_following": (0.93, 0.87),
    "3_bays_following": (0.95, 0.92),
}
WANTED = [
    Wanted(f"{name}.{case.robots}_robots.of_same_rule", at_least=least)
    for name, bounds in _LEAST.items()
    for case, least in zip(CASES[name], bounds, strict=True)
]


@dataclass(frozen=True, slots=True)
class Run:
    """One case with one seed; counts of orders."""

    delivered: int
    first_come: int
    same_rule: int
    of_orders_taken: float | None
    refused: int


def measure(samples: Samples) -> dict[str, Any]:
    jobs = [(case, seed, samples.hours) for cases in CASES.values() for case in cases for seed in samples.some_seeds()]
    runs = samples.each(run, jobs)
    figures = {
        name: {f"{case.robots}_robots": _figures([next(runs) for _ in samples.some_seeds()]) for case in cases}
        for name, cases in CASES.items()
    }
    plots.throughput(samples.plots, figures, _LEAST)
    return figures


def run(job: tuple[Case, int, float]) -> Run:
    case, seed, hours = job
    ground, until_s = tunnels(case.bays, case.following_s), hours * 3600
    demand = Saturated(len(ground.network.posts), seed)
    world = World(ground.network, ground.homes(case.robots), Random(seed), case.spread)
    if case.rule is None:
        planning = Planning(demand, Random(seed), so_many(ROUNDS))
        world.run(until_s, planning.look)
        delivered, share, refused = delivered_by_planner(world, until_s), None, planning.refused
    else:
        assigning = Assigning(case.rule, demand, Random(seed))
        world.run(until_s, assigning.look)
        delivered, share = _of_orders_taken(assigning, world, until_s)
        refused = assigning.refused
    found = Run(delivered, *_without_conflicts(ground, case, seed, hours), share, refused)
    say(f"  {case}, seed {seed}: {found}")
    return found


def _without_conflicts(ground: Ground, case: Case, seed: int, hours: float) -> tuple[int, int]:
    """First come first served, and by the rule of the case."""
    first_come = without_conflicts.delivered(ground, case.robots, seed, hours, nearest=False)
    if case.rule == PLAIN:
        return first_come, first_come
    limit_s = AGE_LIMIT_S if case.rule is None else case.rule.age_limit_s
    nearest = without_conflicts.delivered(ground, case.robots, seed, hours, nearest=True, age_limit_s=limit_s)
    return first_come, nearest


def _of_orders_taken(assigning: Assigning, world: World, until_s: float) -> tuple[int, float]:
    served_s = world.served_s
    finished = [trip for trip in assigning.trips if served_s.get(str(trip.order.number), inf) <= until_s]
    taken_s = sum(served_s[str(trip.order.number)] - trip.taken_s for trip in finished)
    return len(finished), sum(trip.alone_s for trip in finished) / taken_s


def _figures(runs: list[Run]) -> dict[str, Any]:
    shares = [one.of_orders_taken for one in runs if one.of_orders_taken is not None]
    return {
        "of_first_come": round(mean(one.delivered / one.first_come for one in runs), 4),
        "of_same_rule": round(mean(one.delivered / one.same_rule for one in runs), 4),
        "of_orders_taken": round(mean(shares), 4) if shares else None,
        "delivered": sum(one.delivered for one in runs),
        "refused": sum(one.refused for one in runs),
    }
