"""Measure the service from outside, on one core of its own."""

import gc
import json
import os
import platform
import subprocess
import traceback
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any

import typer

from benchmarks.body.report import log_to_error_stream, missed, say, table
from benchmarks.fleet_simulation.honeycomb import MOST_ROBOTS
from benchmarks.service import yardsticks
from benchmarks.service.pinned import pin
from benchmarks.service.samples import Samples
from benchmarks.service.servers import CHECKOUT, LOAD_CORE, SERVER_CORE

# What each shows; the modules are loaded when they are run.
PARTS = {
    "orders": "order creation beside a bare endpoint with one durable insert",
    "instructions": "from the order to the mission at the robot, one order a second",
    "robots": "a fleet that reports once a second: until it is acknowledged durably",
    "followers": "open pages: until everybody sees a change",
    "history": "a page of my mail with a long history and with a short one",
    "resume": "a robot back after half an hour: page right, backlog in",
}

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)


@app.command()
def measure(
    parts: Annotated[list[str] | None, typer.Argument(help=f"Which: {', '.join(PARTS)}. All of them if none.")] = None,
    *,
    seconds: Annotated[float, typer.Option(min=0.5, help="How long each part keeps up its load.")] = 20.0,
    rounds: Annotated[int, typer.Option(min=1, help="Turns beside the bare endpoint; fleets of instructions.")] = 5,
    robots: Annotated[int, typer.Option(min=2, max=MOST_ROBOTS, help="Robots of the fleet.")] = 100,
    followers: Annotated[int, typer.Option(min=1, help="Open pages.")] = 500,
    history: Annotated[int, typer.Option(min=100, help="Orders of the long history.")] = 100_000,
    backlog: Annotated[int, typer.Option(min=1, help="Messages that wait in the robot.")] = 2000,
    first_seed: Annotated[int, typer.Option(help="What is random derives from it.")] = 1,
    data: Annotated[Path | None, typer.Option(help="Folder for databases, on the disk to measure.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="JSON alone, without the table.")] = False,
) -> None:
    """Print what was measured, as JSON, beside what is wanted.

    The service has one core, the load generator another. JSON goes to the output, progress and a table for people to
    the error stream. Ends with 1 if anything wanted was missed or a part failed.
    """
    unknown = [name for name in parts or () if name not in PARTS]
    if unknown:
        raise typer.BadParameter(f"no part is called {', '.join(unknown)}; there are {', '.join(PARTS)}")
    log_to_error_stream()
    machine = _machine()
    # A load generator that looks for garbage among hundreds of robots stands still for 0.2 s, and would call that the
    # service's: some seconds of garbage fit into memory.
    gc.disable()
    if not pin(LOAD_CORE):
        say(f"there is no core {LOAD_CORE} for the load generator: it shares one with the service")
    samples = Samples(seconds, rounds, robots, followers, history, backlog, first_seed, data)
    taken, reports = [yardsticks.measure(samples)], dict[str, Any]()
    for name in parts or PARTS:
        reports[name] = _report(name, samples)
        taken.append(yardsticks.measure(samples))
    middle = yardsticks.middle(taken)
    found = {"yardsticks": {**middle, "taken": taken}, "ratios": yardsticks.ratios(reports, middle)}
    if not as_json:
        say("\n" + table(reports))
    said = {"commit": commit(), "machine": machine, "first_seed": first_seed, **found, "parts": reports}
    print(json.dumps(said, indent=2))
    raise typer.Exit(bool(missed(reports)))


def _report(name: str, samples: Samples) -> dict[str, Any]:
    """A part that fails is told as failed, and the others are measured all the same."""
    say(f"{name}: {PARTS[name]}")
    try:
        part = import_module(f"benchmarks.service.{name}")
        figures = part.measure(samples)
        return {"figures": figures, "wanted": [wanted.judged(figures) for wanted in part.WANTED]}
    except Exception as error:
        say(traceback.format_exc())
        return {"figures": {}, "wanted": [], "failed": f"{type(error).__name__}: {error}"}


def commit() -> str:
    """The one that is measured, with a plus where files differ from it; empty where there is no git."""
    with suppress(OSError, subprocess.CalledProcessError):
        command = ["git", "describe", "--always", "--abbrev=10", "--dirty=+"]
        return subprocess.run(command, cwd=CHECKOUT, check=True, capture_output=True, text=True).stdout.strip()
    return ""


def _machine() -> dict[str, Any]:
    cores = {"cores": os.cpu_count(), "service_on_core": SERVER_CORE, "load_generator_on_core": LOAD_CORE}
    return {"python": platform.python_version(), "system": platform.platform(), **cores}


if __name__ == "__main__":
    app(prog_name="python -m benchmarks.service")
