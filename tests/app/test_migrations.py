"""From every schema that was released to this one, with data in every table, on both databases."""

import asyncio
from collections.abc import AsyncIterator, Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from alembic import command
from alembic.config import Config
from fastapi.testclient import TestClient
from sqlalchemy import Connection, MetaData, insert, select
from sqlmodel import SQLModel
from sqlmodel import select as select_rows

from app.composition import create_app
from app.core.database.database import Database
from app.core.database.schema_version import INI, bring_to_head, is_at_head
from app.core.settings import Settings
from app.models import Notification, Order, OrderState, OutgoingNotification, metadata
from app.retention.database_checks import problems_of
from protocol.clock import SteppedClock
from tests.app.conftest import ON_POSTGRESQL
from tests.app.first_letter import ROWS

RELEASED = {"0001": ROWS}
"""Every schema that a running service may have, and what such a database holds. A release adds its line here."""
REWRITTEN = {("outbox", "next_try_at")}
"""Columns that mean something else today: what was sent has no next try."""


@pytest.fixture
def database_url(request: pytest.FixtureRequest) -> Iterator[str]:
    """An empty database: nothing is at head yet."""
    if not ON_POSTGRESQL:
        yield ""
        return
    server = request.getfixturevalue("postgresql")
    name = server.new_database()
    yield server.url(name)
    server.drop(name)


@pytest.fixture
def sqlite_at_head() -> None:
    """Here migrations begin at nothing."""


@pytest.fixture
async def database(settings: Settings) -> AsyncIterator[Database]:
    database = Database(settings.url_of_database)
    yield database
    await database.close()


async def bring_to(database: Database, revision: str) -> None:
    config = Config(INI)

    def upgrade(connection: Connection) -> None:
        config.attributes["connection"] = connection
        command.upgrade(config, revision)

    async with database.rebuilding() as connection:
        await connection.run_sync(upgrade)


async def on(database: Database, work: Callable[[Connection], Any]) -> Any:
    async with database.writing.begin() as connection:
        return await connection.run_sync(work)


def tables_of(connection: Connection) -> MetaData:
    """The tables as the database has them."""
    found = MetaData()
    found.reflect(connection)
    return found


def fill(rows: dict[str, list[dict[str, Any]]]) -> Callable[[Connection], None]:
    def write(connection: Connection) -> None:
        for table in tables_of(connection).sorted_tables:
            if table.name != "alembic_version":
                connection.execute(insert(table), _even(rows[table.name]))

    return write


def _even(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Rows of one statement have the same columns."""
    names = {name for row in rows for name in row}
    return [{name: row.get(name) for name in names} for row in rows]


def content(connection: Connection) -> dict[str, list[dict[str, Any]]]:
    tables = tables_of(connection).sorted_tables
    return {table.name: [dict(row) for row in connection.execute(select(table)).mappings()] for table in tables}


@pytest.mark.parametrize("revision", RELEASED)
@pytest.mark.slow
async def test_nothing_that_was_stored_is_lost_on_the_way_to_head(database: Database, revision: str) -> None:
    await bring_to(database, revision)
    await on(database, fill(RELEASED[revision]))
    before = await on(database, content)
    assert all(before.values()), "every table of a release has a row to lose"
    await bring_to_head(database)
    assert await is_at_head(database)
    after = await on(database, content)
    for name, rows in before.items():
        if name != "alembic_version":
            assert _in_order(name, after[name], rows[0]) == _in_order(name, rows, rows[0]), name
    assert await on(database, problems_of) == []


def _in_order(name: str, rows: list[dict[str, Any]], before: dict[str, Any]) -> list[dict[str, Any]]:
    """The columns that there were before, row by row."""
    columns = [column for column in sorted(before) if (name, column) not in REWRITTEN]
    return sorted(({column: row[column] for column in columns} for row in rows), key=str)


@pytest.mark.parametrize("revision", RELEASED)
async def test_todays_code_reads_every_row_of_an_older_schema(database: Database, revision: str) -> None:
    await bring_to(database, revision)
    await on(database, fill(RELEASED[revision]))
    await bring_to_head(database)
    classes = [mapper.class_ for mapper in SQLModel._sa_registry.mappers]
    assert {one.__tablename__ for one in classes} == set(metadata.tables)
    async with database.reading() as session:
        for one in classes:
            rows = (await session.exec(select_rows(one))).all()
            assert len(rows) == len(RELEASED[revision].get(one.__tablename__, [])), one


def test_a_service_starts_on_the_first_letters_database_and_goes_on_with_its_work(
    settings: Settings, clock: SteppedClock, pages: Path
) -> None:
    asyncio.run(_prepare(settings))
    with TestClient(create_app(settings, clock)) as client:
        assert client.get("/readyz").json()["status"] == "ready"
        assert client.portal is not None
        orders, unsent, keys = client.portal.call(_look, client.app)
    assert orders == {"o1": OrderState.DELIVERED, "o2": OrderState.TO_SENDER, "o3": OrderState.QUEUED}
    assert len(keys) == len(set(keys))
    assert unsent <= 1


async def _prepare(settings: Settings) -> None:
    database = Database(settings.url_of_database)
    await bring_to(database, "0001")
    await on(database, fill(ROWS))
    await database.close()


async def _look(app: Any) -> tuple[dict[str, OrderState], int, list[tuple[str, str]]]:
    async with app.state.parts.database.reading() as session:
        orders = {order.id: order.state for order in (await session.exec(select_rows(Order))).all()}
        outbox = (await session.exec(select_rows(OutgoingNotification))).all()
        notices = (await session.exec(select_rows(Notification))).all()
    unsent = sum(row.sent_at is None and row.gave_up_at is None for row in outbox)
    return orders, unsent, [(notice.person_id, notice.key) for notice in notices]
