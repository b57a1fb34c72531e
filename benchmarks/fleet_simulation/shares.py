"""Throughput as a share of what the same robots would deliver each alone on the campus: the price of single lines.

python -m benchmarks.fleet shares --robots 4 --bays 2 --seeds 3
"""

import json
import sys
from dataclasses import replace
from typing import Annotated, Any, Final

import typer

from benchmarks.fleet_simulation.command import begin_with_like_hashes, commit
from benchmarks.fleet_simulation.demand import Saturated
from benchmarks.fleet_simulation.grounds import Ground
from benchmarks.fleet_simulation.people import WITH_RECIPIENT
from benchmarks.fleet_simulation.process import simulates_only
from benchmarks.fleet_simulation.service import CALM
from benchmarks.fleet_simulation.simulation import Fleet, Run

LASTS: Final = 1000.0
"""Times as long as usual: what charging costs is another question."""
app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)


@app.command()
def shares(
    *,
    robots: Annotated[list[int] | None, typer.Option(min=1, help="Of one fleet; 4, 6 and 8 if none.")] = None,
    bays: Annotated[list[int] | None, typer.Option(min=1, help="For passing, at each post; 2 and 1 if none.")] = None,
    hours: Annotated[float, typer.Option(min=0.1, help="Simulated, of each run.")] = 12.0,
    seeds: Annotated[int, typer.Option(min=1, help="Of each fleet.")] = 2,
    first_seed: Annotated[int, typer.Option(help="The seeds are this one and the following.")] = 1,
) -> None:
    """Deliver with as many orders always waiting as there are robots, and five; all together, and one robot alone."""
    begin_with_like_hashes()
    simulates_only()
    found = []
    for count in robots or (4, 6, 8):
        for most in bays or (2, 1):
            runs = [_compared(count, most, hours, seed) for seed in range(first_seed, first_seed + seeds)]
            together, alone = (sum(run[what] for run in runs) for what in ("together", "alone"))
            found.append({"robots": count, "bays": most, "share": round(together / (count * alone), 3), "runs": runs})
            print(f"{count} robots, {most} bays: {together / (count * alone):.3f}", file=sys.stderr)
    command = " ".join(["python -m benchmarks.fleet shares", *sys.argv[2:]])
    whereof = {"mode": "schedule, calm; packs never empty", "code": commit(), "command": command}
    print(json.dumps({**whereof, "figures": found}, indent=2))


def _compared(robots: int, bays: int, hours: float, seed: int) -> dict[str, Any]:
    """Letters an hour."""
    fleet = Fleet(robots, Ground(bays=bays), lasts=LASTS, demand=Saturated(robots + 5), pace=CALM)
    return {
        "seed": seed,
        "together": _delivered_an_hour(fleet, hours, seed),
        "alone": _delivered_an_hour(replace(fleet, robots=1), hours, seed),
    }


def _delivered_an_hour(fleet: Fleet, hours: float, seed: int) -> float:
    letters = Run(fleet, hours, seed).carry_out().people.letters
    return round(sum(place == WITH_RECIPIENT for place in letters.values()) / hours, 3)
