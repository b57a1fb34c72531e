"""SQLite on an event loop: short statements run at once, and what takes long holds up no other task."""

import asyncio
import sqlite3
import time
from collections.abc import AsyncIterator, Callable
from contextlib import closing
from pathlib import Path
from threading import current_thread, main_thread
from typing import Any

import pytest
from sqlalchemy import Column, Integer, MetaData, Select, Table, Text, event, func, insert, literal, select, update
from sqlalchemy.exc import OperationalError
from sqlalchemy.ext.asyncio import AsyncConnection

from app.core.database.database import Database
from app.core.database.deadline import waiting_at_most

WORDS = Table("words", MetaData(), Column("id", Integer, primary_key=True), Column("word", Text))


@pytest.fixture
async def database(tmp_path: Path) -> AsyncIterator[Database]:
    database = Database(f"sqlite:///{tmp_path}/words.sqlite")
    event.listen(database.engine.sync_engine, "connect", tell_threads)
    async with database.writing.begin() as connection:
        await connection.run_sync(WORDS.create)
    yield database
    await database.close()


def tell_threads(connection: Any, _: object) -> None:
    connection.create_function("on_loop", 0, lambda: current_thread() is main_thread())


def count_to(number: int) -> Select[Any]:
    """A query that takes as long as one likes, and tells where it ran."""
    numbers = select(literal(1).label("i")).cte("numbers", recursive=True)
    numbers = numbers.union_all(select(numbers.c.i + 1).where(numbers.c.i < number))
    return select(func.count(), func.on_loop()).select_from(numbers)


async def longest_turn_s(until: asyncio.Task[Any], clock: Callable[[], float]) -> float:
    longest_s = 0.0
    while not until.done():
        begun_s = clock()
        await asyncio.sleep(0)
        longest_s = max(longest_s, clock() - begun_s)
    return longest_s


async def words(connection: AsyncConnection) -> list[str]:
    return list((await connection.scalars(select(WORDS.c.word).order_by(WORDS.c.id))).all())


@pytest.mark.slow
async def test_a_short_query_stays_on_the_event_loop_however_often_it_is_asked(database: Database) -> None:
    """SQLite counts the steps of a statement over all of its runs."""
    async with database.asking() as connection:
        for _ in range(6_000):
            answers = (await connection.execute(count_to(5))).all()
    assert answers == [(5, True)]


@pytest.mark.slow
async def test_a_query_that_takes_long_runs_in_the_thread_and_takes_no_change_with_it(database: Database) -> None:
    async def count() -> Any:
        return (await connection.execute(count_to(2_000_000))).one()

    async with database.writing.begin() as connection:
        await connection.execute(insert(WORDS), {"word": "before"})
        counting = asyncio.create_task(count())
        turn_s = await longest_turn_s(counting, time.thread_time)
        assert counting.result() == (2_000_000, False)
        assert await words(connection) == ["before"]
    assert turn_s < 0.05, "of processor time; the query takes many times as long"
    async with database.asking() as connection:
        assert await words(connection) == ["before"]


async def test_a_query_that_is_short_again_returns_to_the_event_loop(database: Database) -> None:
    async with database.asking() as connection:
        answers = [(await connection.execute(count_to(number))).one() for number in (1_000_000, *[3] * 20)]
    assert (answers[0], answers[-1]) == ((1_000_000, False), (3, True))


@pytest.mark.parametrize(
    ("change", "at_once"),
    [
        (insert(WORDS).values(word=func.on_loop()), True),
        (update(WORDS).where(WORDS.c.id == 1).values(word=func.on_loop()), True),
        (update(WORDS).where(WORDS.c.id == 1, WORDS.c.word == "a").values(word=func.on_loop()), True),
        (update(WORDS).where((WORDS.c.id == 1) | (WORDS.c.word == "a")).values(word=func.on_loop()), False),
        (update(WORDS).where(WORDS.c.word == "a").values(word=func.on_loop()), False),
        (update(WORDS).values(word=func.on_loop()), False),
        (insert(WORDS).from_select(["word"], select(func.on_loop())), False),
    ],
)
async def test_a_change_of_one_row_by_its_key_runs_at_once(database: Database, change: Any, at_once: bool) -> None:
    async with database.writing.begin() as connection:
        await connection.execute(insert(WORDS), {"word": "a"})
        await connection.execute(change)
        assert (await words(connection))[-1] == str(int(at_once))


async def test_a_lock_is_waited_for_in_the_thread_and_no_longer_than_the_deadline(
    database: Database, tmp_path: Path
) -> None:
    async def write() -> None:
        with waiting_at_most(1):
            async with database.writing.begin() as connection:
                await connection.execute(insert(WORDS), {"word": "mine"})

    with closing(sqlite3.connect(tmp_path / "words.sqlite", isolation_level=None)) as other:
        other.execute("BEGIN IMMEDIATE")
        begun_s = time.monotonic()
        writing = asyncio.create_task(write())
        turn_s = await longest_turn_s(writing, time.monotonic)
        assert 0.9 < time.monotonic() - begun_s < 5
        assert turn_s < 0.5
        with pytest.raises(OperationalError, match="locked"):
            writing.result()
        other.execute("ROLLBACK")
    await write()
    async with database.asking() as connection:
        assert await words(connection) == ["mine"]


async def test_after_a_full_disk_no_statement_of_the_transaction_runs_any_more(database: Database) -> None:
    async with database.writing.connect() as connection:
        await connection.exec_driver_sql("PRAGMA max_page_count=3")
        await connection.execute(insert(WORDS), {"word": "before"})
        with pytest.raises(OperationalError, match="full"):
            await connection.execute(insert(WORDS), {"word": "much" * 50_000})
        with pytest.raises(OperationalError, match="undone"):
            await connection.execute(insert(WORDS), {"word": "after"})
        with pytest.raises(OperationalError, match="undone"):
            await connection.execute(select(WORDS))
        await connection.rollback()
    async with database.asking() as connection:
        assert await words(connection) == []
