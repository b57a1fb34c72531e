"""The service's commands: `python -m app --help`."""

import gc
from importlib import import_module
from typing import Any, Final

import typer
from typer.core import TyperGroup

HELP = """Campus Mail: the service.

Everything is set by environment variables (CAMPUS_MAIL_…, docs/reference/settings.md); commands work beside a running
service, but for `restore`. Exit status: 0 done, 1 looked and found something wrong, 2 could not be done, and why is on
stderr.
"""
COMMANDS: Final = {
    "serve": ("serve:serve", "Serve pages and API until Ctrl-C or SIGTERM."),
    "migrate": ("serve:migrate", "Bring the database to the schema of this version and do nothing else."),
    "people": ("people:cli", "People and their roles."),
    "robots": ("robots:cli", "Robots that may sign in."),
    "orders": ("orders:cli", "Orders: list, show with timeline and custody, export."),
    "map": ("map:cli", "The campus map that the service is set to (CAMPUS_MAIL_MAP)."),
    "backup": ("backup:backup", "Write database and keys into one archive, beside the running service."),
    "restore": ("backup:restore", "Put a backup in place, after every check that it is whole."),
    "export": ("personal:export", "Everything the service knows of one person, as JSON files to hand to them"),
    "erase": ("personal:erase", "Replace a person's name and address and delete what leads to them"),
    "retain": ("retain:retain", "Take names out of old orders, delete old telemetry, codes and sessions."),
}
"""Where each command is, and how it is listed: as its own help begins."""


class LateCommands(TyperGroup):
    """Imports a command when it is called: all of them together take seconds, and `--help` needs none."""

    def resolve_command(self, ctx: Any, args: list[str]) -> tuple[str | None, Any, list[str]]:
        name, _, rest = super().resolve_command(ctx, args)
        return name, name and loaded(name), rest


def loaded(name: str) -> Any:
    """The command itself, or the group of commands."""
    module, _, attribute = COMMANDS[name][0].partition(":")
    gc.disable()
    found = getattr(import_module(f"app.cli.{module}"), attribute)
    gc.freeze()  # nothing of it is garbage: looking for any made imports a fifth longer
    gc.enable()
    if not isinstance(found, typer.Typer):
        command, found = found, typer.Typer(add_completion=False)
        found.command(name)(command)
    return typer.main.get_command(found)


app = typer.Typer(cls=LateCommands, no_args_is_help=True, help=HELP)
for listed, (_, summary) in COMMANDS.items():
    app.command(listed, help=summary)(lambda: None)

if __name__ == "__main__":
    app(prog_name="python -m app")
