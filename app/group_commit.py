"""Writers that wait for each other share one commit.

A commit with full sync takes as long as the disk does, and only one writer can be at work. So whoever has done its work
while others wait passes the open transaction on instead of committing it; the last one commits for all. Everybody's
work stands in a savepoint of its own, so that what fails is undone alone, and nobody goes on before the common commit.
"""

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from typing import Final

from sqlalchemy.ext.asyncio import AsyncConnection, AsyncEngine
from sqlmodel.ext.asyncio.session import AsyncSession

AT_MOST: Final = 32
"""Works in one commit: the first of them waits for the last."""
NO_LONGER_THAN_S: Final = 0.05
"""Real seconds. Nobody joins a transaction that has been open for so long."""
AFTER_COMMIT: Final = "after_commit"

Say = Callable[[], None]


@dataclass
class _Work:
    """What one writer has done, and what is to be said of it once it is on the disk."""

    says: list[Say]
    done: asyncio.Future[None]

    def committed(self) -> None:
        """Said even if whoever did it waits no longer."""
        try:
            for say in self.says:
                say()
        except Exception as error:
            self.failed(error)
        else:
            if not self.done.done():
                self.done.set_result(None)

    def failed(self, error: BaseException) -> None:
        if not self.done.done():
            self.done.set_exception(error)
            self.done.exception()  # its writer may have gone: then nobody asks


@dataclass
class _Group:
    """One open transaction."""

    connection: AsyncConnection
    begun_s: float
    works: list[_Work] = field(default_factory=list)
    turns: int = 0

    def may_go_on(self, now_s: float) -> bool:
        """Whether somebody else may still write in it. A connection that broke takes nobody else with it."""
        is_full = self.turns >= AT_MOST or now_s - self.begun_s > NO_LONGER_THAN_S
        return not is_full and not self.connection.invalidated


class Writers:
    """Gives everybody a turn in the order of asking."""

    def __init__(self, engine: AsyncEngine) -> None:
        self._engine = engine
        self._turn = asyncio.Lock()
        self._waiting = 0
        self._group: _Group | None = None
        self._committing: asyncio.Task[None] | None = None

    @asynccontextmanager
    async def transaction(self) -> AsyncIterator[AsyncSession]:
        """A session of one's own; committed when this ends."""
        await self._wait_for_turn()
        work: _Work | None = None
        try:
            group = await self._open_group()
            async with AsyncSession(
                group.connection, expire_on_commit=False, join_transaction_mode="create_savepoint"
            ) as session:
                async with session.begin():
                    yield session
                work = _Work(session.info.pop(AFTER_COMMIT, []), asyncio.get_running_loop().create_future())
            group.works.append(work)
        finally:
            try:
                await self._end_turn()
            finally:
                self._turn.release()
        await work.done

    async def _wait_for_turn(self) -> None:
        self._waiting += 1
        try:
            await self._turn.acquire()
        except BaseException:
            # What was passed on to whoever gives up here has to be committed by somebody.
            self._committing = asyncio.create_task(self._commit_if_nobody_comes())
            raise
        finally:
            self._waiting -= 1

    async def _commit_if_nobody_comes(self) -> None:
        async with self._turn:
            await self._end_turn()

    async def _open_group(self) -> _Group:
        if self._group is None:
            connection = await self._engine.connect()
            try:
                await connection.begin()
            except BaseException:
                await connection.close()
                raise
            self._group = _Group(connection, asyncio.get_running_loop().time())
        self._group.turns += 1
        return self._group

    async def _end_turn(self) -> None:
        """Pass the transaction on to whoever waits, or commit it."""
        group = self._group
        if group is None or (self._waiting and group.may_go_on(asyncio.get_running_loop().time())):
            return
        self._group = None
        try:
            await _commit(group)
        except BaseException as error:
            for work in group.works:
                work.failed(error)
            raise
        for work in group.works:
            work.committed()


async def _commit(group: _Group) -> None:
    try:
        if group.works:
            await group.connection.commit()
    finally:
        await group.connection.close()
