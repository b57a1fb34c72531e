"""Writers who wait for each other share a commit: no writer is told before it, and what fails is undone alone."""

import asyncio
import signal
import sqlite3
import sys
from asyncio.subprocess import PIPE, create_subprocess_exec
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import event
from sqlalchemy.exc import OperationalError
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.database.database import Database, after_commit

CHECKOUT = Path(__file__).parents[2]
WRITES_AND_SAYS = """
import asyncio, sys
from app.core.database.database import Database

async def main():
    database = Database(sys.argv[1])
    async def write(first):
        for number in range(first, 10**9, 8):
            async with database.transaction() as session:
                connection = await session.connection()
                await connection.exec_driver_sql("INSERT INTO words VALUES (?)", (str(number),))
            print(number, flush=True)
    await asyncio.gather(*(write(first) for first in range(8)))

asyncio.run(main())
"""


@pytest.fixture
async def database(tmp_path: Path) -> AsyncIterator[Database]:
    database = Database(f"sqlite:///{tmp_path}/words.sqlite")
    async with database.transaction() as session:
        await do(session, "CREATE TABLE words (word TEXT PRIMARY KEY)")
    yield database
    await database.close()


async def do(session: AsyncSession, statement: str, *values: str) -> list[Any]:
    done = await (await session.connection()).exec_driver_sql(statement, values)
    return list(done) if done.returns_rows else []


async def write(database: Database, word: str, before: asyncio.Event | None = None) -> None:
    async with database.transaction() as session:
        await do(session, "INSERT INTO words VALUES (?)", word)
        if before is not None:
            await before.wait()


async def words(database: Database) -> list[str]:
    async with database.reading() as session:
        return [str(row[0]) for row in await do(session, "SELECT word FROM words ORDER BY rowid")]


async def test_those_who_write_at_the_same_time_share_a_commit_in_the_order_of_asking(database: Database) -> None:
    commits = []
    event.listen(database.engine.sync_engine, "commit", commits.append)
    await asyncio.gather(*(write(database, f"w{number}") for number in range(20)))
    assert len(commits) < 5
    assert await words(database) == [f"w{number}" for number in range(20)]


async def test_no_writer_goes_on_before_what_they_wrote_is_committed(database: Database) -> None:
    said: list[str] = []

    async def write_and_say() -> None:
        async with database.transaction() as session:
            await do(session, "INSERT INTO words VALUES (?)", "first")
            after_commit(session, lambda: said.append("said"))
            await asyncio.sleep(0)  # the next one waits from now on
        said.append("went on")

    goes_on = asyncio.Event()
    tasks = [asyncio.create_task(write_and_say()), asyncio.create_task(write(database, "second", goes_on))]
    await asyncio.sleep(0.1)
    assert (said, await words(database)) == ([], []), "the second has the transaction now, the first waits with it"
    goes_on.set()
    await asyncio.gather(*tasks)
    assert (said, await words(database)) == (["said", "went on"], ["first", "second"])


async def test_what_fails_is_undone_alone(database: Database) -> None:
    writing = [write(database, word) for word in ("one", "two", "one", "three")]
    failures = await asyncio.gather(*writing, return_exceptions=True)
    assert [type(failure).__name__ for failure in failures] == ["NoneType", "NoneType", "IntegrityError", "NoneType"]
    assert await words(database) == ["one", "two", "three"]


async def test_no_writer_is_told_of_what_a_full_disk_undid(database: Database) -> None:
    """SQLite then undoes the whole transaction, and with it what others wrote before."""
    said: list[str] = []

    async def write_and_say(word: str) -> None:
        async with database.transaction() as session:
            if word == "first":
                ((pages,),) = await do(session, "PRAGMA page_count")
                await do(session, f"PRAGMA max_page_count={pages + 10}")
            await do(session, "INSERT INTO words (word) VALUES (?)", word)
            after_commit(session, lambda: said.append(word))
            await asyncio.sleep(0)  # the next one waits from now on

    writing = [write_and_say(word) for word in ("first", "much" * 50_000, "third")]
    assert all(isinstance(end, OperationalError) for end in await asyncio.gather(*writing, return_exceptions=True))
    await write_and_say("fourth")
    assert said == await words(database) == ["fourth"]


