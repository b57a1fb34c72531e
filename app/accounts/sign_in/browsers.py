"""The browser that asks for a sign-in code, known by a cookie of its own from then on.

Anybody may ask for a code for anybody's address. A code opens a session only in the browser that asked for it, so that
another one can neither replace it nor use up its tries. In a browser where a person has signed in the cookie says so,
under a seal: its requests are counted by themselves, so that strangers behind the same address do not shut it out.
"""

import hmac
import re
import secrets
from base64 import urlsafe_b64encode
from dataclasses import dataclass
from typing import Annotated, Any, Final

from fastapi import Depends, Request, Response
from sqlalchemy.ext.asyncio import AsyncConnection
from sqlmodel import col, select

from app.accounts.rate_limits import Door, LimitsDep, host_of
from app.accounts.sessions.cookies import read_cookie, set_cookie
from app.accounts.sessions.sessions import hash_of
from app.core.parts import find_part
from app.core.server_key import ServerKey
from app.models import Person, PersonSession

COOKIE: Final = "browser"
LIFETIME_S: Final = 180 * 86400
OURS: Final = re.compile(r"[A-Za-z0-9_-]{43}")


@dataclass(frozen=True)
class Browser:
    """`secret` is the cookie's, a new one if it brought none; `is_known`: a person has signed in here."""

    secret: str
    is_known: bool


async def _browser(request: Request) -> Browser:
    secret, _, seal = read_cookie(request, COOKIE).partition(".")
    if not OURS.fullmatch(secret):
        return Browser(secrets.token_urlsafe(32), is_known=False)
    return Browser(secret, hmac.compare_digest(_seal(request, secret).encode(), seal.encode()))


AskingBrowser = Annotated[Browser, Depends(_browser)]


def per_browser(door: Door) -> Any:
    """For `dependencies=`: counts at this door a browser that is known, else the address that it comes from."""

    async def counted(request: Request, browser: AskingBrowser, limits: LimitsDep) -> None:
        await limits.count(door, hash_of(browser.secret) if browser.is_known else host_of(request))

    return Depends(counted)


def remember(request: Request, response: Response, browser: Browser, *, has_signed_in: bool = False) -> None:
    """Keep the cookie for longer than a session, so that a browser that signs in again is known."""
    is_known = browser.is_known or has_signed_in
    seal = f".{_seal(request, browser.secret)}" if is_known else ""
    set_cookie(request, response, COOKIE, f"{browser.secret}{seal}", LIFETIME_S)


def _seal(request: Request, secret: str) -> str:
    key = find_part(request, ServerKey)
    return urlsafe_b64encode(key.derive("browser", secret)).decode().rstrip("=")


async def has_signed_in(connection: AsyncConnection, email: str, browser: str) -> bool:
    """Tell if this browser had a session of this person, as long as ended sessions are kept."""
    theirs = select(PersonSession.id).where(
        PersonSession.person_id == Person.id,
        PersonSession.browser_hash == hash_of(browser),
        col(Person.email) == email,
    )
    return (await connection.execute(theirs.limit(1))).first() is not None
