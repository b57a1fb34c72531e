"""The robot's commands. `python -m robot --help`."""

import faulthandler
import gc
from importlib import import_module
from typing import Any, Final

import typer
from typer.core import TyperGroup

EXAMPLES = """
A robot at home in a simulated tunnel, in real time:  python -m robot --simulated

Ours, sent somewhere by hand:  python -m robot --simulated --achieve 'visit(post4)'

The run of the paper's section 6.3:  python -m robot --simulated --agent mail.asl --tell 'dockStation(post5)'
--achieve 'collectAndDeliverMail(post1,post4)'; with --battery 0.26 it becomes low on the way.
"""
EPILOG = f"""{EXAMPLES}
A real one:  python -m robot run --config robot.toml; docs/reference/settings.md lists every setting.

Exit status of every command: 0 done, 1 not done, 2 something to put right first, which is named.
"""
DEFAULT = "run"
COMMANDS: Final = {
    "run": ("run:run", "Run one robot until Ctrl-C, or until what it was told to --achieve is done."),
    "status": ("status:status", "What the running robot does and why"),
    "stop": ("stop:stop", "Stop the wheels now."),
    "rearm": ("stop:rearm", "Let a stopped robot go again."),
    "enrol": ("enrol:enrol", "Make this robot known to a service"),
    "doctor": ("doctor:doctor", "Check computer, cable, base, line sensor, camera and service"),
    "logs": ("logs:logs", "The daemon's log"),
    "settings": ("settings:settings", "Print a complete settings file"),
    "calibrate": ("calibrate:cli", "Measure this robot, show old and new, and write the settings."),
}
"""Where each command is, and how it is listed: as its own help begins."""


class RunByDefault(TyperGroup):
    """Options without a command belong to `run`. A command is imported when it is called: `--help` needs none."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        if not args or (args[0].startswith("-") and args[0] != "--help"):
            args = [DEFAULT, *args]
        return super().parse_args(ctx, args)

    def resolve_command(self, ctx: Any, args: list[str]) -> tuple[str | None, Any, list[str]]:
        name, _, rest = super().resolve_command(ctx, args)
        return name, name and loaded(name), rest


def loaded(name: str) -> Any:
    """The command itself, or the group of commands."""
    module, _, attribute = COMMANDS[name][0].partition(":")
    gc.disable()
    found = getattr(import_module(f"robot.ops.commands.{module}"), attribute)
    gc.freeze()  # nothing of it is garbage: looking for any made imports a fifth longer
    gc.enable()
    if not isinstance(found, typer.Typer):
        command, found = found, typer.Typer(add_completion=False, rich_markup_mode=None)
        found.command(name, epilog=EXAMPLES if name == DEFAULT else None)(command)
    return typer.main.get_command(found)


cli = typer.Typer(
    cls=RunByDefault,
    add_completion=False,
    rich_markup_mode=None,
    epilog=EPILOG,
    help="One robot: run it, look after it, set it up. Without a command: run (options as in `run --help`).",
)
for listed, (_, summary) in COMMANDS.items():
    cli.command(listed, help=summary)(lambda: None)

if __name__ == "__main__":
    faulthandler.enable()  # what every thread was doing when systemd's watchdog ended it
    cli(prog_name="python -m robot")
