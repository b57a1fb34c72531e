"""`export` and `erase`: a person's data, given to them or taken out."""

import asyncio
from pathlib import Path
from typing import Annotated

import typer

from app.cli.administration import database_at_head
from app.cli.output import AsJson, Email, errors_in_words, say_json
from app.core.errors import Refused
from app.core.settings import Settings, load_settings, open_clock
from app.retention.erasure import erase as erase_rows
from app.retention.erasure import erase_mails
from app.retention.personal import everything_of, person_of, write_documents


def export(
    email: Email,
    to: Annotated[Path, typer.Option("--to", help="New folder for the JSON files, or a new file ending in .zip.")],
    as_json: AsJson = False,
) -> None:
    """Everything the service knows of one person, as JSON files to hand to them (FIPPA, section 47)."""
    with errors_in_words():
        counts = asyncio.run(_export(load_settings(), email, to))
    if as_json:
        say_json({"to": str(to), "rows": counts})
    else:
        rows = ", ".join(f"{count} {name}" for name, count in counts.items())
        typer.echo(f"{to}: who they are, {rows or 'and nothing besides'}")


def erase(
    email: Email,
    yes: Annotated[bool, typer.Option("--yes", help="Do not ask.")] = False,
    as_json: AsJson = False,
) -> None:
    """Replace a person's name and address and delete what leads to them; their orders stay, as records without a name.

    Refused while an order of theirs is under way. There is no way back, but for backups: those keep the name until
    they are thrown away.
    """
    with errors_in_words():
        if not yes and not _is_sure(email):
            raise Refused("Nothing was erased.")
        orders, mails = asyncio.run(_erase(load_settings(), email))
    if as_json:
        say_json({"orders_kept": orders, "mails_deleted": mails})
    else:
        typer.echo(f"Erased. {orders} orders stay without a name; {mails} mails were deleted from the spool.")


def _is_sure(email: str) -> bool:
    """Asked at a terminal; without one there is no yes."""
    try:
        return typer.confirm(f"Erase {email}? There is no way back.", err=True)
    except typer.Abort:
        return False


async def _export(settings: Settings, email: str, to: Path) -> dict[str, int]:
    async with database_at_head(settings) as session:
        documents = await everything_of(session, await person_of(session, email))
    await asyncio.to_thread(write_documents, documents, to)
    return {name: len(rows) for name, rows in documents.items() if isinstance(rows, list)}


async def _erase(settings: Settings, email: str) -> tuple[int, int]:
    async with database_at_head(settings) as session:
        kept = await erase_rows(session, await person_of(session, email), open_clock(settings).utc())
    return kept, await asyncio.to_thread(erase_mails, settings.spool_folder, email.lower())
