"""`fleet-demo`: several robots and a stream of orders, on this machine."""

from pathlib import Path
from typing import Annotated

import typer

from app.commands.speaking import errors_in_words


def fleet_demo(
    *,
    once: Annotated[bool, typer.Option("--once", help="One order for every robot; end when they have ended.")] = False,
    minutes: Annotated[float | None, typer.Option(min=0.1, help="End after so many real minutes.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print one summary object on stdout at the end.")] = False,
    robots: Annotated[int, typer.Option(min=1, max=4, help="How many robots; the map has four docks.")] = 4,
    speed: Annotated[float | None, typer.Option(min=0.25, max=100, help="Simulated seconds per second.")] = None,
    scale: Annotated[float, typer.Option(min=0.05, max=1, help="How long the tunnels are, of their length.")] = 0.1,
    seed: Annotated[int, typer.Option(help="The same seed, the same orders.")] = 1,
    port: Annotated[int, typer.Option(help="TCP port of the pages; 0 takes a free one.")] = 8000,
    data: Annotated[Path | None, typer.Option(help="Folder to keep everything in; default: a temporary one.")] = None,
) -> None:
    """See a fleet at work: the service, simulated robots in the Carleton tunnels, and people who send mail."""
    typer.echo("Campus Mail: starting a service and its fleet on this machine. Ctrl-C ends all of it.", err=as_json)
    from app.demo.command import demonstrate_fleet
    from app.demo.fleet.settings import ONCE_SPEED, WATCHED_SPEED

    speed = speed or (ONCE_SPEED if once else WATCHED_SPEED)
    run = {"once": once, "minutes": minutes, "as_json": as_json, "robots": robots, "speed": speed}
    with errors_in_words():
        code = demonstrate_fleet(data, **run, scale=scale, seed=seed, port=port)
    raise typer.Exit(code)
