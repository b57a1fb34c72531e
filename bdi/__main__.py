"""The commands of `python -m bdi` and `agentspeak`; each is a module of `bdi.tools`."""

import sys

try:
    import typer

    from bdi.tools.check import check
    from bdi.tools.replay import replay
    from bdi.tools.run import run
    from bdi.tools.step import step
    from bdi.tools.testing import test
except ModuleNotFoundError as missing:
    if missing.name not in ("typer", "rich"):
        raise
    sys.exit(f"The commands need {missing.name}: pip install 'agentspeak-bdi[tools]'")

app = typer.Typer(no_args_is_help=True, pretty_exceptions_enable=False, rich_markup_mode="rich")


@app.callback()
def commands() -> None:
    """Run AgentSpeak programs without a body, and see what they do and why."""


for command in (run, test, step, check, replay):
    app.command()(command)


if __name__ == "__main__":
    app(prog_name="python -m bdi")
