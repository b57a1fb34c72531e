"""Time of a decision: the first answer, as the shipped service asks for it in a simulated fleet at work; a closure, in
the traffic as it is then; how well the improvement keeps to its time; and how the first answer grows with robots."""

from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass, field
from math import log
from random import Random
from statistics import mean, median, quantiles
from time import perf_counter, thread_time
from typing import Any, Final

from app.cli.serving import settle_memory
from app.dispatch.open_work import LOOKED_AT
from benchmarks.body.report import Wanted, say
from benchmarks.fleet.samples import Samples
from benchmarks.fleet_simulation.demand import Saturated
from benchmarks.fleet_simulation.faults import NONE
from benchmarks.fleet_simulation.honeycomb import Honeycomb
from benchmarks.fleet_simulation.process import simulates_only
from benchmarks.fleet_simulation.service import CALM, PlansInRounds
from benchmarks.fleet_simulation.simulation import NEVER_EMPTY, SETTLES_S, Fleet, Run, Seen
from fleet.assignment.deciding import Decision, decide
from fleet.assignment.improving import improved, within
from fleet.assignment.problem import AssignmentProblem
from fleet.schedule.controller import TrafficController

ROUNDS: Final = 5
CAPACITIES: Final = (1, 2, 4)
BUDGET_S: Final = 0.25
IMPROVED: Final = 60
MOMENTS, REPEATS, CLOSURES = 8, 5, 20
WANTED = [
    *(Wanted(f"capacity_{capacity}.first_ms.p99", at_most=20.0, unit="ms") for capacity in CAPACITIES),
    Wanted("hundred_robots.first_ms.p99", at_most=250.0, unit="ms"),
    Wanted("hundred_robots.closure_ms.max", at_most=500.0, unit="ms"),
    Wanted("improvement.longest_ms", at_most=1e3 * BUDGET_S, unit="ms"),
    Wanted("growth.robots_of_n_log_n", at_most=1.0),
]


@dataclass(frozen=True, slots=True)
class Size:
    """So many robots with so many orders waiting, on a campus of so many `posts`, for some hours."""

    robots: int
    orders: int
    posts: int
    hours: float

    @property
    def looked_at(self) -> int:
        """So many of them the service puts to the planner."""
        return min(self.orders, LOOKED_AT)


TWENTY: Final = Size(20, 200, 36, 3.0)
HUNDRED: Final = Size(100, 1000, 195, 0.7)
MORE_ROBOTS: Final = (Size(20, 500, 195, 0.1), Size(60, 500, 195, 0.1), Size(180, 500, 195, 0.1))


@dataclass
class Watched(PlansInRounds):
    """Keeps what the service asked and how long the answer took, by the clock and by the processor of this thread, in
    which simulated time has it made. Only of decisions that give an order to a robot, with as many orders waiting as
    are wanted."""

    orders: int = 0
    took_s: list[float] = field(default_factory=list)
    processor_s: list[float] = field(default_factory=list)
    asked: list[AssignmentProblem] = field(default_factory=list)

    async def decided(self, problem: AssignmentProblem, rng: Random) -> Decision | None:
        begun_s, begun_processor_s = perf_counter(), thread_time()
        decision = await super().decided(problem, rng)
        took_s, processor_s = perf_counter() - begun_s, thread_time() - begun_processor_s
        if decision is not None and len(problem.orders) >= self.orders and _gives(problem, decision):
            self.took_s.append(took_s)
            self.processor_s.append(processor_s)
            self.asked.append(problem)
        return decision


def measure(samples: Samples) -> dict[str, Any]:
    """Memory is looked through for garbage as in the service: else a look through all that the benchmarks have loaded
    stands still for 30 ms, in the middle of a decision."""
    simulates_only()
    settle_memory()
    seed = samples.first_seed
    return {
        **{f"capacity_{capacity}": _first_answers(TWENTY, capacity, seed) for capacity in CAPACITIES},
        "hundred_robots": _first_answers(HUNDRED, 1, seed),
        "improvement": _improvements(seed),
        "growth": _growth(seed),
    }


def _first_answers(size: Size, capacity: int, seed: int) -> dict[str, Any]:
    """Of a fleet at work. The first decisions, until each robot has had something to do, are told apart."""
    watched, seen = _at_work(size, capacity, seed)
    start = until_all_work(watched.asked)
    figures = {
        "decisions": len(watched.took_s) - start,
        "at_the_start_ms": _spread(watched.took_s[:start]),
        "first_ms": _spread(watched.took_s[start:]),
        "first_processor_ms": _spread(watched.processor_s[start:]),
        "problem_ms": _spread(seen.beside_s["of"]),
        "traffic_ms": _spread(seen.beside_s["follow_and_answer"]),
        "closure_ms": _spread(_closures_s(seen.traffic, size.hours * 3600.0 + 2 * SETTLES_S)),
    }
    say(f"  {size.robots} robots with {capacity} items each, {size.orders} orders waiting: {figures}")
    return figures


