"""The browser that asks for a sign-in code, known by a cookie of its own from then on.

Anybody may ask for a code for anybody's address. A code opens a session only in the browser that asked for it, so that
another one can neither replace it nor use up its tries.
"""

import re
import secrets
from typing import Annotated, Final

from fastapi import Depends, Request, Response
from sqlalchemy.ext.asyncio import AsyncConnection
from sqlmodel import col, select

from app.people.cookies import read_cookie, set_cookie
from app.people.sessions import hash_of
from app.tables import Person, PersonSession

COOKIE: Final = "browser"
LIFETIME_S: Final = 180 * 86400
OURS: Final = re.compile(r"[A-Za-z0-9_-]{43}")


async def _browser(request: Request) -> str:
    brought = read_cookie(request, COOKIE)
    return brought if OURS.fullmatch(brought) else secrets.token_urlsafe(32)


AskingBrowser = Annotated[str, Depends(_browser)]
"""The secret of the browser's cookie; a new one if it brought none."""


def remember(request: Request, response: Response, browser: str) -> None:
    """Keep the cookie for longer than a session, so that whoever signs in again is known."""
    set_cookie(request, response, COOKIE, browser, LIFETIME_S)


async def has_signed_in(connection: AsyncConnection, email: str, browser: str) -> bool:
    """Whether this browser had a session of this person, as long as ended sessions are kept."""
    theirs = select(PersonSession.id).where(
        PersonSession.person_id == Person.id,
        PersonSession.browser_hash == hash_of(browser),
        col(Person.email) == email,
    )
    return (await connection.execute(theirs.limit(1))).first() is not None
