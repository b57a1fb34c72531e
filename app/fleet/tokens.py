"""Robots sign in with `cmr_<prefix>_<secret>`: the prefix can be read in lists and logs, the secret is only hashed."""

from datetime import datetime

from sqlmodel import col, select, update
from sqlmodel.ext.asyncio.session import AsyncSession

from app.bearer_tokens import NewToken, read_token
from app.bearer_tokens import make_token as make_bearer_token
from app.tables import RobotToken

KIND = "cmr"


def make_token() -> NewToken:
    """A token of a robot, shown once."""
    return make_bearer_token(KIND)


async def token_of(session: AsyncSession, authorization: str | None) -> RobotToken | None:
    """The token that an Authorization header carries, which says whose it is; None if it is refused.

    Writes nothing: whoever knocks with a wrong one holds up nobody who writes.
    """
    shown = read_token(KIND, authorization or "")
    row = await session.get(RobotToken, shown.prefix) if shown else None
    if shown is None or row is None or row.revoked_at is not None or not shown.fits(row.secret_hash):
        return None
    return row


async def note_use(session: AsyncSession, prefix: str, now: datetime) -> None:
    """Somebody has come in with this token."""
    await session.exec(update(RobotToken).where(col(RobotToken.prefix) == prefix).values(used_at=now))


async def still_good(session: AsyncSession, prefixes: set[str]) -> set[str]:
    """Which of these tokens, that let somebody in, are worth something still."""
    good = select(RobotToken.prefix).where(col(RobotToken.prefix).in_(prefixes), col(RobotToken.revoked_at).is_(None))
    return set((await session.exec(good)).all())
