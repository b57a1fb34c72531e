"""The command: one run of whole robots in one world, and what their bodies did, as JSON.

python -m benchmarks.fleet stepped --robots 4 --minutes 30 --seed 1
"""

import json
import sys
from typing import Annotated

import typer

from benchmarks.fleet_simulation.command import begin_with_like_hashes, commit
from benchmarks.fleet_simulation.process import simulates_only
from benchmarks.fleet_simulation.service import CALM, SHIPPED
from benchmarks.stepped_fleet.fates import Rates
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
    kill_s: Annotated[float, typer.Option(min=0.0, help="Between two kills of a robot's daemon; 0: none.")] = 0.0,
    cut_s: Annotated[float, typer.Option(min=0.0, help="Between two cuts of its network.")] = 0.0,
    lift_s: Annotated[float, typer.Option(min=0.0, help="Until a person carries it elsewhere.")] = 0.0,
    die_s: Annotated[float, typer.Option(min=0.0, help="Until its computer stops, and a person finds it.")] = 0.0,
    close_s: Annotated[float, typer.Option(min=0.0, help="Between two closures of a corridor.")] = 0.0,
    turns_killed: Annotated[float, typer.Option(min=0.0, max=1.0, help="Share of the turns on a crossing.")] = 0.0,
    calm: Annotated[bool, typer.Option(help="Look less often at what only time changes: for long runs.")] = False,
) -> None:
    """Run whole robots with the whole service; ends with 1 if bodies touched or a corridor was entered ungranted."""
    begin_with_like_hashes()
    simulates_only()
    rates = Rates(kill_s, cut_s, lift_s, die_s, close_s, turns_killed)
    fleet = Fleet(campus, robots, scale, waiting or robots + 2, rates, CALM if calm else SHIPPED)
    figures = Run(fleet, minutes, seed).carry_out()
    command = " ".join(["python -m benchmarks.fleet stepped", *sys.argv[2:]])
    whereof = {"mode": f"stepped, {'calm' if calm else 'as shipped'}", "code": commit(), "command": command}
    print(json.dumps({**whereof, "figures": figures}, indent=2))
    raise typer.Exit(bool(figures["touches"] or figures["ungranted"] or figures["astray"]))
