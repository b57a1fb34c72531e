"""`orders`: what is under way, the life and custody of one, everything as a table for a spreadsheet."""

import asyncio
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.markup import escape

from app.cli.administration import database_at_head
from app.cli.output import AsJson, console, errors_in_words, say_json, say_table
from app.core.settings import Settings, load_settings
from app.models import OrderState
from app.retention.order_records import CSV_COLUMNS, one_order, orders_of, write_csv

cli = typer.Typer(
    no_args_is_help=True, add_completion=False, help="Orders: list, show with timeline and custody, export."
)
State = Annotated[list[OrderState] | None, typer.Option(help="Only orders in this state; may be repeated.")]
Id = Annotated[str, typer.Argument(metavar="ID", help="The order's id.")]


@cli.command("list")
def list_orders(
    state: State = None,
    limit: Annotated[int, typer.Option(min=1, help="The newest so many.")] = 50,
    as_json: AsJson = False,
) -> None:
    """The newest orders first."""
    with errors_in_words():
        orders = asyncio.run(_orders(load_settings(), state or [], limit))
    if as_json:
        say_json(orders)
    else:
        names = ("id", "state", "sender", "recipient", "from_post", "to_post", "robot", "created_at")
        say_table([name.replace("_", " ") for name in names], [[o[n] for n in names] for o in orders], "No orders.")


@cli.command()
def show(order: Id, as_json: AsJson = False) -> None:
    """One order: who, where, every event of its life, and every time the mail changed hands."""
    with errors_in_words():
        found = asyncio.run(_one(load_settings(), order))
    if as_json:
        say_json(found)
    else:
        _print_order(found)


def _print_order(found: dict[str, Any]) -> None:
    events, custody = found.pop("events"), found.pop("custody")
    say_table(("", ""), [(name.replace("_", " "), value) for name, value in found.items() if value is not None], "")
    console().print("\n[bold]timeline[/bold]")
    names: tuple[str, ...] = ("at", "kind", "state", "by", "person", "robot", "post", "reason")
    say_table(names, [[event[name] for name in names] for event in events], "Nothing has happened.")
    console().print(f"\n[bold]custody[/bold] {escape('(as the robots signed for it)')}")
    names = ("robot_at", "purpose", "how", "evidence", "problem", "settled", "holder", "person", "robot", "post")
    say_table(names, [[row[name] for name in names] for row in custody], "The mail has not changed hands.")


@cli.command()
def csv(
    to: Annotated[Path | None, typer.Option("--to", help="File to write; default: stdout.")] = None,
    state: State = None,
) -> None:
    """Every order as a line of CSV, oldest first, for a spreadsheet. It holds names and addresses: keep it so."""
    with errors_in_words():
        written = asyncio.run(_csv(load_settings(), to, state or []))
    if to is not None:
        typer.echo(f"{to}: {written} orders, columns {', '.join(CSV_COLUMNS)}", err=True)


async def _orders(settings: Settings, states: list[OrderState], limit: int) -> list[dict[str, Any]]:
    async with database_at_head(settings) as session:
        return [order async for order in orders_of(session, states, newest=limit)]


async def _one(settings: Settings, order_id: str) -> dict[str, Any]:
    async with database_at_head(settings) as session:
        return await one_order(session, order_id)


async def _csv(settings: Settings, to: Path | None, states: list[OrderState]) -> int:
    async with database_at_head(settings) as session:
        return await write_csv(orders_of(session, states), to)
