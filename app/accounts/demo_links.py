"""Demonstrations only: links, printed in their terminal, that open a page as one of their people.

No other service has this route (`app.composition` adds it where there is a demonstration's door, and the settings
bind that to this machine), and only who can read the demonstration's server key can make a link.
"""

import hmac
from base64 import urlsafe_b64encode
from typing import Annotated, Final, Literal, get_args

from fastapi import APIRouter, Query, Request
from fastapi.responses import RedirectResponse

from app.accounts.current_user import SESSION_COOKIE
from app.accounts.sessions.cookies import set_cookie
from app.accounts.sessions.same_origin import LOOPBACK
from app.accounts.sign_in.routes import DeskDep, Language, UserAgent
from app.accounts.sign_in.service import language_from
from app.core.database.database import DatabaseDep
from app.core.errors import NotFound
from app.core.server_key import ServerKey
from app.core.settings import ClockDep, SettingsDep

Page = Literal["order", "mail", "mailroom", "robots"]
ADDRESSES: Final[dict[Page, str]] = {page: f"/{page}.html" for page in get_args(Page)} | {"order": "/"}

router = APIRouter(include_in_schema=False)


class NoSuchLink(NotFound):
    """The link was not made for this demonstration, or is used from another machine."""

    code = "no_such_link"


def link_path(key: ServerKey, email: str, page: Page) -> str:
    """Return the path and query of the link that opens `page` as the person with this address."""
    return f"/demo/{page}?who={email}&key={_proof(key, email)}"


def _proof(key: ServerKey, email: str) -> str:
    return urlsafe_b64encode(key.derive("demo link", email)[:18]).decode()


@router.get("/demo/{page}")
async def open_as(
    *,
    page: Page,
    who: Annotated[str, Query(max_length=254)],
    key: Annotated[str, Query(max_length=100)],
    request: Request,
    desk: DeskDep,
    database: DatabaseDep,
    clock: ClockDep,
    settings: SettingsDep,
    accept_language: Language = "",
    user_agent: UserAgent = "",
) -> RedirectResponse:
    """Sign this browser in as `who`, and go to the page."""
    if not _is_this_machine(request) or not hmac.compare_digest(_proof(desk.key, who).encode(), key.encode()):
        raise NoSuchLink("This link is not one of this demonstration: take one that its terminal shows.")
    async with database.transaction() as session:
        language = language_from(accept_language, settings.default_language)
        person = await desk.newcomer(session, who, language, clock.utc())
        token = desk.open_session(session, person, user_agent, clock.utc())
    answer = RedirectResponse(ADDRESSES[page], 303, {"Cache-Control": "no-store"})
    set_cookie(request, answer, SESSION_COOKIE, token, round(settings.session_lifetime_s))
    return answer


def _is_this_machine(request: Request) -> bool:
    """Both ends: whom a proxy speaks for counts as the client, and no foreign name may lead here."""
    return request.client is not None and {request.client.host, request.url.hostname} <= LOOPBACK
