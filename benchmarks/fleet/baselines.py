"""Other ways to run the same fleet in the tunnels: other assignments under the same traffic rules, and plain locks.

Each rule gets the same orders twice: always five waiting (how much is delivered), and placed at random in days with
rush hours (how long an order takes from being placed until it is delivered).
"""

from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec
from itertools import product
from random import Random
from statistics import mean
from typing import Any, Final, Protocol

from benchmarks.body.report import Wanted, say
from benchmarks.fleet import plots, without_conflicts
from benchmarks.fleet.assigning import Assigning, Rule
from benchmarks.fleet.demand import Demand, RushHours, Saturated
from benchmarks.fleet.grounds import tunnels
from benchmarks.fleet.locks import Locks
from benchmarks.fleet.planned import Planning, so_many
from benchmarks.fleet.samples import Samples
from benchmarks.fleet.world import DeadlockError, World
from benchmarks.service.figures import percentile

ROBOTS: Final = 4
BAYS: Final = 2
SPREAD: Final = 0.2
RUSH_SEEDS: Final = 4
"""So many seeds with rush hours for each one of the others: with five the p95 of a rule lies 10 % apart by chance."""
CONFIDENT: Final = 0.95
DRAWS: Final = 1000
ORDERS_A_DAY: Final = 60.0
"""In the rush hours as many as four robots can just carry."""
ROUNDS: Final = 10
OURS: Final = "planner"
NOT_RUN: Final = "not run: pip install -c constraints.txt pyvroom"


class Looks(Protocol):
    def look(self, world: World) -> float: ...


RULES: Final[dict[str, Callable[[Demand, int], Looks]]] = {
    OURS: lambda demand, seed: Planning(demand, Random(seed), so_many(100)),
    "quickest": lambda demand, seed: Assigning(Rule("quickest", 5, ROUNDS), demand, Random(seed)),
    "vroom": lambda demand, seed: Assigning(Rule("optimiser", 1, ROUNDS), demand, Random(seed)),
    "vroom_of_all": lambda demand, seed: Assigning(Rule("optimiser of all", 1, ROUNDS), demand, Random(seed)),
    "nearest_robot": lambda demand, seed: Assigning(Rule("nearest robot", 1, ROUNDS), demand, Random(seed)),
    "first_come": lambda demand, seed: Assigning(Rule("first come", 1, ROUNDS), demand, Random(seed)),
}
WANTED = [
    Wanted(f"ours_of_{name}.{figure}", **bound)
    for name in ("vroom", "vroom_of_all", "nearest_robot", "first_come")
    for figure, bound in (("delivered", {"at_least": 1.0}), ("p95", {"at_most": 1.0}))
]


@dataclass(frozen=True, slots=True)
class Job:
    rule: str
    seed: int
    hours: float
    rush: bool


def measure(samples: Samples) -> dict[str, Any]:
    rules = [name for name in RULES if not name.startswith("vroom") or find_spec("vroom")]
    jobs = [Job(rule, seed, samples.hours, False) for rule, seed in product(rules, samples.some_seeds())]
    rush_seeds = range(samples.first_seed, samples.first_seed + RUSH_SEEDS * samples.seeds)
    jobs += [Job(rule, seed, samples.days * 24, True) for rule, seed in product(rules, rush_seeds)]
    done = dict(zip(jobs, samples.each(run, jobs), strict=True))
    figures: dict[str, Any] = {rule: _figures(rule, done) for rule in rules}
    figures |= {f"ours_of_{rule}": _shares(figures[OURS], figures[rule]) for rule in rules if rule != OURS}
    for rule in rules:
        if rule != OURS:
            figures[f"ours_of_{rule}"]["p95_between"] = _p95_between(_by_seed(OURS, done), _by_seed(rule, done))
    plots.baselines(samples.plots, figures, rules)
    if "vroom" not in rules:
        figures |= {"vroom": NOT_RUN, "vroom_of_all": NOT_RUN}
    return {**figures, "locks": _locks(samples)}