async def test_a_cancelled_writer_takes_no_other_with_them(database: Database) -> None:
    """One in the middle of its work, one that was passed the transaction and does not want it any more."""
    never = asyncio.Event()
    tasks = [asyncio.create_task(write(database, word, at)) for word, at in (("one", None), ("two", never))]
    waiting = asyncio.create_task(write(database, "three"))
    await asyncio.sleep(0.1)
    tasks[1].cancel()
    waiting.cancel()
    async with asyncio.timeout(5):
        await asyncio.gather(*tasks, waiting, return_exceptions=True)
        assert await words(database) == ["one"]
        await write(database, "four")


async def test_a_statement_that_is_cancelled_goes_to_its_end(database: Database) -> None:
    """Its connection is not thrown away, nor what others have written with it."""
    slow = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 2000000) SELECT count(*) FROM n"

    async def think() -> None:
        async with database.transaction() as session:
            await do(session, slow)

    tasks = [asyncio.create_task(write(database, "one")), asyncio.create_task(think())]
    await asyncio.sleep(0.1)
    tasks[1].cancel()
    ends = await asyncio.gather(*tasks, return_exceptions=True)
    assert ends[0] is None
    assert isinstance(ends[1], asyncio.CancelledError)
    assert await words(database) == ["one"]


@pytest.mark.parametrize("after_s", [0.3, 0.5])
@pytest.mark.slow
async def test_a_kill_in_the_middle_loses_nothing_that_was_told(tmp_path: Path, after_s: float) -> None:
    file = tmp_path / "words.sqlite"
    with sqlite3.connect(file) as connection:
        connection.execute("CREATE TABLE words (word TEXT PRIMARY KEY)")
    connection.close()
    url = f"sqlite:///{file}"
    child = await create_subprocess_exec(sys.executable, "-c", WRITES_AND_SAYS, url, stdout=PIPE, cwd=CHECKOUT)
    assert child.stdout is not None
    told = {await child.stdout.readline()}
    await asyncio.sleep(after_s)
    child.send_signal(signal.SIGKILL)
    told |= set((await child.stdout.read()).splitlines(keepends=True))
    await child.wait()
    with sqlite3.connect(file) as connection:
        kept = [row[0].encode() + b"\n" for row in connection.execute("SELECT word FROM words")]
    connection.close()
    assert len(told) > 8
    assert {line for line in told if line.endswith(b"\n")} - set(kept) == set()


async def sync_of(session: AsyncSession) -> int:
    """SQLite's own word: 1 leaves the sync to a later commit, 2 waits for the disk."""
    return int((await do(session, "PRAGMA synchronous"))[0][0])


async def test_what_must_last_does_not_share_a_commit_that_waits_for_no_disk(database: Database) -> None:
    synced: dict[str, int] = {}

    async def one(word: str, *, durable: bool) -> None:
        async with database.transaction(durable=durable) as session:
            await do(session, "INSERT INTO words VALUES (?)", word)
            await asyncio.sleep(0)  # the next one waits from now on
            synced[word] = await sync_of(session)

    await asyncio.gather(one("a", durable=False), one("b", durable=True))
    assert synced == {"a": 1, "b": 2}
    assert await words(database) == ["a", "b"]


async def test_fleeting_work_that_cannot_be_committed_takes_no_durable_work_with_it(database: Database) -> None:
    async def one(word: str, *, durable: bool) -> None:
        async with database.transaction(durable=durable) as session:
            await do(session, "INSERT INTO words VALUES (?)", word)
            await asyncio.sleep(0.01)
            if not durable:
                await do(session, "PRAGMA defer_foreign_keys=ON")
                await do(session, "INSERT INTO letters VALUES ('nobody''s')")

    async with database.transaction() as session:
        await do(session, "CREATE TABLE letters (word TEXT REFERENCES words (word))")
    outcomes = await asyncio.gather(one("a", durable=False), one("b", durable=True), return_exceptions=True)
    assert "FOREIGN KEY" in str(outcomes[0])
    assert outcomes[1] is None
    assert await words(database) == ["b"]


async def test_what_is_committed_is_said_even_if_its_writer_was_cancelled_at_the_end(database: Database) -> None:
    said: list[str] = []

    async def one(word: str) -> None:
        async with database.transaction() as session:
            await do(session, "INSERT INTO words VALUES (?)", word)
            after_commit(session, lambda: said.append(word))
            task = asyncio.current_task()
            if word == "a" and task is not None:
                task.cancel()

    await asyncio.gather(*(asyncio.create_task(one(word)) for word in "ab"), return_exceptions=True)
    assert said == await words(database)
    assert "b" in said
