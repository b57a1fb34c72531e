"""Robots sign in with `cmr_<prefix>_<secret>`: the prefix can be read in lists and logs, the secret is only hashed."""

from dataclasses import dataclass
from datetime import datetime
from typing import Final

from sqlalchemy import bindparam
from sqlmodel import col, select, update
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.bearer_tokens import NewToken, read_token
from app.core.bearer_tokens import make_token as make_bearer_token
from app.core.database.database import connection_of
from app.models import RobotRow, RobotToken

KIND = "cmr"


def make_token() -> NewToken:
    """A token of a robot, shown once."""
    return make_bearer_token(KIND)


async def token_of(session: AsyncSession, authorization: str | None) -> RobotToken | None:
    """The token that an Authorization header carries, which says whose it is; None if it is refused.

    Writes nothing: a robot with a wrong one holds up no writer.
    """
    shown = read_token(KIND, authorization or "")
    row = await session.get(RobotToken, shown.prefix) if shown else None
    if shown is None or row is None or row.revoked_at is not None or not shown.fits(row.secret_hash):
        return None
    return row


async def note_use(session: AsyncSession, prefix: str, now: datetime) -> None:
    """A robot has come in with this token."""
    await session.exec(update(RobotToken).where(col(RobotToken.prefix) == prefix).values(used_at=now))


@dataclass(frozen=True, slots=True)
class Known:
    """A robot that was let in: its name, and how far its clock is ahead."""

    name: str
    clock_off_s: float


async def still_good(session: AsyncSession, prefixes: set[str]) -> dict[str, Known]:
    """Which of these tokens, that let a robot in, are worth something still, and whose they are."""
    rows = await (await connection_of(session)).execute(_STILL_GOOD, {"prefixes": list(prefixes)})
    return {prefix: Known(name, clock_off_s) for prefix, name, clock_off_s in rows.all()}


_STILL_GOOD: Final = (
    select(col(RobotToken.prefix), col(RobotRow.name), col(RobotRow.clock_off_s))
    .join(RobotRow, col(RobotRow.name) == col(RobotToken.robot))
    .where(col(RobotToken.prefix).in_(bindparam("prefixes", expanding=True)), col(RobotToken.revoked_at).is_(None))
)
