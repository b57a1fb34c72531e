"""Measure the fleet in an event simulation, with the product's own code for traffic.

`simulate` as the first word: one run of the product's whole service (`benchmarks.fleet_simulation`); `shares`: what
fleets of it deliver beside robots that pass through each other; `beside_vroom`: how soon, beside a route optimiser;
`stepped`: one of whole robots, body by body (`benchmarks.stepped_fleet`).
"""

import json
import platform
import sys
import traceback
from importlib import import_module
from typing import Annotated, Any

import typer

from benchmarks.body.report import missed, say, table
from benchmarks.fleet.samples import Samples

# What each shows; the modules are loaded when they are run.
PARTS = {
    "every_map": "exhaustively, on every small map: robots come home from everywhere, and take on more",
    "interleavings": "exhaustively, on small maps: reports that come late, twice or after a restart: no two meet",
    "campus": "days of the whole service with simulated robots, by their messages, and what goes wrong",
    "decisions": "how long the first answer takes and the improvement keeps on; growth with orders and robots",
}

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)


@app.command()
def measure(
    parts: Annotated[list[str] | None, typer.Argument(help=f"Which: {', '.join(PARTS)}. All of them if none.")] = None,
    *,
    seeds: Annotated[int, typer.Option(min=1, help="Of each fleet of campus.")] = 5,
    posts: Annotated[int, typer.Option(min=2, max=5, help="Posts of the largest maps of every_map.")] = 5,
    days: Annotated[float, typer.Option(min=0.5, help="Days of each run of campus.")] = 5.0,
    first_seed: Annotated[int, typer.Option(help="The seeds are this one and the following.")] = 1,
    workers: Annotated[int, typer.Option(min=0, help="Processes at the same time; 0: one for each core.")] = 0,
    as_json: Annotated[bool, typer.Option("--json", help="JSON alone, without the table.")] = False,
) -> None:
    """Print what was measured, as JSON, beside what is wanted.

    JSON goes to the output, progress and a table for people to the error stream. Ends with 1 if anything wanted was
    missed or a part failed.
    """
    unknown = [name for name in parts or () if name not in PARTS]
    if unknown:
        raise typer.BadParameter(f"no part is called {', '.join(unknown)}; there are {', '.join(PARTS)}")
    samples = Samples(seeds, posts, days, first_seed)
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
    "beside_vroom": "benchmarks.fleet_simulation.beside_vroom",
    "stepped": "benchmarks.stepped_fleet.command",
}

if __name__ == "__main__":
    if (run := sys.argv[1:2]) and run[0] in RUNS:
        import_module(RUNS[run[0]]).app(sys.argv[2:], prog_name=f"python -m benchmarks.fleet {run[0]}")
    else:
        app(prog_name="python -m benchmarks.fleet")
