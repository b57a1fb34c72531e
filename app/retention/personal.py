"""Data about one person, in their own hands: every row that refers to them, as JSON."""

import json
import zipfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Final

from sqlalchemy import Column, Table, or_
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.errors import StartError
from app.models import Order, Person, metadata
from app.orders.views.views import may_read, role_in, whose_delegates
from app.retention.order_records import one_order

SECRET: Final = ("hash", "secret", "auth", "answer", "code")
"""Columns with one of these words in their name are not for anybody's eyes; who is exported least of all needs them."""
BY_ADDRESS: Final = (("sign_in_codes", "email"),)
"""What knows a person by their mail address alone."""


class NoSuchPerson(StartError):
    """No person has this mail address."""


async def person_of(session: AsyncSession, email: str) -> Person:
    """The person with this address. Raises NoSuchPerson."""
    person = (await session.exec(select(Person).where(Person.email == email.lower()))).first()
    if person is None:
        raise NoSuchPerson(f"No person here has the address {email}. List them with: people list.")
    return person


def references_to_people() -> Iterator[tuple[Table, list[Column[Any]]]]:
    """Every table that refers to people, and the columns that do."""
    for table in metadata.sorted_tables:
        columns = [column for column in table.columns if column.references(metadata.tables["people"].c.id)]
        if columns:
            yield table, columns


async def everything_of(session: AsyncSession, person: Person) -> dict[str, Any]:
    """By name of the document: `person`, `orders` with their lives, and each table that has rows about them."""
    connection, theirs = await session.connection(), await _orders_of(session, person)
    documents: dict[str, Any] = {
        "person": person.model_dump(mode="json"),
        "orders": [_as_seen_by(person, order, await one_order(session, order.id)) for order in theirs],
    }
    for table, columns in references_to_people():
        if table.name not in ("orders", "order_events", "handovers"):
            rows = await connection.execute(table.select().where(or_(*(column == person.id for column in columns))))
            documents[table.name] = [_readable(row) for row in rows.mappings()]
    for name, column in BY_ADDRESS:
        table = metadata.tables[name]
        rows = await connection.execute(table.select().where(table.c[column] == person.email))
        documents[name] = [_readable(row) for row in rows.mappings()]
    return {name: rows for name, rows in documents.items() if rows}


async def _orders_of(session: AsyncSession, person: Person) -> Sequence[Order]:
    theirs = or_(
        col(Order.sender_id) == person.id, col(Order.recipient_id) == person.id, col(Order.placed_by_id) == person.id
    )
    return (await session.exec(select(Order).where(theirs).order_by(col(Order.created_at)))).all()


def _as_seen_by(person: Person, order: Order, record: dict[str, Any]) -> dict[str, Any]:
    """Without the data of others: delegates of the other side, helpers."""
    role = role_in(order, person)
    sees = whose_delegates(role, order)
    known = {record["sender"], record["recipient"], person.email}
    steps = [*record["events"], *record["custody"]]
    for step in steps:
        if step["person"] not in known:
            step["person"] = None
    for event in record["events"]:
        if not may_read(role, order, event["kind"], event["by"]):
            event["reason"] = None
    for handover in record["custody"]:
        if handover["purpose"] not in sees:
            handover["delegate"] = None
    return record


def _readable(row: Any) -> dict[str, Any]:
    return {name: value for name, value in row.items() if not any(word in name for word in SECRET)}


def write_documents(documents: dict[str, Any], to: Path) -> None:
    """A folder of JSON files, or one archive (.zip), for the owner's eyes alone. Raises StartError."""
    texts = {
        f"{name}.json": json.dumps(rows, indent=2, ensure_ascii=False, default=str) for name, rows in documents.items()
    }
    try:
        _write_archive(texts, to) if to.suffix == ".zip" else _write_folder(texts, to)
    except OSError as error:
        raise StartError(
            f"{to} cannot be written: {error.strerror}. Choose another place: --to FOLDER, or --to FILE.zip."
        ) from None


def _write_archive(texts: dict[str, str], to: Path) -> None:
    to.touch(mode=0o600, exist_ok=False)
    with zipfile.ZipFile(to, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in texts.items():
            archive.writestr(name, text)


def _write_folder(texts: dict[str, str], to: Path) -> None:
    to.mkdir(mode=0o700, parents=True)
    for name, text in texts.items():
        (to / name).write_text(text, encoding="utf-8")
