"""The signed-in person as an argument: `async def my_route(user: CurrentUser)`."""

from collections.abc import Awaitable, Callable
from typing import Annotated

from fastapi import Depends, Request, Security
from fastapi.security import APIKeyCookie

from app.database import Database, DatabaseDep
from app.errors import NotSignedIn
from app.people.errors import RoleNeeded
from app.people.same_origin import require_https_or_loopback, require_same_origin
from app.people.service import person_of_session
from app.settings import ClockDep
from app.tables import Person, Role
from protocol.clock import Clock

StillSignedIn = Callable[[Person], Awaitable[bool]]
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
    person = await _person(database, token, clock)
    if person is None:
        raise NotSignedIn("This session has ended. Sign in again.")
    require_same_origin(request)
    return person


async def _person(database: Database, token: str, clock: Clock) -> Person | None:
    # A short look of its own, so that an event stream holds no session and a writer no lock while it waits.
    async with database.reading() as session:
        return await person_of_session(session, token, clock.utc())


def _still_signed_in(request: Request, database: DatabaseDep, clock: ClockDep) -> StillSignedIn:
    """Whether the session of this request goes on, and with it what its person may see."""

    async def ask(user: Person) -> bool:
        person = await _person(database, request.cookies[cookie_name(request)], clock)
        return person is not None and person.roles == user.roles

    return ask


CurrentUser = Annotated[Person, Depends(_current_user)]


def require_role(role: Role) -> Callable[..., Awaitable[Person]]:
    """A dependency: the signed-in person, if they have this role. Raises RoleNeeded."""

    async def having_role(user: CurrentUser) -> Person:
        if not user.has_role(role):
            raise RoleNeeded(f"This is for people with the role {role}. A maintainer can give it to you.")
        return user

    return having_role


Dispatcher = Annotated[Person, Depends(require_role(Role.DISPATCHER))]
Maintainer = Annotated[Person, Depends(require_role(Role.MAINTAINER))]
StillSignedInDep = Annotated[StillSignedIn, Depends(_still_signed_in)]
