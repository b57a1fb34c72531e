"""The signed-in person as an argument: `async def my_route(user: CurrentUser)`."""

from typing import Annotated

from fastapi import Depends, Request, Security
from fastapi.security import APIKeyCookie

from app.database import DatabaseDep
from app.errors import NotSignedIn
from app.people.same_origin import require_https_or_loopback, require_same_origin
from app.people.service import person_of_session
from app.settings import ClockDep
from app.tables import Person

HTTPS_COOKIE = "__Host-session"
LOCAL_COOKIE = "session"

_documented = APIKeyCookie(name=LOCAL_COOKIE, auto_error=False, description=f"On https: `{HTTPS_COOKIE}`.")


def cookie_name(request: Request) -> str:
    """`__Host-` cookies exist on https alone; localhost makes do with a plain one."""
    return HTTPS_COOKIE if request.url.scheme == "https" else LOCAL_COOKIE


async def _current_user(
    request: Request, database: DatabaseDep, clock: ClockDep, cookie: Annotated[str | None, Security(_documented)]
) -> Person:
    require_https_or_loopback(request)
    token = request.cookies.get(cookie_name(request))
    if not token:
        raise NotSignedIn("Sign in first.")
    # A short look of its own, so that an event stream holds no session and a writer no lock while it waits.
    async with database.reading() as session:
        person = await person_of_session(session, token, clock.utc())
    if person is None:
        raise NotSignedIn("This session has ended. Sign in again.")
    require_same_origin(request)
    return person


CurrentUser = Annotated[Person, Depends(_current_user)]
