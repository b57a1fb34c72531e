"""The robot's commands. `python -m robot --help`."""

import faulthandler
from typing import Any

import typer
from typer.core import TyperGroup

from .commands import calibrate, doctor, enrol, logs, run, settings, status, stop

EPILOG = f"""{run.EPILOG}
A real one:  python -m robot run --config robot.toml; docs/robot.md lists every setting.

Exit status of every command: 0 done, 1 not done, 2 something to put right first, which is named.
"""
DEFAULT = "run"


class RunByDefault(TyperGroup):
    """Options without a command belong to `run`."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        if not args or (args[0].startswith("-") and args[0] != "--help"):
            args = [DEFAULT, *args]
        return super().parse_args(ctx, args)


cli = typer.Typer(
    cls=RunByDefault,
    add_completion=False,
    rich_markup_mode=None,
    epilog=EPILOG,
    help="One robot: run it, look after it, set it up. Without a command: run (options as in `run --help`).",
)
cli.callback()(lambda: None)  # a group, however few its commands
cli.command(name="run", epilog=run.EPILOG)(run.run)
cli.add_typer(calibrate.cli, name="calibrate")
cli.command(name="status")(status.status)
cli.command(name="stop")(stop.stop)
cli.command(name="rearm")(stop.rearm)
cli.command(name="enrol")(enrol.enrol)
cli.command(name="doctor")(doctor.doctor)
cli.command(name="logs")(logs.logs)
cli.command(name="settings")(settings.settings)


if __name__ == "__main__":
    faulthandler.enable()  # what every thread was doing when systemd's watchdog ended it
    cli(prog_name="python -m robot")
