"""`people`: who there is, and what they may do."""

import asyncio
from typing import Annotated

import typer
from sqlmodel import col, func, or_, select

from app.cli.administration import change_roles, database_at_head
from app.cli.output import AsJson, Email, errors_in_words, say_json, say_table
from app.core.settings import Settings, load_settings
from app.models import Order, Person, PersonSession, Role
from app.retention.personal import person_of

cli = typer.Typer(no_args_is_help=True, add_completion=False, help="People and their roles.")


@cli.command("list")
def list_people(
    role: Annotated[Role | None, typer.Option(help="Only people with this role.")] = None, as_json: AsJson = False
) -> None:
    """Everybody the service knows, by mail address."""
    with errors_in_words():
        people = [person for person in asyncio.run(_people(load_settings())) if role is None or person.has_role(role)]
    if as_json:
        say_json([person.model_dump(mode="json") for person in people])
    else:
        rows = [(p.email, p.name, ", ".join(p.roles), p.language, f"{p.created_at:%Y-%m-%d}") for p in people]
        say_table(("address", "name", "roles", "language", "since"), rows, "No people yet.")


@cli.command()
def show(email: Email, as_json: AsJson = False) -> None:
    """One person: roles, open sessions, how many orders they have sent and been sent."""
    with errors_in_words():
        facts = asyncio.run(_facts(load_settings(), email))
    if as_json:
        say_json(facts)
    else:
        say_table(("", ""), [(name.replace("_", " "), value) for name, value in facts.items()], "")


@cli.command()
def role(
    email: Email,
    add: Annotated[list[str] | None, typer.Option(help="Role to give: dispatcher or maintainer.")] = None,
    remove: Annotated[list[str] | None, typer.Option(help="Role to take.")] = None,
) -> None:
    """Give or take roles; a new person is made. This is how the first maintainer comes to be."""
    with errors_in_words():
        roles = asyncio.run(change_roles(load_settings(), email, add or [], remove or []))
        typer.echo(f"{email}: {', '.join(roles)}")


async def _people(settings: Settings) -> list[Person]:
    async with database_at_head(settings) as session:
        return list((await session.exec(select(Person).order_by(Person.email))).all())


async def _facts(settings: Settings, email: str) -> dict[str, object]:
    async with database_at_head(settings) as session:
        person = await person_of(session, email)
        sent = select(func.count()).where(Order.sender_id == person.id)
        received = select(func.count()).where(Order.recipient_id == person.id)
        theirs = or_(Order.sender_id == person.id, Order.recipient_id == person.id)
        last = select(func.max(Order.created_at)).where(theirs)
        open_sessions = select(func.count()).where(
            PersonSession.person_id == person.id, col(PersonSession.revoked_at).is_(None)
        )
        return {
            **person.model_dump(mode="json"),
            "orders_sent": (await session.exec(sent)).one(),
            "orders_received": (await session.exec(received)).one(),
            "last_order_at": (await session.exec(last)).one(),
            "sessions": (await session.exec(open_sessions)).one(),
        }
