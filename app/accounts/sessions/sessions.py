"""Sessions of browsers: opened at sign-in, listed, ended. Known here by the hashes of their cookies alone."""

import secrets
from dataclasses import dataclass
from datetime import datetime, timedelta
from hashlib import sha256
from typing import Final

from sqlalchemy import bindparam
from sqlalchemy import select as sa_select
from sqlalchemy.ext.asyncio import AsyncConnection
from sqlmodel import col, select, update
from sqlmodel.ext.asyncio.session import AsyncSession
from sqlmodel.sql.expression import SelectOfScalar

from app.accounts.errors import UnknownSession
from app.accounts.sessions.devices import device_of
from app.core.database.database import columns_of, row_of
from app.models import Person, PersonSession

SEEN_EVERY: Final = timedelta(minutes=10)
"""How exactly it is known when a session or token was used last: each request would be a write."""


@dataclass(frozen=True)
class OpenSession:
    """A cookie that was good, and whose it is."""

    person: Person
    id: int
    seen_at: datetime | None


def hash_of(token: str) -> str:
    """Tokens are long and random: a plain SHA-256 gives nothing away."""
    return sha256(token.encode()).hexdigest()


def is_stale(seen_at: datetime | None, now: datetime) -> bool:
    """Return whether the time of the last use is to be written anew; also if a clock that ran ahead has written it."""
    return seen_at is None or abs(now - seen_at) >= SEEN_EVERY


def new_session(
    person: Person, user_agent: str, lifetime_s: float, now: datetime, browser: str = ""
) -> tuple[PersonSession, str]:
    """A session and the secret of its cookie; `browser` is the secret of the one that asked for a code."""
    token = secrets.token_urlsafe(32)
    row = PersonSession(
        token_hash=hash_of(token),
        person_id=person.id,
        device=device_of(user_agent),
        browser_hash=hash_of(browser) if browser else "",
        created_at=now,
        seen_at=now,
        expires_at=now + timedelta(seconds=lifetime_s),
    )
    return row, token


async def find_session(connection: AsyncConnection, token: str, now: datetime) -> OpenSession | None:
    """The session of this cookie, if it is still open. Its person is to be looked at only."""
    asked = {"token_hash": hash_of(token), "now": now}
    row = (await connection.execute(_OPENED_BY_COOKIE, asked)).first()
    if row is None:
        return None
    session_id, seen_at, *person = row
    return OpenSession(row_of(Person, dict(zip(_OF_A_PERSON, person, strict=True))), session_id, seen_at)


_OF_A_PERSON: Final = [str(column.key) for column in columns_of(Person)]
_OPENED_BY_COOKIE: Final = (  # put together once: that takes longer than asking
    sa_select(col(PersonSession.id), col(PersonSession.seen_at), *columns_of(Person)).where(
        col(PersonSession.person_id) == col(Person.id),
        col(PersonSession.token_hash) == bindparam("token_hash"),
        col(PersonSession.revoked_at).is_(None),
        col(PersonSession.expires_at) > bindparam("now"),
    )
)


def open_sessions(person_id: str, now: datetime) -> SelectOfScalar[PersonSession]:
    """The sessions of a person."""
    return select(PersonSession).where(
        PersonSession.person_id == person_id, col(PersonSession.revoked_at).is_(None), PersonSession.expires_at > now
    )


async def end_session(session: AsyncSession, person_id: str, session_id: int, now: datetime) -> None:
    """Its cookie is worthless from now on. Raises UnknownSession, for another's too."""
    row = await session.get(PersonSession, session_id)
    if row is None or row.person_id != person_id or row.revoked_at:
        raise UnknownSession(f"There is no open session {session_id} among yours.")
    row.revoked_at = now


async def end_others(session: AsyncSession, person_id: str, but: int, now: datetime) -> None:
    """End all sessions of a person but one."""
    others = update(PersonSession).where(
        col(PersonSession.person_id) == person_id,
        col(PersonSession.id) != but,
        col(PersonSession.revoked_at).is_(None),
    )
    await session.exec(others.values(revoked_at=now))
