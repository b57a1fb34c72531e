"""The whole campus: the product's own service and robots' duties, by their messages, for days, with what goes wrong.

    python -m benchmarks.fleet campus

`benchmarks.fleet_simulation` says how; `python -m benchmarks.fleet simulate` is one such run, with options.
"""

from collections import Counter
from collections.abc import Sequence
from typing import Any, Final

from benchmarks.body.report import Wanted, say
from benchmarks.fleet.samples import Samples
from benchmarks.fleet_simulation.demand import RushHours
from benchmarks.fleet_simulation.faults import MANY
from benchmarks.fleet_simulation.figures import figures
from benchmarks.fleet_simulation.grounds import Ground
from benchmarks.fleet_simulation.judge import BAY, CORRIDOR, CROSSING
from benchmarks.fleet_simulation.process import simulates_only
from benchmarks.fleet_simulation.service import CALM
from benchmarks.fleet_simulation.simulation import Fleet, Run

GROUND: Final = Ground()
FLEETS: Final = {
    "four_robots": Fleet(4, GROUND, 1, faults=MANY, demand=RushHours(6.0), pace=CALM),
    "two_items_each": Fleet(4, GROUND, 2, faults=MANY, demand=RushHours(6.0), pace=CALM),
    "long_lasting_packs": Fleet(4, GROUND, 1, lasts=4.0, faults=MANY, demand=RushHours(20.0), pace=CALM),
}
MEETINGS: Final = BAY, CROSSING, CORRIDOR
WANTED: Final = [
    Wanted(f"{name}.{figure}", at_most=0)
    for name in FLEETS
    for figure in (*(f"met.{place}" for place in MEETINGS), "stuck", "astray", "too_old", "stranded")
]
ADDED: Final = ("robot_hours", "orders", "delivered", "arrivals", "stuck", "too_old", "stranded", "driven_km")


def measure(samples: Samples) -> dict[str, Any]:
    jobs = [(name, seed, 24.0 * samples.days) for name in FLEETS for seed in samples.some_seeds()]
    seen: dict[str, list[dict[str, Any]]] = {name: [] for name in FLEETS}
    for (name, seed, _), of_run in zip(jobs, samples.each(look_at, jobs), strict=True):
        say(f"  {name}, seed {seed}: {of_run['delivered']} of {of_run['orders']} orders, met {of_run['met']}")
        seen[name].append(of_run)
    return {name: together(runs) for name, runs in seen.items()}


def look_at(job: tuple[str, int, float]) -> dict[str, Any]:
    """One run of one fleet."""
    name, seed, hours = job
    simulates_only()
    fleet = FLEETS[name]
    return figures(Run(fleet, hours, seed).carry_out(), fleet.robots)


def together(runs: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """The figures of several runs as one."""
    met, befallen = (sum((Counter(run[which]) for run in runs), Counter[str]()) for which in ("met", "befallen"))
    return {
        **{name: round(sum(run[name] for run in runs), 2) for name in ADDED},
        "met": {**dict.fromkeys(MEETINGS, 0), **met},
        "meetings": [one for run in runs for one in run["meetings"]][:20],
        "astray": sum(len(run["astray"]) for run in runs),
        "astray_orders": [one for run in runs for one in run["astray"]],
        "befallen": dict(befallen),
        "each": [{name: run[name] for name in ("order_to_delivered_s", "estimates")} for run in runs],
        "processor_s": round(sum(run["processor_s"] for run in runs), 1),
    }
