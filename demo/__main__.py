"""The demonstrations' commands: `python -m demo --help`."""

import typer

from demo.fleet_command import fleet
from demo.letter_command import letter

HELP = """Campus Mail: demonstrations on this machine. Robots, people and time are simulated."""

app = typer.Typer(no_args_is_help=True, help=HELP)
app.command()(letter)
app.command()(fleet)

if __name__ == "__main__":
    app(prog_name="python -m demo")
