"""`python -m robot.simulated`: a simulated Create 2 on a serial port, for any client that speaks to a real one."""

import signal
import traceback
from pathlib import Path
from typing import Annotated, NoReturn

import typer

from maps import MapError, find_map
from protocol.clock import RealClock
from robot.simulated.door import Door
from robot.simulated.errors import SimulatedWorldError, WorldStopped
from robot.simulated.faults import SWITCHES
from robot.simulated.live import Live
from robot.simulated.robot import SimulatedRobot

FAILED, MISUSE = 1, 2
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
    """Runs in real time until Ctrl-C or SIGTERM.

    Exit status 1: the world has failed. 2: something to put right first, which is named.
    """
    if list_faults:
        for name, meaning in SWITCHES.items():
            print(f"{name:20} {meaning}")
        return
    clock = RealClock()
    try:
        robot = SimulatedRobot(find_map(campus), clock.now(), start, seed, link=link)
    except (MapError, SimulatedWorldError) as error:
        _refuse(str(error))
    except OSError as error:
        _refuse(f"--link {link}: cannot be made: {error.strerror}. Name another place, in a folder that is there.")
    let_live(robot, clock, _opened(robot, door))


def _opened(robot: SimulatedRobot, path: Path | None) -> Door | None:
    try:
        return Door(robot, path) if path else None
    except OSError as error:
        robot.close()
        _refuse(
            f"--door {path}: cannot be made: {error.strerror or error}. Name another place, in a folder that is there."
        )


def _refuse(sentence: str) -> NoReturn:
    typer.echo(sentence, err=True)
    raise typer.Exit(MISUSE)


def let_live(robot: SimulatedRobot, clock: RealClock, door: Door | None) -> None:
    life = Live(robot, clock)
    # Before anybody can know of the port. A script that starts this in the background makes it ignore Ctrl-C otherwise.
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: life.stop())
    print(robot.port_path, flush=True)
    try:
        with life:
            life.wait()
    except WorldStopped as stopped:
        traceback.print_exception(stopped.__cause__)  # where in the world: the caller made no mistake
        typer.echo(str(stopped), err=True)
        raise typer.Exit(FAILED) from stopped
    finally:
        if door:
            door.close()
        robot.close()


if __name__ == "__main__":
    cli(prog_name="python -m robot.simulated")
