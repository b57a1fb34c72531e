"""The commands of `python -m bdi`; each is a module of `bdi.tools`."""

import typer

from bdi.tools.check import check
from bdi.tools.replay import replay
from bdi.tools.run import run
from bdi.tools.step import step
from bdi.tools.testing import test

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
)


@app.callback()
def commands() -> None:
    """Run AgentSpeak programs without a body, and see what they do and why."""


for command in (run, test, step, check, replay):
    app.command()(command)


if __name__ == "__main__":
    app(prog_name="python -m bdi")
