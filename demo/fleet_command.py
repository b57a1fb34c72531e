"""`fleet`: several robots and a stream of orders, on this machine."""

from pathlib import Path
from typing import Annotated

import typer

from app.cli.output import demonstrating


def fleet(
    *,
    once: Annotated[bool, typer.Option("--once", help="One order for every robot; end when they have ended.")] = False,
    minutes: Annotated[float | None, typer.Option(min=0.1, help="End after so many real minutes.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print one summary object on stdout at the end.")] = False,
    robots: Annotated[
        int | None,
        typer.Option(
            min=1, help="How many robots, at most one for every home of the map; default: one for every dock."
        ),
    ] = None,
    campus: Annotated[str, typer.Option("--map", help="A built-in map by name, or a map file.")] = "carleton",
    speed: Annotated[float | None, typer.Option(min=0.25, max=100, help="Simulated seconds per second.")] = None,
    scale: Annotated[float, typer.Option(min=0.05, max=1, help="How long the tunnels are, of their length.")] = 0.1,
    restart_after: Annotated[
        float, typer.Option(min=1, help="Simulated minutes until a robot whose process died is started again.")
    ] = 10,
    ghosts: Annotated[
        bool, typer.Option("--ghosts", help="Let bodies pass through each other, and count it instead of ending.")
    ] = False,
    seed: Annotated[int, typer.Option(help="The same seed, the same orders.")] = 1,
    port: Annotated[int, typer.Option(help="TCP port of the pages; 0 takes a free one.")] = 8000,
    data: Annotated[Path | None, typer.Option(help="Folder to keep everything in; default: a temporary one.")] = None,
) -> None:
    """See a fleet at work: the service, simulated robots in the Carleton tunnels, and people who send mail."""
    goes_on = not once and minutes is None
    with demonstrating("a service and its fleet", as_json=as_json, goes_on=goes_on):
        from demo.command import demonstrate_fleet
        from demo.fleet.campus import campus_of
        from demo.fleet.settings import ONCE_SPEED, WATCHED_SPEED

        speed = speed or (ONCE_SPEED if once else WATCHED_SPEED)
        run = {"once": once, "minutes": minutes, "as_json": as_json, "speed": speed, "seed": seed, "port": port}
        wanted = {"campus": campus_of(campus, robots), "scale": scale, "restart_after_s": 60 * restart_after}
        code = demonstrate_fleet(data, **run, **wanted, ghosts=ghosts)
    raise typer.Exit(code)
