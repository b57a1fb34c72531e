"""The caller, as an argument: `async def my_route(user: CurrentUser)`.

`CurrentUser`: a person at a browser (cookie) or one of their scripts (token), each as far as they may.
`Dispatcher`, `Maintainer`: the same, with that role. `AtBrowser`: at a browser, because no script may do this.
"""

from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from typing import Annotated

from fastapi import Depends, Request, Security
from fastapi.security import APIKeyCookie, HTTPBearer

from app.accounts.errors import NotForScripts, RoleNeeded, ScopeNeeded
from app.accounts.last_seen import LastSeen
from app.accounts.scopes import opened_by
from app.accounts.sessions.cookies import read_cookie
from app.accounts.sessions.same_origin import require_https_or_loopback, require_same_origin
from app.accounts.sessions.sessions import find_session, is_stale
from app.accounts.tokens import find_script
from app.core.bearer_tokens import is_bearer
from app.core.database.database import Database, DatabaseDep
from app.core.errors import NotSignedIn
from app.core.parts import find_part
from app.core.settings import ClockDep
from app.models import Person, Role
from protocol.clock import Clock

StillSignedIn = Callable[[Person], Awaitable[bool]]
SESSION_COOKIE = "session"

_cookie_documented = APIKeyCookie(
    scheme_name="session",
    name=SESSION_COOKIE,
    auto_error=False,
    description="From `POST /sign-in`; on https `__Host-session`. Changes need `Sec-Fetch-Site` or `Origin` too.",
)
_token_documented = HTTPBearer(
    scheme_name="token", bearerFormat="cmp_…", auto_error=False, description="A script's token, from `POST /tokens`."
)


@dataclass(frozen=True)
class Caller:
    """The caller of a request. `session_id` is the browser's session; a script has `scopes` instead."""

    person: Person
    session_id: int | None = None
    scopes: frozenset[str] = frozenset()


async def _caller(request: Request, cookie: Annotated[object, Security(_cookie_documented)]) -> Caller:
    require_https_or_loopback(request)
    # Not as dependencies of their own: this one is solved for every request.
    caller = await _find_caller(request, find_part(request, Database), find_part(request, Clock))
    if caller.session_id is not None:  # a token travels only where a program of ours puts it
        require_same_origin(request)
    return caller


async def _find_caller(request: Request, database: Database, clock: Clock) -> Caller:
    """Raises NotSignedIn."""
    last_seen = find_part(request, LastSeen)
    authorization = request.headers.get("Authorization", "")
    if is_bearer(authorization):
        return await _script(authorization, database, last_seen, clock)
    token = read_cookie(request, SESSION_COOKIE)
    if not token:
        raise NotSignedIn("Sign in first.")
    return await _browser(token, database, last_seen, clock)


async def _browser(token: str, database: Database, last_seen: LastSeen, clock: Clock) -> Caller:
    now = clock.utc()
    # A short look of its own, so that an event stream holds no session and a writer no lock while it waits.
    async with database.asking() as connection:
        found = await find_session(connection, token, now)
    if found is None:
        raise NotSignedIn("This session has ended. Sign in again.")
    if is_stale(found.seen_at, now):
        last_seen.note_session(found.id, now)
    return Caller(found.person, session_id=found.id)


async def _script(authorization: str, database: Database, last_seen: LastSeen, clock: Clock) -> Caller:
    now = clock.utc()
    async with database.reading() as session:
        found = await find_script(session, authorization, now)
    if found is None:
        invalid = {"WWW-Authenticate": 'Bearer error="invalid_token"'}
        raise NotSignedIn("This token is unknown, revoked or too old. Make a new one.", invalid)
    if is_stale(found.token.used_at, now):
        last_seen.note_token(found.token.prefix, now)
    return Caller(found.person, scopes=frozenset(found.token.scopes))


CallerDep = Annotated[Caller, Depends(_caller)]


async def _current_user(
    request: Request, caller: CallerDep, token: Annotated[object, Security(_token_documented)]
) -> Person:
    """The only one that documents the token: what asks for `AtBrowser` is not offered to scripts."""
    if caller.session_id is None:
        _require_scope(request, caller.scopes)
    return caller.person


def _require_scope(request: Request, held: frozenset[str]) -> None:
    wanted = opened_by(request.scope["route"].tags, request.method)
    if not wanted:
        raise NotForScripts("No token opens this. Sign in at a browser.")
    if wanted.isdisjoint(held):
        raise ScopeNeeded(f"This takes a token with the scope {' or '.join(sorted(wanted))}.")


async def _session_id(caller: CallerDep) -> int:
    if caller.session_id is None:
        raise NotForScripts("No token opens this. Sign in at a browser.")
    return caller.session_id


async def _at_browser(caller: CallerDep, session_id: Annotated[int, Depends(_session_id)]) -> Person:
    return caller.person


async def _still_signed_in(request: Request, database: DatabaseDep, clock: ClockDep) -> StillSignedIn:
    """Tell if the session or token of this request goes on, and with it what its person may see."""

    async def ask(user: Person) -> bool:
        try:
            caller = await _find_caller(request, database, clock)
        except NotSignedIn:
            return False
        return caller.person.roles == user.roles

    return ask


CurrentUser = Annotated[Person, Depends(_current_user)]
AtBrowser = Annotated[Person, Depends(_at_browser)]
ThisSession = Annotated[int, Depends(_session_id)]
StillSignedInDep = Annotated[StillSignedIn, Depends(_still_signed_in)]


def require_role(*roles: Role) -> Callable[..., Awaitable[Person]]:
    """A dependency: the signed-in person, if they have one of these roles. Raises RoleNeeded."""

    async def having_role(user: CurrentUser) -> Person:
        if not any(user.has_role(role) for role in roles):
            raise RoleNeeded(f"This is for people with the role {' or '.join(roles)}. A maintainer can give it to you.")
        return user

    return having_role


Dispatcher = Annotated[Person, Depends(require_role(Role.DISPATCHER))]
Maintainer = Annotated[Person, Depends(require_role(Role.MAINTAINER))]
DispatcherOrMaintainer = Annotated[Person, Depends(require_role(Role.DISPATCHER, Role.MAINTAINER))]
