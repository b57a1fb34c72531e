"""Measure the fleet in an event simulation, with the product's own code for traffic.

`simulate` as the first word: one run of the product's whole service (`benchmarks.fleet_simulation`); `shares`: what
fleets of it deliver beside robots that are alone; `stepped`: one of whole robots, body by body
(`benchmarks.stepped_fleet`).
"""

import json
import platform
import sys
import traceback
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any

import typer

from benchmarks.body.report import missed, say, table
from benchmarks.fleet.samples import PLOTS, Samples

# What each shows; the modules are loaded when they are run.
PARTS = {
    "every_map": "exhaustively, on every small map: robots come home from everywhere, and take on more",
    "interleavings": "exhaustively, on small maps: reports that come late, twice or after a restart: no two meet",
    "throughput": "tunnels, saturated demand: what is delivered, beside the same demand without conflicts",
    "never_stuck": "five kinds of map, late and dead robots, closed corridors: no deadlock, and nothing waits for ever",
    "baselines": "other ways to assign orders and to lock corridors, with the same orders",
    "estimates": "arrivals that people are told, with rush hours, failures and charging: how many come inside",
    "charging": "worn packs, and fewer docks than robots: no robot strands, hardly an order waits for a charge",
    "campus": "days of the whole service with simulated robots, by their messages, and what goes wrong",
    "decisions": "how long a decision takes with 20 robots and 200 orders, at first and improved; growth with orders",
}

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)


@app.command()
def measure(
    parts: Annotated[list[str] | None, typer.Argument(help=f"Which: {', '.join(PARTS)}. All of them if none.")] = None,
    *,
    hours: Annotated[float, typer.Option(min=1, help="Hours of each run of throughput.")] = 120.0,
    seeds: Annotated[int, typer.Option(min=1, help="Paired seeds of throughput and baselines.")] = 5,
    robot_hours: Annotated[float, typer.Option(min=10, help="Hours of robots in never_stuck.")] = 100_000.0,
    posts: Annotated[int, typer.Option(min=2, max=5, help="Posts of the largest maps of every_map.")] = 5,
    days: Annotated[float, typer.Option(min=0.5, help="Days of each run of baselines.")] = 5.0,
    first_seed: Annotated[int, typer.Option(help="The seeds are this one and the following.")] = 1,
    workers: Annotated[int, typer.Option(min=0, help="Processes at the same time; 0: one for each core.")] = 0,
    plots: Annotated[Path, typer.Option(help="Where the plots are written.", show_default=False)] = PLOTS,
    as_json: Annotated[bool, typer.Option("--json", help="JSON alone, without the table.")] = False,
) -> None:
    """Print what was measured, as JSON, beside what is wanted.

    JSON goes to the output, progress and a table for people to the error stream. Ends with 1 if anything wanted was
    missed or a part failed.
    """
    unknown = [name for name in parts or () if name not in PARTS]
    if unknown:
        raise typer.BadParameter(f"no part is called {', '.join(unknown)}; there are {', '.join(PARTS)}")
    samples = Samples(hours, seeds, robot_hours, posts, days, first_seed, plots=plots)
    samples = samples.with_workers(workers) if workers else samples
    reports = {name: _report(name, samples) for name in PARTS if not parts or name in parts}
    if not as_json:
        say("\n" + table(reports))
    machine = {"python": platform.python_version(), "system": platform.platform(), "workers": samples.workers}
    print(json.dumps({"machine": machine, "first_seed": first_seed, "parts": reports}, indent=2))
    raise typer.Exit(bool(missed(reports)))


def _report(name: str, samples: Samples) -> dict[str, Any]:
    """A part that fails is told as failed, and the others are measured all the same."""
    say(f"{name}: {PARTS[name]}")
    try:
        part = import_module(f"benchmarks.fleet.{name}")
        figures = part.measure(samples)
        return {"figures": figures, "wanted": [wanted.judged(figures) for wanted in part.WANTED]}
    except Exception as error:
        say(traceback.format_exc())
        return {"figures": {}, "wanted": [], "failed": f"{type(error).__name__}: {error}"}


RUNS = {
    "simulate": "benchmarks.fleet_simulation.command",
    "shares": "benchmarks.fleet_simulation.shares",
    "stepped": "benchmarks.stepped_fleet.command",
}

if __name__ == "__main__":
    if (run := sys.argv[1:2]) and run[0] in RUNS:
        import_module(RUNS[run[0]]).app(sys.argv[2:], prog_name=f"python -m benchmarks.fleet {run[0]}")
    else:
        app(prog_name="python -m benchmarks.fleet")
