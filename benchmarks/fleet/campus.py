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
from benchmarks.fleet_simulation.honeycomb import Honeycomb
from benchmarks.fleet_simulation.judge import BAY, CORRIDOR, CROSSING
from benchmarks.fleet_simulation.process import simulates_only
from benchmarks.fleet_simulation.service import CALM
from benchmarks.fleet_simulation.simulation import Fleet, Run

TUNNELS, TRACK, HONEYCOMB = Ground(), Ground("test_track"), Honeycomb(20, 6)
FLEETS: Final = {
    "four_robots": Fleet(4, TUNNELS, 1, faults=MANY, demand=RushHours(6.0), pace=CALM),
    "two_items_each": Fleet(4, TUNNELS, 2, faults=MANY, demand=RushHours(6.0), pace=CALM),
    "long_lasting_packs": Fleet(4, TUNNELS, 1, lasts=4.0, faults=MANY, demand=RushHours(20.0), pace=CALM),
    "eight_robots": Fleet(8, TUNNELS, 2, lasts=4.0, faults=MANY, demand=RushHours(40.0), pace=CALM),
    "three_on_the_track": Fleet(3, TRACK, 1, lasts=4.0, faults=MANY, demand=RushHours(100.0), pace=CALM),
    "six_in_a_honeycomb": Fleet(6, HONEYCOMB, 2, lasts=4.0, faults=MANY, demand=RushHours(100.0), pace=CALM),
}
MEETINGS: Final = BAY, CROSSING, CORRIDOR
TOLD: Final = "placed", "under_way"
WANTED: Final = [
    *(
        Wanted(f"{name}.{figure}", at_most=0)
        for name in FLEETS
        for figure in (*(f"met.{place}" for place in MEETINGS), "stuck", "astray", "too_old", "stranded")
    ),
    *(
        wanted
        for name in FLEETS
        for told in TOLD
        for wanted in (
            Wanted(f"{name}.estimates.{told}.inside", at_least=0.78, at_most=0.82),
            Wanted(f"{name}.estimates.{told}.median_error", at_most=0.15),
        )
    ),
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
        "estimates": {told: _told([run["estimates"][told] for run in runs]) for told in TOLD},
        "order_to_delivered_s": [run["order_to_delivered_s"] for run in runs],
        "processor_s": round(sum(run["processor_s"] for run in runs), 1),
    }


def _told(scores: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Arrivals of all runs, each run with its weight."""
    scored = [one for one in scores if one["scored"]]
    count = sum(one["scored"] for one in scored)
    means = {
        name: round(sum(one["scored"] * one[name] for one in scored) / count, 3) if count else None
        for name in ("inside", "median_error")
    }
    return {"scored": count, **means}
