"""Throughput as a share of what the same robots would deliver that could pass through each other.

python -m benchmarks.fleet shares --robots 4 --bays 2 --seeds 3
"""

import json
import sys
import tempfile
from pathlib import Path
from typing import Annotated, Any, Final

import typer

from benchmarks.fleet_simulation.command import begin_with_like_hashes, commit
from benchmarks.fleet_simulation.demand import Saturated
from benchmarks.fleet_simulation.grounds import Ground
from benchmarks.fleet_simulation.people import WITH_RECIPIENT
from benchmarks.fleet_simulation.process import simulates_only
from benchmarks.fleet_simulation.service import CALM, ROUNDS
from benchmarks.fleet_simulation.simulation import NEVER_EMPTY, Fleet, Run, homes
from benchmarks.fleet_simulation.unhindered import Unhindered

FREE: Final = 5
"""So many orders always wait beyond those that robots go for."""
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
    """Deliver one letter at a time with always five orders more than robots waiting; beside it what the nearest-order
    rule delivers without conflicts."""
    begin_with_like_hashes()
    simulates_only()
    found = []
    for count in robots or (4, 6, 8):
        for most in bays or (2, 1):
            runs = [_compared(count, most, hours, seed) for seed in range(first_seed, first_seed + seeds)]
            share = sum(run["delivered"] for run in runs) / sum(run["unhindered"] for run in runs)
            found.append({"robots": count, "bays": most, "share": round(share, 3), "runs": runs})
            print(f"{count} robots, {most} bays: {share:.3f}", file=sys.stderr)
    command = " ".join(["python -m benchmarks.fleet shares", *sys.argv[2:]])
    mode = f"schedule, calm, {ROUNDS} rounds for each plan; packs never empty"
    print(json.dumps({"mode": mode, "code": commit(), "command": command, "figures": found}, indent=2))


def _compared(robots: int, bays: int, hours: float, seed: int) -> dict[str, Any]:
    """Orders delivered: by the service's fleet, and without conflicts."""
    ground = Ground(bays=bays)
    demand = Saturated(robots + FREE)
    fleet = Fleet(robots, ground, capacity=1, lasts=NEVER_EMPTY, rounds=ROUNDS, demand=demand, pace=CALM)
    letters = Run(fleet, hours, seed).carry_out().people.letters
    with tempfile.TemporaryDirectory() as folder:
        campus = ground.read(Path(folder))
    return {
        "seed": seed,
        "delivered": sum(place == WITH_RECIPIENT for place in letters.values()),
        "unhindered": Unhindered(campus, FREE, seed).delivered(homes(campus, robots), hours),
    }
