"""`letter`: the first letter, on this machine."""

from pathlib import Path
from typing import Annotated

import typer

from app.cli.output import demonstrating


def letter(
    *,
    once: Annotated[bool, typer.Option("--once", help="End after the delivery.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print one summary object on stdout.")] = False,
    speed: Annotated[float | None, typer.Option(min=0.25, max=100, help="Simulated seconds per second.")] = None,
    low_battery: Annotated[bool, typer.Option("--low-battery", help="The battery runs low with mail aboard.")] = False,
    hands_on: Annotated[bool, typer.Option("--hands-on", help="Show the codes to the camera yourself.")] = False,
    port: Annotated[int, typer.Option(help="TCP port of the page; 0 takes a free one.")] = 8000,
    data: Annotated[Path | None, typer.Option(help="Folder to keep everything in; default: a temporary one.")] = None,
) -> None:
    """See the first letter: service, simulated robot and one order, on this machine."""
    with demonstrating("a service, a robot and one order", as_json=as_json, goes_on=not once):
        from demo.command import demonstrate
        from demo.settings import default_speed

        speed = speed or default_speed(once=once, hands_on=hands_on)
        code = demonstrate(
            data, port=port, speed=speed, once=once, as_json=as_json, low_battery=low_battery, hands_on=hands_on
        )
    raise typer.Exit(code)
