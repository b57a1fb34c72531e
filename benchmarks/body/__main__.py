"""Measure the body in the simulated world."""

import json
import os
import platform
import traceback
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any

import typer

from benchmarks.body.report import PLOTS, Part, Samples, log_to_error_stream, missed, part_report, say, table

# What each shows; the modules are loaded when they are run.
PARTS = {
    "line": "the follower on taped lines: lost samples, tracks driven, wheel speeds",
    "vision": "markers decoded on generated frames, and how long it takes",
    "pictures": "codes that people show, at five sizes of picture, beside plain zxing-cpp",
    "stops": "from the first frame that shows a fault to the stop bytes on the wire",
    "missions": "seeded missions with faults: delivered or handed to a person, none lost, none claimed falsely",
    "kills": "SIGKILL of the daemon at random moments of missions: what the restarted one knows",
    "near_posts": "kills in the last 600 mm before a post: where the restarted robot drives",
    "any_moment": "kills at any moment of a letter: where the restarted robot believes to be",
    "foreign_codes": "plain codes of posts that a stranger shows at random places: none believed",
    "hour": "a simulated hour: time on the wall, processor, memory and lag of the loops",
    "watched": "what it costs the mind to be watched, and not to be watched",
}

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)


@app.command()
def measure(
    parts: Annotated[list[str] | None, typer.Argument(help=f"Which: {', '.join(PARTS)}. All of them if none.")] = None,
    *,
    seeds: Annotated[int, typer.Option(min=1, help="Seeds of each track, frames of each condition.")] = 20,
    missions: Annotated[int, typer.Option(min=1, help="Missions on each map.")] = 150,
    kills: Annotated[int, typer.Option(min=1, help="How often the daemon is killed.")] = 200,
    hour_s: Annotated[float, typer.Option(min=60, help="How much of the simulated hour is run.")] = 3600.0,
    first_seed: Annotated[int, typer.Option(help="The seeds are this one and the following.")] = 1,
    as_json: Annotated[bool, typer.Option("--json", help="JSON alone, without the table.")] = False,
    plots: Annotated[Path, typer.Option(help="Where plots are written.", show_default=False)] = PLOTS,
) -> None:
    """Print what was measured, as JSON, beside what is wanted.

    JSON goes to the output, progress and a table for people to the error stream. Ends with 1 if anything wanted was
    missed or a part failed.
    """
    unknown = [name for name in parts or () if name not in PARTS]
    if unknown:
        raise typer.BadParameter(f"no part is called {', '.join(unknown)}; there are {', '.join(PARTS)}")
    log_to_error_stream()
    plots.mkdir(parents=True, exist_ok=True)
    samples = Samples(seeds, missions, kills, hour_s, first_seed, plots)
    reports = {name: _report(name, samples) for name in PARTS if not parts or name in parts}
    if not as_json:
        say("\n" + table(reports))
    print(json.dumps({"machine": _machine(), "first_seed": first_seed, "parts": reports}, indent=2))
    raise typer.Exit(bool(missed(reports)))


def _report(name: str, samples: Samples) -> dict[str, Any]:
    """A part that fails is told as failed, and the others are measured all the same."""
    say(f"{name}: {PARTS[name]}")
    try:
        part: Part = import_module(f"benchmarks.body.{name}")
        return part_report(part, samples)
    except Exception as error:
        say(traceback.format_exc())
        return {"figures": {}, "wanted": [], "failed": f"{type(error).__name__}: {error}"}


def _machine() -> dict[str, Any]:
    return {"python": platform.python_version(), "system": platform.platform(), "cores": os.cpu_count()}


if __name__ == "__main__":
    app(prog_name="python -m benchmarks.body")
