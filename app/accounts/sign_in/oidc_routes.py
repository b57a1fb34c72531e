"""To the campus's own sign-in and back. Both are followed by a browser: what goes wrong is told on our first page."""

import hmac
from typing import Annotated
from urllib.parse import urlencode

from fastapi import APIRouter, Depends, Query, Request
from fastapi.responses import RedirectResponse

from app.accounts.current_user import SESSION_COOKIE
from app.accounts.errors import NoCampusSignIn, OidcRefused, WrongState
from app.accounts.rate_limits import Door
from app.accounts.sessions.cookies import read_cookie, set_cookie
from app.accounts.sessions.same_origin import require_https_or_loopback
from app.accounts.sign_in.browsers import AskingBrowser, per_browser, remember
from app.accounts.sign_in.oidc import LIFETIME, Attempt, Provider, person_of
from app.accounts.sign_in.routes import DeskDep, Language, UserAgent
from app.accounts.sign_in.service import language_from
from app.core.database.database import DatabaseDep
from app.core.errors import ServiceError, problems
from app.core.parts import find_part
from app.core.settings import ClockDep, Settings, SettingsDep

ATTEMPT_COOKIE = "oidc"
CALLBACK = "/api/v1/sign-in/oidc/callback"
HOME = "/"

router = APIRouter(
    tags=["people"],
    dependencies=[Depends(require_https_or_loopback), per_browser(Door.SIGN_IN)],
    responses=problems(NoCampusSignIn, 429),
)


async def _provider(request: Request) -> Provider:
    provider = find_part(request, Provider)
    if not provider.is_configured:
        raise NoCampusSignIn("Sign in by a mailed code: the campus's own sign-in is not set up here.")
    return provider


ProviderDep = Annotated[Provider, Depends(_provider)]
Said = Annotated[str, Query(max_length=2000)]


@router.get("/sign-in/oidc", status_code=303, response_class=RedirectResponse)
async def sign_in_at_the_campus(
    request: Request, provider: ProviderDep, settings: SettingsDep, clock: ClockDep
) -> RedirectResponse:
    """Go to the campus's own sign-in."""
    attempt = Attempt.begin(provider.key, clock.utc())
    try:
        answer = _to(await provider.address_to_ask(attempt, _callback(request, settings)))
    except ServiceError as error:
        return _refused(error)
    set_cookie(request, answer, ATTEMPT_COOKIE, attempt.cookie, round(LIFETIME.total_seconds()))
    return answer


@router.get("/sign-in/oidc/callback", status_code=303, response_class=RedirectResponse)
async def come_back_from_the_campus(
    *,
    request: Request,
    browser: AskingBrowser,
    provider: ProviderDep,
    desk: DeskDep,
    database: DatabaseDep,
    clock: ClockDep,
    settings: SettingsDep,
    state: Said = "",
    code: Said = "",
    error: Said = "",
    accept_language: Language = "",
    user_agent: UserAgent = "",
) -> RedirectResponse:
    """Come back from there, with a session or with `sign_in_problem`."""
    language = language_from(accept_language, settings.default_language)
    try:
        attempt = Attempt.of_cookie(provider.key, read_cookie(request, ATTEMPT_COOKIE), clock.utc())
        _require_answer(attempt, state, code, error)
        claims = await provider.claims(attempt, code, _callback(request, settings))
        async with database.transaction() as session:
            person = await person_of(session, desk, claims, language, clock.utc())
            token = desk.open_session(session, person, user_agent, clock.utc(), browser.secret)
    except ServiceError as refusal:
        answer = _refused(refusal)
    else:
        answer = _to(HOME)
        set_cookie(request, answer, SESSION_COOKIE, token, round(settings.session_lifetime_s))
        remember(request, answer, browser, has_signed_in=True)
    set_cookie(request, answer, ATTEMPT_COOKIE, "", 0)
    return answer


def _require_answer(attempt: Attempt, state: str, code: str, error: str) -> None:
    """Raises WrongState, OidcRefused."""
    if not hmac.compare_digest(attempt.state.encode(), state.encode()):
        raise WrongState("This sign-in began elsewhere. Begin again.")
    if error or not code:
        raise OidcRefused("The campus's sign-in did not let you in.")


def _callback(request: Request, settings: Settings) -> str:
    return f"{(settings.public_url or str(request.base_url)).rstrip('/')}{CALLBACK}"


def _to(address: str) -> RedirectResponse:
    return RedirectResponse(address, 303, {"Cache-Control": "no-store"})


def _refused(error: ServiceError) -> RedirectResponse:
    return _to(f"{HOME}?{urlencode({'sign_in_problem': error.code})}")