def run(job: Job) -> list[float]:
    """Return the time of each order from being placed: until it was delivered, or so far. Saturated: of those
    delivered."""
    ground, until_s = tunnels(BAYS), job.hours * 3600
    posts = len(ground.network.posts)
    demand: Demand = RushHours(posts, job.seed, ORDERS_A_DAY) if job.rush else Saturated(posts, job.seed)
    world = World(ground.network, ground.homes(ROBOTS), Random(job.seed), SPREAD)
    world.run(until_s, RULES[job.rule](demand, job.seed).look)
    done_s = {int(key.split()[0]): at_s for key, at_s in world.served_s.items() if not key.endswith("load")}
    if not job.rush:
        return [at_s for at_s in done_s.values() if at_s <= until_s]
    placed = RushHours(posts, job.seed, ORDERS_A_DAY)
    placed.pass_time(until_s)
    return [min(done_s.get(order.number, until_s), until_s) - order.placed_s for order in placed.waiting]


def _figures(rule: str, done: dict[Job, list[float]]) -> dict[str, Any]:
    delivered = [len(served) for job, served in done.items() if job.rule == rule and not job.rush]
    ages_s = [age_s for job, ages_s in done.items() if job.rule == rule and job.rush for age_s in ages_s]
    figures = {
        "delivered": round(mean(delivered), 1),
        "mean_min": round(mean(ages_s) / 60, 1),
        "p95_min": round(percentile(ages_s, 0.95) / 60, 1),
        "orders": len(ages_s),
    }
    say(f"  {rule}: {figures}")
    return figures


def _shares(ours: dict[str, Any], theirs: dict[str, Any]) -> dict[str, float]:
    """More delivered is better, a longer time is worse."""
    names = {"delivered": "delivered", "mean": "mean_min", "p95": "p95_min"}
    return {name: round(ours[key] / theirs[key], 4) for name, key in names.items()}


def _by_seed(rule: str, done: dict[Job, list[float]]) -> dict[int, list[float]]:
    return {job.seed: ages_s for job, ages_s in done.items() if job.rule == rule and job.rush}


def _p95_between(ours: dict[int, list[float]], theirs: dict[int, list[float]]) -> list[float]:
    """Where the ratio of the two p95 lies with the confidence `CONFIDENT`: of seeds drawn again and again, the same for
    both (a paired bootstrap)."""
    rng, seeds = Random(0), list(ours)
    drawn = [rng.choices(seeds, k=len(seeds)) for _ in range(DRAWS)]
    ratios = sorted(_p95(ours, some) / _p95(theirs, some) for some in drawn)
    outside = round(DRAWS * (1 - CONFIDENT) / 2)
    return [round(ratios[outside], 3), round(ratios[-1 - outside], 3)]


def _p95(ages_s: dict[int, list[float]], seeds: list[int]) -> float:
    return percentile([age_s for seed in seeds for age_s in ages_s[seed]], 0.95)


def _locks(samples: Samples) -> dict[str, Any]:
    """Of what is delivered first come first served without conflicts; deadlocks end a run."""
    figures: dict[str, Any] = {}
    for robots in (4, 6, 8):
        whole = [_of_first_come(robots, seed, samples.hours) for seed in samples.some_seeds()]
        stuck = sum(_deadlocks(robots, seed, samples.hours) for seed in samples.some_seeds())
        figures[f"{robots}_robots"] = {"whole_way_of_first_come": round(mean(whole), 4), "naive_deadlocks": stuck}
        figures[f"{robots}_robots"]["runs"] = samples.seeds
    return figures


def _of_first_come(robots: int, seed: int, hours: float) -> float:
    locks = Locks(tunnels(BAYS), robots, seed, whole_way=True)
    locks.run(hours * 3600)
    return locks.delivered / without_conflicts.delivered(tunnels(BAYS), robots, seed, hours, nearest=False)


def _deadlocks(robots: int, seed: int, hours: float) -> bool:
    try:
        Locks(tunnels(BAYS), robots, seed, whole_way=False).run(hours * 3600)
    except DeadlockError:
        return True
    return False
