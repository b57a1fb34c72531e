"""`robots`: who may sign in, and when they were last heard."""

import asyncio
from typing import Annotated, Any

import typer
from sqlmodel import col, select

from app.cli.administration import database_at_head, make_enrolment_code
from app.cli.administration import enrol as enrol_robot
from app.cli.administration import revoke as revoke_robot
from app.cli.output import AsJson, errors_in_words, say_json, say_table
from app.core.settings import Settings, load_settings
from app.models import RobotRow, RobotToken
from app.robots.service import known_robot

cli = typer.Typer(no_args_is_help=True, add_completion=False, help="Robots that may sign in.")
Name = Annotated[str, typer.Argument(help="Name of the robot, such as r1.")]


@cli.command("list")
def list_robots(as_json: AsJson = False) -> None:
    """Every robot: connected or not, last heard, battery, tokens that still open the door."""
    with errors_in_words():
        robots = asyncio.run(_robots(load_settings()))
    if as_json:
        say_json(robots)
    else:
        names = ("name", "online", "heard_at", "activity", "post", "battery_ratio", "software", "tokens")
        say_table([n.replace("_", " ") for n in names], [[r[n] for n in names] for r in robots], "No robots.")


@cli.command()
def enrol(
    name: Name,
    token: Annotated[bool, typer.Option("--token", help="Print a token at once; receipts will be unsigned.")] = False,
    again: Annotated[bool, typer.Option("--again", help="With --token: a new one for a robot that is known.")] = False,
) -> None:
    """Print a one-time code for `python -m robot enrol NAME SERVER`, by which a robot makes itself known, or again.

    With --token, for scripts: make it known here and print its token, once. Keep that in a file of the robot's account.
    """
    with errors_in_words():
        if token or again:
            typer.echo(asyncio.run(enrol_robot(load_settings(), name, again=again)))
            return
        code, expires_at = asyncio.run(make_enrolment_code(load_settings(), name))
        typer.echo(code)
        typer.echo(f"Good once, until {expires_at:%H:%M:%S} UTC.", err=True)


@cli.command()
def tokens(name: Name, as_json: AsJson = False) -> None:
    """Every token that a robot has had, by its prefix: when it was made, used last and taken back."""
    with errors_in_words():
        rows = asyncio.run(_tokens(load_settings(), name))
    if as_json:
        say_json(rows)
    else:
        names = ("prefix", "created_at", "used_at", "revoked_at")
        say_table([n.replace("_", " ") for n in names], [[row[n] for n in names] for row in rows], "No tokens.")


@cli.command()
def revoke(
    name: Name, prefix: Annotated[str | None, typer.Option(help="Only the token that begins so.")] = None
) -> None:
    """Make every token of a robot worthless, at once: a robot that was stolen, or whose token was seen."""
    with errors_in_words():
        count = asyncio.run(revoke_robot(load_settings(), name, prefix))
        typer.echo(f"{name}: {count} tokens revoked. Enrol it again: robots enrol {name}")


async def _tokens(settings: Settings, name: str) -> list[dict[str, Any]]:
    async with database_at_head(settings) as session:
        await known_robot(session, name)
        theirs = select(RobotToken).where(RobotToken.robot == name).order_by(col(RobotToken.created_at))
        rows = (await session.exec(theirs)).all()
    return [row.model_dump(mode="json", exclude={"secret_hash", "robot"}) for row in rows]


async def _robots(settings: Settings) -> list[dict[str, Any]]:
    async with database_at_head(settings) as session:
        robots = (await session.exec(select(RobotRow).order_by(RobotRow.name))).all()
        good = select(RobotToken.robot, RobotToken.prefix).where(col(RobotToken.revoked_at).is_(None))
        tokens = list((await session.exec(good)).all())
    seen = {"name", "enrolled_at", "online", "heard_at", "activity", "post", "battery_ratio", "charging", "software"}
    return [
        {**robot.model_dump(mode="json", include=seen), "tokens": [p for name, p in tokens if name == robot.name]}
        for robot in robots
    ]
