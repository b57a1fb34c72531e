"""The command: one run, and its figures as JSON.

python -m benchmarks.fleet simulate --robots 4 --hours 24 --seed 1
"""

import json
import os
import platform
import subprocess
import sys
from pathlib import Path
from typing import Annotated, Any, Final

import typer

from benchmarks.fleet_simulation.demand import Demand, RushHours, Saturated
from benchmarks.fleet_simulation.faults import MANY, NONE
from benchmarks.fleet_simulation.figures import figures
from benchmarks.fleet_simulation.grounds import Ground
from benchmarks.fleet_simulation.process import simulates_only
from benchmarks.fleet_simulation.service import CALM, ROUNDS, SHIPPED
from benchmarks.fleet_simulation.simulation import Fleet, Run

ROOT: Final = Path(__file__).parents[2]
app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)


@app.command()
def simulate(
    *,
    robots: Annotated[int, typer.Option(min=1)] = 4,
    hours: Annotated[float, typer.Option(min=0.01, help="Simulated.")] = 24.0,
    seed: Annotated[int, typer.Option(help="Of the same seed everything is the same.")] = 1,
    campus: Annotated[str, typer.Option(help="A built-in map.")] = "carleton",
    docks: Annotated[int, typer.Option(min=0, help="In homes; 0: as the map has them.")] = 0,
    waiting: Annotated[int, typer.Option(min=0, help="Orders that always wait; 0: robots and five.")] = 0,
    orders_a_day: Annotated[float, typer.Option(min=0.0, help="In rush hours, instead of those.")] = 0.0,
    capacity: Annotated[int, typer.Option(min=1, help="Items that a robot carries.")] = 2,
    packs_last: Annotated[float, typer.Option(min=0.1, help="So many times as long as usual.")] = 1.0,
    rounds: Annotated[int, typer.Option(min=0, help="Of improvement of each plan.")] = ROUNDS,
    faults: Annotated[bool, typer.Option(help="Kills, cuts, lifts, deaths, closures.")] = False,
    calm: Annotated[bool, typer.Option(help="Look less often at what only time changes: for long runs.")] = False,
) -> None:
    """Run a fleet on the product's own service, in simulated time; print what came of it as JSON."""
    begin_with_like_hashes()
    simulates_only()
    demand: Demand = RushHours(orders_a_day) if orders_a_day else Saturated(waiting or robots + 5)
    ground = Ground(campus, docks)
    fleet = Fleet(
        robots, ground, capacity, packs_last, rounds, MANY if faults else NONE, demand, CALM if calm else SHIPPED
    )
    found = figures(Run(fleet, hours, seed).carry_out(), robots)
    print(json.dumps({**_whereof(calm, rounds, seed), "figures": found}, indent=2))


def _whereof(calm: bool, rounds: int, seed: int) -> dict[str, Any]:
    return {
        "mode": f"schedule, {'calm' if calm else 'as shipped'}, {rounds} rounds for each plan",
        "code": commit(),
        "command": " ".join(["python -m benchmarks.fleet simulate", *sys.argv[2:]]),
        "seed": seed,
        "durations": "moves fitted to stepped robots, people assumed",
        "python": platform.python_version(),
    }


def commit() -> str:
    asked = ["git", "describe", "--always", "--dirty"]
    told = subprocess.run(asked, cwd=ROOT, capture_output=True, text=True, check=False)
    return told.stdout.strip() or "unknown"


def begin_with_like_hashes() -> None:
    """Begin again with strings that hash the same each time: sets of them are gone through in that order."""
    if os.environ.get("PYTHONHASHSEED") != "0":
        os.execve(sys.executable, sys.orig_argv, {**os.environ, "PYTHONHASHSEED": "0"})  # noqa: S606
