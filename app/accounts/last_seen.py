"""Notes when sessions and tokens were used last: after the answer, several together, and only if the database can.

It decides nothing and is shown to their owner alone, so no request waits for it or fails because of it.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any, Final

import structlog
from sqlalchemy import Update, bindparam, update
from sqlmodel import col
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.database.database import Database, connection_of
from app.core.database.deadline import waiting_at_most
from app.core.errors import DATABASE_AWAY
from app.core.polling import PollingLoop
from app.models import PersonSession, PersonToken

WRITE_EVERY_S: Final = 1.0
POLL_AGAIN_S: Final = 60.0
WAIT_S: Final = 1.0
"""Real seconds that it waits for the holder of the database: others want to write more urgently."""

log = structlog.get_logger(__name__)

_SEEN: Final = update(PersonSession).where(col(PersonSession.id) == bindparam("key")).values(seen_at=bindparam("at"))
_USED: Final = update(PersonToken).where(col(PersonToken.prefix) == bindparam("key")).values(used_at=bindparam("at"))


@dataclass
class LastSeen:
    """Runs in the background of the service."""

    database: Database
    _sessions: dict[int, datetime] = field(default_factory=dict)
    _tokens: dict[str, datetime] = field(default_factory=dict)
    _polling: PollingLoop = field(default_factory=lambda: PollingLoop(POLL_AGAIN_S, WRITE_EVERY_S))

    def note_session(self, session_id: int, now: datetime) -> None:
        """Record that a browser has used this session."""
        self._sessions[session_id] = now
        self._polling.wake()

    def note_token(self, prefix: str, now: datetime) -> None:
        """Record that a script has used this token."""
        self._tokens[prefix] = now
        self._polling.wake()

    def stop(self) -> None:
        """End `run` after what it is doing."""
        self._polling.stop()

    async def run(self) -> None:
        """Until stopped or cancelled."""
        async for _ in self._polling.until_stopped():
            await self._write()

    async def _write(self) -> None:
        """Write; what cannot be written now is noted again by the next request that comes with it."""
        sessions, self._sessions = self._sessions, {}
        tokens, self._tokens = self._tokens, {}
        if not sessions and not tokens:
            return
        try:
            with waiting_at_most(WAIT_S):
                async with self.database.transaction(durable=False) as session:
                    await _write_all(session, _SEEN, sessions)
                    await _write_all(session, _USED, tokens)
        except DATABASE_AWAY as error:
            log.warning("last_seen_not_written", why=str(error))


async def _write_all(session: AsyncSession, statement: Update, times: Mapping[Any, datetime]) -> None:
    if times:
        rows = [{"key": key, "at": at} for key, at in times.items()]
        await (await connection_of(session)).execute(statement, rows)
