"""The command: one run of whole robots in one world, and what their bodies did, as JSON.

python -m benchmarks.fleet stepped --robots 4 --minutes 30 --seed 1
"""

import json
import sys
from typing import Annotated

import typer

from benchmarks.fleet_simulation.command import begin_with_like_hashes, commit
from benchmarks.fleet_simulation.process import simulates_only
from benchmarks.stepped_fleet.run import Fleet, Run

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)


@app.command()
def stepped(
    *,
    robots: Annotated[int, typer.Option(min=1, help="As many as the map has bays that are homes, at most.")] = 4,
    minutes: Annotated[float, typer.Option(min=0.1, help="Simulated.")] = 30.0,
    seed: Annotated[int, typer.Option(help="Of the same seed everything is the same.")] = 1,
    campus: Annotated[str, typer.Option(help="A map with bays: a built-in one, or a file.")] = "carleton",
    waiting: Annotated[int, typer.Option(min=0, help="Orders that always wait; 0: robots and two.")] = 0,
    scale: Annotated[float, typer.Option(min=0.01, help="Of its corridors.")] = 0.1,
    kill_every_s: Annotated[float, typer.Option(min=0.0, help="Each robot, on an average; 0: never.")] = 0.0,
    cut_every_s: Annotated[float, typer.Option(min=0.0, help="Its network, the same.")] = 0.0,
    turns_killed: Annotated[float, typer.Option(min=0.0, max=1.0, help="Share of the turns on a crossing.")] = 0.0,
) -> None:
    """Run whole robots with the whole service; ends with 1 if bodies touched or a corridor was entered ungranted."""
    begin_with_like_hashes()
    simulates_only()
    fleet = Fleet(campus, robots, scale, waiting or robots + 2, kill_every_s, cut_every_s, turns_killed)
    figures = Run(fleet, minutes, seed).carry_out()
    command = " ".join(["python -m benchmarks.fleet stepped", *sys.argv[2:]])
    print(json.dumps({"mode": "stepped", "code": commit(), "command": command, "figures": figures}, indent=2))
    raise typer.Exit(bool(figures["touches"] or figures["ungranted"] or figures["astray"]))
