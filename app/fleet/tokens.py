"""Robots sign in with `cmr_<prefix>_<secret>`: the prefix can be read in lists and logs, the secret is only hashed."""

import hmac
import re
import secrets
from dataclasses import dataclass
from datetime import datetime
from hashlib import sha256

from sqlmodel.ext.asyncio.session import AsyncSession

from app.tables import RobotToken

_TOKEN = re.compile(r"cmr_(?P<prefix>[0-9a-f]{8})_(?P<secret>[A-Za-z0-9-]{43})")


@dataclass(frozen=True)
class NewToken:
    """Its `text` is shown once and never again."""

    prefix: str
    text: str
    secret_hash: str


def make_token() -> NewToken:
    """256 random bits behind a prefix of 32."""
    prefix, secret = secrets.token_hex(4), secrets.token_urlsafe(32).replace("_", "-")
    return NewToken(prefix, f"cmr_{prefix}_{secret}", _hash(secret))


async def token_of(session: AsyncSession, authorization: str | None, now: datetime) -> RobotToken | None:
    """The token that an Authorization header carries, which says whose it is; None if it is refused."""
    match = _TOKEN.fullmatch((authorization or "").removeprefix("Bearer "))
    row = await session.get(RobotToken, match["prefix"]) if match else None
    if match is None or row is None or row.revoked_at is not None:
        return None
    if not hmac.compare_digest(row.secret_hash, _hash(match["secret"])):
        return None
    row.used_at = now
    return row


async def is_revoked(session: AsyncSession, prefix: str) -> bool:
    """Whether a token that let somebody in is worthless by now."""
    row = await session.get(RobotToken, prefix)
    return row is None or row.revoked_at is not None


def _hash(secret: str) -> str:
    # A plain hash is enough for 256 random bits: there is nothing to guess.
    return sha256(secret.encode()).hexdigest()
