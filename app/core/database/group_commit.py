"""Writers that wait for each other share one commit.

A commit with full sync takes as long as the disk does, and only one writer can be at work. So a writer that has done
its work while others wait passes the open transaction on instead of committing it; the last one commits for all. What
fails is
undone alone (the first with the transaction, those that follow to a savepoint of their own), and no writer goes on
before the common commit.

Some work may be lost in a power cut because it would only be done again. Its commit waits for no disk, unless it shares
one with work that must last.
"""

import asyncio
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager, contextmanager, suppress
from dataclasses import dataclass, field
from typing import Final, Literal

import structlog
from sqlalchemy.exc import OperationalError
from sqlalchemy.exc import TimeoutError as NoTurn
from sqlalchemy.ext.asyncio import AsyncConnection, AsyncEngine
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.database.deadline import left_s
from app.core.database.shielded import shielded

log = structlog.get_logger(__name__)

AT_MOST: Final = 32
"""Works in one commit: the first of them waits for the last."""
NO_LONGER_THAN_S: Final = 0.05
"""Real seconds. No writer joins a transaction that has been open for so long."""
AFTER_COMMIT: Final = "after_commit"
CONNECTION: Final = "connection"
"""Of a session that writes: kept, because asking the session for it takes as long as a statement."""

Say = Callable[[], None]


@dataclass
class _Work:
    """The work of one writer, and what is to be said of it once it is on the disk."""

    says: list[Say]
    done: asyncio.Future[None]

    def committed(self) -> None:
        """Said even if its writer waits no longer; and done, whatever becomes of what is said."""
        for say in self.says:
            try:
                say()
            except Exception:
                log.exception("what follows a commit has failed")
        if not self.done.done():
            self.done.set_result(None)

    def failed(self, error: BaseException) -> None:
        if not self.done.done():
            self.done.set_exception(error)
            self.done.exception()  # its writer may have gone: then it is not asked for


@dataclass
class _Group:
    """One open transaction."""

    connection: AsyncConnection
    is_durable: bool
    begun_s: float
    works: list[_Work] = field(default_factory=list)
    turns: int = 0
    is_lost: bool = False

    def session(self) -> AsyncSession:
        """The first work needs no savepoint: with it the whole transaction is undone."""
        mode: Literal["create_savepoint", "rollback_only"] = "create_savepoint" if self.works else "rollback_only"
        return AsyncSession(self.connection, expire_on_commit=False, join_transaction_mode=mode)

    @contextmanager
    def lost_if_first_fails(self) -> Iterator[None]:
        try:
            yield
        except BaseException:
            self.is_lost = not self.works
            raise

    def may_go_on(self, now_s: float) -> bool:
        """Tell if another writer may still write in it. A connection that broke fails no other writer."""
        is_full = self.turns >= AT_MOST or now_s - self.begun_s > NO_LONGER_THAN_S
        return not is_full and not self.is_lost and not self.connection.invalidated


class Writers:
    """Gives everybody a turn in the order of asking."""

    def __init__(self, durable: AsyncEngine, fleeting: AsyncEngine) -> None:
        """Two ways to the same database: a commit by the second does not wait for the disk."""
        self._durable, self._fleeting = durable, fleeting
        self._turn = asyncio.Lock()
        self._waiting = 0
        self._group: _Group | None = None
        self._committing: asyncio.Task[None] | None = None

    @asynccontextmanager
    async def transaction(self, *, durable: bool) -> AsyncIterator[AsyncSession]:
        """A session of one's own; committed when this ends."""
        await self._wait_for_turn()
        work: _Work | None = None
        try:
            group = await self._open_group(durable)
            session = group.session()
            try:
                with group.lost_if_first_fails():
                    async with session.begin():
                        session.info[CONNECTION] = await session.connection()
                        yield session
                # Before the session closes, which is where a cancellation may come: it is done, and will be committed.
                work = _Work(session.info.pop(AFTER_COMMIT, []), asyncio.get_running_loop().create_future())
                group.works.append(work)
            finally:
                await session.close()  # its connection stays open: this does not wait
        finally:
            try:
                await self._end_turn()
            finally:
                self._turn.release()
        await work.done

    async def _wait_for_turn(self) -> None:
        self._waiting += 1
        try:
            async with asyncio.timeout(left_s()):
                await self._turn.acquire()
        except BaseException as error:
            # What was passed on to a writer that gives up here still has to be committed.
            self._committing = asyncio.create_task(self._commit_if_nobody_comes())
            if isinstance(error, TimeoutError):
                raise NoTurn("others were writing all the time that there was to wait") from None
            raise
        finally:
            self._waiting -= 1

    async def _commit_if_nobody_comes(self) -> None:
        async with self._turn:
            await self._end_turn()

    async def _open_group(self, durable: bool) -> _Group:
        if self._group is not None and durable and not self._group.is_durable:
            with suppress(Exception):  # told to those whose work it was
                await self._commit_open()
        if self._group is None:
            connection = await (self._durable if durable else self._fleeting).connect()
            try:
                await connection.begin()
            except BaseException:
                await connection.close()
                raise
            self._group = _Group(connection, durable, asyncio.get_running_loop().time())
        self._group.turns += 1
        return self._group

    async def _end_turn(self) -> None:
        """Pass the transaction on to a waiting writer, or commit it."""
        group = self._group
        if group and not (self._waiting and group.may_go_on(asyncio.get_running_loop().time())):
            await self._commit_open()

    async def _commit_open(self) -> None:
        group, self._group = self._group, None
        assert group is not None, "no transaction is open"  # noqa: S101  # the writer that has the turn has looked
        try:
            await shielded(asyncio.ensure_future(_commit(group)))
        except BaseException as error:
            for work in group.works:
                work.failed(error)
            raise
        for work in group.works:
            work.committed()


async def _commit(group: _Group) -> None:
    try:
        if group.works:
            _refuse_if_broken(group)
            await group.connection.commit()
    except BaseException:
        # SQLAlchemy takes the transaction for ended, SQLite does not: the next writer must not get this connection.
        await group.connection.invalidate()
        raise
    finally:
        await group.connection.close()


def _refuse_if_broken(group: _Group) -> None:
    """The connection broke for a later work, and what the earlier ones had written is gone with it."""
    if group.connection.invalidated:
        raise OperationalError(None, None, ConnectionResetError("the connection broke before the commit"))
