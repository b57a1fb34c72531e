"""The planner beside VROOM re-solved for all robots: the same orders, in days with rush hours, on the shipped service.

python -m benchmarks.fleet beside_vroom --seeds 20 --days 1
"""

import json
import sys
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from itertools import product
from random import Random
from statistics import mean
from typing import Annotated, Any, Final

import typer

from app.dispatch.planner_process import PlannerProcess
from benchmarks.fleet_simulation.command import begin_with_like_hashes, commit
from benchmarks.fleet_simulation.demand import RushHours
from benchmarks.fleet_simulation.process import simulates_only
from benchmarks.fleet_simulation.service import CALM, ROUNDS, PlansInRounds
from benchmarks.fleet_simulation.simulation import NEVER_EMPTY, Fleet, Run
from benchmarks.service.figures import percentile

ROBOTS: Final = 4
ORDERS_A_DAY: Final = 40.0
"""In the rush hours as many as four robots can just carry."""
CONFIDENT: Final = 0.95
DRAWS: Final = 1000
Ages = Mapping[int, list[float]]
"""Seconds from being placed until delivered, or so far, of each order; by seed."""
app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)


@app.command()
def beside_vroom(
    *,
    seeds: Annotated[int, typer.Option(min=1, help="Paired runs.")] = 20,
    first_seed: Annotated[int, typer.Option(help="The seeds are this one and the following.")] = 1,
    days: Annotated[float, typer.Option(min=0.5, help="Of each run, from a Monday on.")] = 1.0,
    workers: Annotated[int, typer.Option(min=1, help="Processes at the same time.")] = 2,
) -> None:
    """Print the mean and the 95th percentile of the time of an order for both, and the ratios with their spread."""
    begin_with_like_hashes()
    jobs = list(product(("planner", "vroom"), range(first_seed, first_seed + seeds), [days]))
    ages: dict[str, dict[int, list[float]]] = {"planner": {}, "vroom": {}}
    with ProcessPoolExecutor(workers) as processes:
        for (rule, seed, _), of_run in zip(jobs, processes.map(_run, jobs), strict=True):
            ages[rule][seed] = of_run
            print(f"{rule}, seed {seed}: {len(of_run)} orders, mean {mean(of_run) / 60:.1f} min", file=sys.stderr)
    command = " ".join(["python -m benchmarks.fleet beside_vroom", *sys.argv[2:]])
    mode = f"schedule, calm, {ROUNDS} rounds for each plan; one letter at a time; packs never empty"
    found = compared(ages["planner"], ages["vroom"])
    print(json.dumps({"mode": mode, "code": commit(), "command": command, "figures": found}, indent=2))


def compared(ours: Ages, theirs: Ages) -> dict[str, Any]:
    """Figures of both, and of ours as a share of theirs. `between`: where a share lies with a confidence of 95 %, of
    seeds drawn again and again, the same for both (a paired bootstrap)."""
    found: dict[str, Any] = {name: _figures(ages) for name, ages in (("planner", ours), ("vroom", theirs))}
    rng, every = Random(0), list(ours)
    drawn = [rng.choices(every, k=len(every)) for _ in range(DRAWS)]
    for name, measure in (("mean", mean), ("p95", _p95)):
        shares = sorted(_share(measure, ours, theirs, seeds) for seeds in drawn)
        outside = round(DRAWS * (1 - CONFIDENT) / 2)
        share = _share(measure, ours, theirs, every)
        found[name] = {"share": round(share, 3), "between": [round(shares[at], 3) for at in (outside, -1 - outside)]}
    return found


def _run(job: tuple[str, int, float]) -> list[float]:
    rule, seed, days = job
    simulates_only()
    fleet = Fleet(
        ROBOTS,
        capacity=1,
        lasts=NEVER_EMPTY,
        rounds=ROUNDS,
        demand=RushHours(ORDERS_A_DAY),
        pace=CALM,
        planning=_planning(rule),
    )
    people, end_s = Run(fleet, 24.0 * days, seed).carry_out().people, 86400.0 * days
    return [
        min(people.ended_s.get(order, end_s), end_s) - placed_s
        for order, placed_s in people.placed_s.items()
        if placed_s < end_s
    ]


def _planning(rule: str) -> Callable[[Random, int], PlannerProcess]:
    if rule == "planner":
        return PlansInRounds
    from benchmarks.fleet_simulation.vroom_contender import VroomOfAll  # not installed everywhere

    return VroomOfAll


def _figures(ages: Ages) -> dict[str, float]:
    every = _together(ages, list(ages))
    return {
        "orders": len(every),
        "mean_min": round(mean(every) / 60, 1),
        "p95_min": round(_p95(every) / 60, 1),
        "longest_min": round(max(every) / 60, 1),
    }


def _share(measure: Callable[[Sequence[float]], float], ours: Ages, theirs: Ages, seeds: Sequence[int]) -> float:
    return measure(_together(ours, seeds)) / measure(_together(theirs, seeds))


def _together(ages: Ages, seeds: Sequence[int]) -> list[float]:
    return [age_s for seed in seeds for age_s in ages[seed]]


def _p95(ages_s: Sequence[float]) -> float:
    return percentile(ages_s, 0.95)
