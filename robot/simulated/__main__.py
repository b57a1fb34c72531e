"""`python -m robot.simulated`: a simulated Create 2 on a serial port, for any client that speaks to a real one."""

import signal
from pathlib import Path
from typing import Annotated

import typer

from maps import MapError, find_map
from protocol.clock import RealClock

from .door import Door
from .errors import SimulatedWorldError
from .faults import SWITCHES
from .live import Live
from .robot import SimulatedRobot

cli = typer.Typer(help=__doc__, add_completion=False)


@cli.command()
def run(
    *,
    campus: Annotated[str, typer.Option("--map", help="A map file, or the name of one that ships.")] = "test_track",
    start: Annotated[str, typer.Option(help="dock, a post, or POST:TOWARDS.")] = "dock",
    seed: Annotated[int, typer.Option(help="Same seed, same world.")] = 0,
    link: Annotated[Path | None, typer.Option(help="A stable name for the serial port.")] = None,
    door: Annotated[Path | None, typer.Option(help="A Unix socket for commands to the world.")] = None,
    list_faults: Annotated[bool, typer.Option("--list-faults", help="Say what can go wrong, and end.")] = False,
) -> None:
    """Runs in real time until Ctrl-C or SIGTERM. Exit status 2: no such map or start."""
    if list_faults:
        for name, meaning in SWITCHES.items():
            print(f"{name:20} {meaning}")
        return
    clock = RealClock()
    try:
        robot = SimulatedRobot(find_map(campus), clock.now(), start, seed, link=link)
    except (MapError, SimulatedWorldError) as error:
        typer.echo(str(error), err=True)
        raise typer.Exit(2) from error
    _live(robot, clock, door)


def _live(robot: SimulatedRobot, clock: RealClock, door: Path | None) -> None:
    opened = Door(robot, door) if door else None
    life = Live(robot, clock)
    # Before anybody can know of the port. A script that starts this in the background makes it ignore Ctrl-C otherwise.
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: life.stop())
    print(robot.port_path, flush=True)
    try:
        with life:
            life.wait()
    finally:
        if opened:
            opened.close()
        robot.close()


if __name__ == "__main__":
    cli(prog_name="python -m robot.simulated")
