"""Tokens of machines, `<kind>_<prefix>_<secret>`: a prefix that lists and logs may show, a secret that is hashed."""

import hmac
import re
import secrets
from dataclasses import dataclass
from hashlib import sha256
from typing import Final

_TOKEN: Final = re.compile(r"(?P<kind>[a-z]+)_(?P<prefix>[0-9a-f]{8})_(?P<secret>[A-Za-z0-9-]{43})")
SCHEME: Final = "bearer "


@dataclass(frozen=True)
class NewToken:
    """Its `text` is shown once and never again."""

    prefix: str
    text: str
    secret_hash: str


@dataclass(frozen=True)
class ShownToken:
    """A token as a request shows it."""

    prefix: str
    secret: str

    def fits(self, secret_hash: str) -> bool:
        return hmac.compare_digest(secret_hash, _hash(self.secret))


def make_token(kind: str) -> NewToken:
    """256 random bits behind a prefix of 32."""
    prefix, secret = secrets.token_hex(4), secrets.token_urlsafe(32).replace("_", "-")
    return NewToken(prefix, f"{kind}_{prefix}_{secret}", _hash(secret))


def is_bearer(authorization: str) -> bool:
    """Tell if an Authorization header carries a token, of whichever kind."""
    return authorization[: len(SCHEME)].lower() == SCHEME


def read_token(kind: str, authorization: str) -> ShownToken | None:
    """The token of this kind in an Authorization header, if there is one."""
    match = _TOKEN.fullmatch(authorization[len(SCHEME) :]) if is_bearer(authorization) else None
    return ShownToken(match["prefix"], match["secret"]) if match and match["kind"] == kind else None


def _hash(secret: str) -> str:
    # A plain hash is enough for 256 random bits: there is nothing to guess.
    return sha256(secret.encode()).hexdigest()
