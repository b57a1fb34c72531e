"""The service's commands: `python -m app --help`."""

import asyncio
import contextlib
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

import typer

from app.errors import ServiceError, StartError
from app.logs import set_up_logs
from app.settings import Settings, load_settings

app = typer.Typer(no_args_is_help=True, add_completion=False, help="Campus Mail: the service.")
people_app = typer.Typer(no_args_is_help=True, help="People and their roles.")
robots_app = typer.Typer(no_args_is_help=True, help="Robots that may sign in.")
app.add_typer(people_app, name="people")
app.add_typer(robots_app, name="robots")

EXIT_CANNOT_START = 2


@contextlib.contextmanager
def errors_in_words() -> Iterator[None]:
    """A named error is a sentence on stderr and exit code 2, never a traceback."""
    try:
        yield
    except (StartError, ServiceError) as error:
        typer.echo(f"campus-mail: {error}", err=True)
        raise typer.Exit(EXIT_CANNOT_START) from None


def _settings(**given: object) -> Settings:
    """The settings of the environment, and what was given as an option."""
    settings = load_settings()
    wanted = {name: value for name, value in given.items() if value is not None}
    return Settings.model_validate({**settings.model_dump(), **wanted})


@app.command()
def serve(
    host: Annotated[str | None, typer.Option(help="Address to listen on.")] = None,
    port: Annotated[int | None, typer.Option(help="TCP port to listen on; 0 takes a free one.")] = None,
) -> None:
    """Serve pages and API until Ctrl-C. The database is made or brought up to date first."""
    from app.serving import serve as serve_until_stopped

    with errors_in_words(), contextlib.suppress(KeyboardInterrupt):
        settings = _settings(host=host, port=port)
        set_up_logs(settings.log_level)
        serve_until_stopped(settings)


@app.command()
def demo(
    *,
    once: Annotated[bool, typer.Option("--once", help="End after the delivery.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print one summary object on stdout.")] = False,
    speed: Annotated[float | None, typer.Option(min=0.25, max=100, help="Simulated seconds per second.")] = None,
    low_battery: Annotated[bool, typer.Option("--low-battery", help="The battery runs low with mail aboard.")] = False,
    hands_on: Annotated[bool, typer.Option("--hands-on", help="Show the codes to the camera yourself.")] = False,
    port: Annotated[int, typer.Option(help="TCP port of the page.")] = 8000,
    data: Annotated[Path | None, typer.Option(help="Folder to keep everything in; default: a temporary one.")] = None,
) -> None:
    """See the first letter: service, simulated robot and one order, on this machine."""
    from app.demo.command import demonstrate
    from app.demo.settings import default_speed

    speed = speed or default_speed(once=once, hands_on=hands_on)
    with errors_in_words():
        code = demonstrate(
            data, port=port, speed=speed, once=once, as_json=as_json, low_battery=low_battery, hands_on=hands_on
        )
    raise typer.Exit(code)


@app.command()
def migrate() -> None:
    """Bring the database to the schema of this version."""
    from app.commands import migrate as bring_up_to_date

    with errors_in_words():
        settings = load_settings()
        set_up_logs(settings.log_level)
        asyncio.run(bring_up_to_date(settings))


@people_app.command("role")
def role(
    email: Annotated[str, typer.Argument(help="Mail address of the person.")],
    add: Annotated[list[str] | None, typer.Option(help="Role to give: dispatcher or maintainer.")] = None,
    remove: Annotated[list[str] | None, typer.Option(help="Role to take.")] = None,
) -> None:
    """Give or take roles; somebody new is made. This is how the first maintainer comes to be."""
    from app.commands import change_roles

    with errors_in_words():
        roles = asyncio.run(change_roles(load_settings(), email, add or [], remove or []))
        typer.echo(f"{email}: {', '.join(roles)}")


@robots_app.command("enrol")
def enrol(
    name: Annotated[str, typer.Argument(help="Name of the robot, such as r1.")],
    again: Annotated[bool, typer.Option("--again", help="A new token for a robot that is enrolled already.")] = False,
) -> None:
    """Make a robot known and print its token, once. Keep it in a file that only the robot's account can read."""
    from app.commands import enrol as enrol_robot

    with errors_in_words():
        typer.echo(asyncio.run(enrol_robot(load_settings(), name, again=again)))


if __name__ == "__main__":
    app()
