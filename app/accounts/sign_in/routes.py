"""Signing in and out."""

from typing import Annotated

from fastapi import APIRouter, Depends, Header, Request, Response

from app.accounts.current_user import SESSION_COOKIE, AtBrowser, ThisSession
from app.accounts.errors import AddressNotAllowed, CodeExpired, WrongCode
from app.accounts.rate_limits import Door, LimitsDep, RateLimits, host_of
from app.accounts.schemas import CodeMailed, CodeRequest, PersonView, SignIn
from app.accounts.sessions.cookies import set_cookie
from app.accounts.sessions.same_origin import refuse_other_sites, require_https_or_loopback
from app.accounts.sessions.sessions import end_session
from app.accounts.sign_in.browsers import AskingBrowser, Browser, has_signed_in, per_browser, remember
from app.accounts.sign_in.service import SignInService, language_from
from app.core.database.database import Database, DatabaseDep, SessionDep
from app.core.errors import problems
from app.core.parts import part
from app.core.settings import ClockDep, SettingsDep

router = APIRouter(tags=["people"])

Language = Annotated[str, Header(alias="Accept-Language", max_length=200)]
UserAgent = Annotated[str, Header(max_length=1000)]


async def _door(request: Request) -> None:
    require_https_or_loopback(request)
    refuse_other_sites(request)


DeskDep = Annotated[SignInService, part(SignInService)]
DOOR = [Depends(_door), per_browser(Door.SIGN_IN)]


@router.post("/sign-in/codes", status_code=202, dependencies=DOOR, responses=problems(AddressNotAllowed, 429))
async def mail_code(
    *,
    wish: CodeRequest,
    request: Request,
    response: Response,
    browser: AskingBrowser,
    desk: DeskDep,
    limits: LimitsDep,
    database: DatabaseDep,
    clock: ClockDep,
    settings: SettingsDep,
    accept_language: Language = "",
) -> CodeMailed:
    """Mail an 8-digit code to an address of the campus; it is good in the browser that asks, known by a cookie."""
    await _count(request, wish.email, browser, limits, database)
    language = language_from(accept_language, settings.default_language)
    async with database.transaction() as session:
        row, code = await desk.make_code(session, wish.email, clock.utc(), browser.secret)
    await desk.mail_code(row, code, language)
    remember(request, response, browser)
    return CodeMailed(expires_at=row.expires_at)


async def _count(request: Request, email: str, browser: Browser, limits: RateLimits, database: Database) -> None:
    """Strangers are counted together as well; a browser that has signed in here before is not kept out by them."""
    await limits.count(Door.CODES, f"{email} {browser.secret}")
    async with database.asking() as connection:
        is_known = await has_signed_in(connection, email, browser.secret)
    if not is_known:
        await limits.count(Door.CODES_OF_HOST, f"{email} {host_of(request)}")
        await limits.count(Door.CODES_OF_NEW_BROWSERS, email)


@router.post("/sign-in", dependencies=DOOR, responses=problems(WrongCode, CodeExpired, 429))
async def sign_in(
    *,
    wish: SignIn,
    request: Request,
    response: Response,
    browser: AskingBrowser,
    desk: DeskDep,
    database: DatabaseDep,
    clock: ClockDep,
    settings: SettingsDep,
    accept_language: Language = "",
    user_agent: UserAgent = "",
) -> PersonView:
    """Exchange the mailed code for a session cookie, in the browser that asked for it."""
    async with database.transaction() as session:
        refusal = await desk.check_code(session, wish.email, wish.code, clock.utc(), browser.secret)
    if refusal:
        raise refusal
    async with database.transaction() as session:
        language = language_from(accept_language, settings.default_language)
        person = await desk.newcomer(session, wish.email, language, clock.utc())
        token = desk.open_session(session, person, user_agent, clock.utc(), browser.secret)
    # Browsers count real seconds; a session that ends sooner is refused here.
    set_cookie(request, response, SESSION_COOKIE, token, round(settings.session_lifetime_s))
    remember(request, response, browser, has_signed_in=True)
    return PersonView.of(person)


@router.delete("/session", status_code=204)
async def sign_out(
    *,
    user: AtBrowser,
    this: ThisSession,
    request: Request,
    response: Response,
    session: SessionDep,
    clock: ClockDep,
) -> None:
    """End this session."""
    await end_session(session, user.id, this, clock.utc())
    set_cookie(request, response, SESSION_COOKIE, "", 0)
