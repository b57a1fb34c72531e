"""Transactions: all or nothing, durable, and nothing is told before they are committed."""

import asyncio
from collections.abc import AsyncIterator

import pytest
from sqlalchemy import event
from sqlalchemy.exc import IntegrityError

from app.cli.administration import migrate
from app.core.database.database import Database, after_commit, savepoint, write_all, write_once
from app.core.settings import Settings
from app.models import Person, PersonSession
from protocol.clock import SteppedClock
from tests.app.conftest import sqlite_alone

NOW = SteppedClock().utc()


@pytest.fixture
async def database(settings: Settings) -> AsyncIterator[Database]:
    await migrate(settings)
    database = Database(settings.url_of_database)
    yield database
    await database.close()


def person(name: str) -> Person:
    return Person(id=name, email=f"{name}@campus.example", name=name, created_at=NOW)


async def test_what_waits_for_the_commit_is_told_after_it_and_in_order(database: Database) -> None:
    told: list[str] = []
    async with database.transaction() as session:
        session.add(person("ann"))
        after_commit(session, lambda: told.append("first"))
        after_commit(session, lambda: told.append("second"))
        assert told == []
    assert told == ["first", "second"]


async def test_what_is_rolled_back_is_neither_stored_nor_told(database: Database) -> None:
    told: list[str] = []
    with pytest.raises(ZeroDivisionError):
        async with database.transaction() as session:
            session.add(person("ann"))
            await session.flush()
            after_commit(session, lambda: told.append("ann"))
            raise ZeroDivisionError
    async with database.reading() as session:
        assert await session.get(Person, "ann") is None
    assert told == []


async def test_a_part_that_fails_takes_only_its_own_words_back(database: Database) -> None:
    told: list[str] = []
    async with database.transaction() as session:
        after_commit(session, lambda: told.append("before"))
        with pytest.raises(ZeroDivisionError):
            async with savepoint(session):
                session.add(person("ann"))
                after_commit(session, lambda: told.append("within"))
                raise ZeroDivisionError
        session.add(person("bob"))
        after_commit(session, lambda: told.append("after"))
    assert told == ["before", "after"]
    async with database.reading() as session:
        assert await session.get(Person, "ann") is None
        assert await session.get(Person, "bob") is not None


async def test_writers_that_read_first_wait_for_each_other_instead_of_failing(database: Database) -> None:
    async with database.transaction() as session:
        session.add(person("0"))

    async def one_more() -> None:
        async with database.transaction() as session:
            counted = await session.get_one(Person, "0")
            await asyncio.sleep(0.01)
            counted.name += "x"

    await asyncio.gather(*(one_more() for _ in range(8)))
    async with database.reading() as session:
        assert (await session.get_one(Person, "0")).name == "0" + 8 * "x"


async def test_a_row_that_refers_to_no_person_is_refused(database: Database) -> None:
    with pytest.raises(IntegrityError):
        async with database.transaction() as session:
            session.add(PersonSession(token_hash="t", person_id="nobody", created_at=NOW, expires_at=NOW))


@sqlite_alone
async def test_what_was_committed_survives_a_power_cut(database: Database) -> None:
    """Write-ahead log with full sync, on every connection."""
    async with database.engine.connect() as connection:
        pragmas = {
            name: (await connection.exec_driver_sql(f"PRAGMA {name}")).scalar()
            for name in ("journal_mode", "synchronous")
        }
    assert pragmas == {"journal_mode": "wal", "synchronous": 2}


async def test_what_is_written_past_the_session_is_taken_back_with_its_part(database: Database) -> None:
    """A savepoint begins with the first statement of the session, which these are not."""
    async with database.transaction() as session:
        with pytest.raises(ZeroDivisionError):
            async with savepoint(session):
                await write_all(session, Person, [person("ann").model_dump()])
                assert await write_once(session, Person, person("bob").model_dump())
                raise ZeroDivisionError
    async with database.reading() as session:
        assert await session.get(Person, "ann") is None
        assert await session.get(Person, "bob") is None


async def test_a_commit_goes_to_its_end_even_if_its_task_is_cancelled(database: Database) -> None:
    told: list[str] = []
    written: list[str] = []

    async def write(name: str) -> None:
        async with database.transaction() as session:
            session.add(person(name))
            after_commit(session, lambda: told.append(name))
            await session.flush()
            written.append(name)

    tasks = [asyncio.create_task(write(name)) for name in ("ann", "bob")]
    # The last of the two commits for both, or on a slow machine for itself.
    event.listen(
        database.writing.sync_engine, "commit", lambda connection: tasks[-1].cancel() if "bob" in written else None
    )
    outcomes = await asyncio.gather(*tasks, return_exceptions=True)
    assert outcomes[0] is None
    assert told == ["ann", "bob"]
    async with database.reading() as session:
        assert await session.get(Person, "ann") and await session.get(Person, "bob")