def until_all_work(asked: Sequence[AssignmentProblem]) -> int:
    """How many of these were asked before each robot had had something to do."""
    idle = set(asked[0].robots) if asked else set[str]()
    for number, problem in enumerate(asked):
        idle -= {name for name, robot in problem.robots.items() if robot.route}
        if not idle:
            return number
    return len(asked)


def _closures_s(traffic: TrafficController | None, now_s: float) -> list[float]:
    """Of each of some corridors that robots are to go through: how long it takes to plan anew round it."""
    if traffic is None:
        return []
    ways = {leg.lane.corridor for one in traffic.journeys(now_s).values() for leg in one.legs[1:] if leg.lane}
    took_s = []
    for corridor in Random(0).sample(sorted(ways), min(CLOSURES, len(ways))):
        as_it_was = deepcopy(traffic)
        begun_s = perf_counter()
        as_it_was.close(traffic.network.corridors[corridor], now_s)
        took_s.append(perf_counter() - begun_s)
    return took_s


def _improvements(seed: int) -> dict[str, Any]:
    """Within the service's budget, of what it asked."""
    asked = _at_work(TWENTY, 1, seed)[0].asked[-IMPROVED:]
    rng, took_ms, gained_s = Random(seed), list[float](), list[float]()
    for problem in asked:
        first = decide(problem, rng)
        assert first is not None
        begun_s = perf_counter()
        in_time = within(BUDGET_S, perf_counter)
        gained_s.append(first.cost_s - improved(first, rng, in_time, in_time).cost_s)
        took_ms.append(1e3 * (perf_counter() - begun_s))
    figures = {
        "decisions": len(took_ms),
        "longest_ms": round(max(took_ms), 1),
        "gained_s": round(median(gained_s), 1),
        "of_them_gained": round(sum(gained > 0 for gained in gained_s) / len(gained_s), 3),
    }
    say(f"  improvement within {1e3 * BUDGET_S:.0f} ms: {figures}")
    return figures


def _growth(seed: int) -> dict[str, Any]:
    """How much longer a decision takes with more robots and the same orders, from the fewest to the most, as a share of
    what n log n would be. More orders than the service looks at make no difference."""
    by_robots = {
        size.robots: mean(map(_decision_ms, _at_work(size, 1, seed)[0].asked[-MOMENTS:])) for size in MORE_ROBOTS
    }
    figures = {
        "robots_ms": {str(count): round(took_ms, 2) for count, took_ms in by_robots.items()},
        "robots_of_n_log_n": _of_n_log_n(by_robots),
    }
    say(f"  growth: {figures}")
    return figures


def _of_n_log_n(took_ms: Mapping[int, float]) -> float:
    fewest, most = min(took_ms), max(took_ms)
    return round(took_ms[most] / took_ms[fewest] / (most * log(most) / (fewest * log(fewest))), 4)


def _at_work(size: Size, capacity: int, seed: int) -> tuple[Watched, Seen]:
    watching: list[Watched] = []

    def planning(rng: Random, rounds: int) -> Watched:
        watching.append(Watched(rng, rounds, size.looked_at))
        return watching[0]

    ground, demand = Honeycomb(size.posts, size.robots), Saturated(size.orders)
    fleet = Fleet(size.robots, ground, capacity, NEVER_EMPTY, ROUNDS, NONE, demand, CALM, planning)
    seen = Run(fleet, size.hours, seed).carry_out()
    return watching[0], seen


def _gives(problem: AssignmentProblem, decision: Decision) -> bool:
    had = {stop.order for robot in problem.robots.values() for stop in robot.route}
    return not decision.robot_of().keys() <= had


def _decision_ms(problem: AssignmentProblem) -> float:
    took_ms = []
    for _ in range(REPEATS):
        begun_s = perf_counter()
        decide(problem)
        took_ms.append(1e3 * (perf_counter() - begun_s))
    return median(took_ms)


def _spread(took_s: Sequence[float]) -> dict[str, float]:
    """In milliseconds. Too few for a spread give no figures, which is judged as missed."""
    if len(took_s) < 2:
        return {}
    cuts = quantiles([1e3 * one for one in took_s], n=100, method="inclusive")
    return {name: round(value, 2) for name, value in (("p50", cuts[49]), ("p95", cuts[94]), ("p99", cuts[98]))} | {
        "max": round(1e3 * max(took_s), 2)
    }
