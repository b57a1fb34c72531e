"""`stop` and `rearm`: the emergency stop from a terminal."""

from typing import Annotated

import typer

from robot.core.config import Settings
from robot.core.errors import RobotError
from robot.core.json_socket import NoAnswer, ask
from robot.drivers.create2.last_resort import stop_base
from robot.mission.latched_stop import FILE_NAME, LatchedStop
from robot.ops.commands.asking import UNFINISHED, ConfigOption, DataOption, settings_of
from robot.ops.control import SOCKET_NAME

PortOption = Annotated[str | None, typer.Option("--port", help="Serial port of the base, where it is another.")]


def stop(config: ConfigOption = None, data: DataOption = None, port: PortOption = None) -> None:
    """Stop the wheels now. They stay stopped, through a restart too, until a person re-arms the robot.

    If no daemon answers, the stop goes straight to the base, which is then in Passive; and it is written down, so that
    a daemon that hangs and is started again (as systemd does) stays stopped.

    Exit status 0: the daemon has stopped the wheels. 1: no daemon answered, the stop bytes went to the base.
    2: neither could be reached: press Clean on the robot, or lift it.
    """
    settings = settings_of(config, data)
    answer = _asked(settings, "stop")
    if answer is None:
        print("The wheels stand. Start again with: python -m robot rearm")
        return
    typer.echo(answer, err=True)
    try:
        stop_base(port or settings.serial_port)  # before the disk is met, which may be what hangs
    except RobotError as problem:
        typer.echo(f"{problem}\nThe robot was NOT stopped. Press Clean on it, or lift it.", err=True)
        raise typer.Exit(2) from None
    finally:
        _write_down(settings)
    print("The stop bytes were written to the base; that it stands is not confirmed. Look at it.")
    raise typer.Exit(UNFINISHED)


def _write_down(settings: Settings) -> None:
    """For the next start. Where there is no data folder, no robot has ever run."""
    if settings.data.is_dir():
        memory = LatchedStop(settings.data / FILE_NAME)
        memory.keep(memory.read() | {"emergency_stop"})


def rearm(config: ConfigOption = None, data: DataOption = None) -> None:
    """Let a stopped robot go again. Look at it first: it may begin to drive at once.

    The same as the Spot button on the robot. Exit status 1: it was not re-armed, and why (a wheel in the air, a drop
    before it, no daemon).
    """
    answer = _asked(settings_of(config, data), "rearm")
    if answer is not None:
        typer.echo(answer, err=True)
        raise typer.Exit(UNFINISHED)
    print("The robot may drive again.")


def _asked(settings: Settings, what: str) -> str | None:
    """None when it is done, else what hindered it."""
    try:
        answer = ask(settings.data / SOCKET_NAME, {"do": what})
    except NoAnswer as error:
        return str(error)
    return None if answer.get("ok") else f"The robot answered: {answer.get('error')}"
