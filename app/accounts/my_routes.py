"""A person's own data over HTTP: name and language, sessions, tokens of scripts."""

from datetime import timedelta
from typing import Annotated

from fastapi import APIRouter, Path, Query, Response
from sqlmodel import col

from app.accounts.contacts import address_book, forget_contact, save_contact
from app.accounts.current_user import AtBrowser, CurrentUser, ThisSession
from app.accounts.errors import NoSuchPost, UnknownContact, UnknownSession, UnknownToken
from app.accounts.rate_limits import Door, per_person_at_browser
from app.accounts.schemas import (
    AboutMe,
    AddressBook,
    ContactRequest,
    ContactView,
    Email,
    MyView,
    NewTokenView,
    PersonView,
    SessionPage,
    SessionView,
    TokenPage,
    TokenRequest,
    TokenView,
)
from app.accounts.search import SearchText
from app.accounts.sessions.sessions import end_others, end_session, open_sessions
from app.accounts.tokens import good_tokens, issue_token, revoke_token
from app.accounts.unread import unread_notices
from app.core.database.database import ReadingDep, SessionDep
from app.core.errors import problems
from app.core.paging import PAGED, BadCursor, PageDep, Sorting
from app.core.settings import CampusDep, ClockDep
from app.models import Person, PersonSession, PersonToken
from maps import CampusMap, UnknownPost

me_router = APIRouter(tags=["me"])
router = APIRouter(tags=["people"])
address_router = APIRouter(tags=["address book"])

NEWEST_SESSIONS = Sorting("sessions", col(PersonSession.id), descending=True)
NEWEST_TOKENS = Sorting("tokens", col(PersonToken.created_at), col(PersonToken.prefix), descending=True)
CHANGES = [per_person_at_browser(Door.CHANGES)]

ContactEmail = Annotated[Email, Path()]
SessionId = Annotated[int, Path(ge=1, le=2**53)]
Prefix = Annotated[str, Path(pattern=r"^[0-9a-f]{8}$")]


@me_router.get("/me")
async def who_am_i(user: CurrentUser, session: ReadingDep) -> MyView:
    """The signed-in person; of a script: whose it is, with the roles that its scopes leave."""
    unread = await unread_notices(session, user.id)
    return MyView(**PersonView.of(user).model_dump(), unread_notices=unread)


@me_router.patch("/me", dependencies=CHANGES, responses=problems(NoSuchPost, 429))
async def change_me(wish: AboutMe, user: AtBrowser, session: SessionDep, campus: CampusDep) -> PersonView:
    """Change one's name, language or usual post."""
    person = await session.get_one(Person, user.id)
    changed = wish.model_dump(include=wish.model_fields_set)
    _require_post(campus, changed.get("usual_post"))
    for name, value in changed.items():
        setattr(person, name, value)
    return PersonView.of(person)


def _require_post(campus: CampusMap, name: str | None) -> None:
    if name is None:
        return
    try:
        campus.post(name)
    except UnknownPost as error:
        raise NoSuchPost(str(error)) from None


@address_router.get("/me/contacts", responses={**PAGED, **problems(BadCursor)})
async def my_contacts(
    user: CurrentUser,
    session: ReadingDep,
    page: PageDep,
    search: Annotated[SearchText, Query(description="Part of a name, label or mail address.")] = "",
) -> AddressBook:
    """Those one exchanged mail with, newest first, and those one saved; `search` narrows it down."""
    known, following = await address_book(session, user.id, search, page)
    return AddressBook(items=[ContactView.of(one) for one in known], next=following)


@address_router.put("/me/contacts/{email}", dependencies=CHANGES, responses=problems(NoSuchPost, 429))
async def keep_contact(
    *,
    email: ContactEmail,
    wish: ContactRequest,
    user: AtBrowser,
    session: SessionDep,
    campus: CampusDep,
    clock: ClockDep,
) -> ContactView:
    """Save a contact with a label and a post, or change them."""
    _require_post(campus, wish.post)
    return ContactView.of(await save_contact(session, user.id, email, wish.label, wish.post, clock.utc()))


@address_router.delete("/me/contacts/{email}", status_code=204, responses=problems(UnknownContact))
async def drop_contact(email: ContactEmail, user: AtBrowser, session: SessionDep) -> None:
    """Forget a saved contact."""
    await forget_contact(session, user.id, email)


@router.get("/sessions", responses={**PAGED, **problems(BadCursor)})
async def my_sessions(
    user: AtBrowser, this: ThisSession, session: ReadingDep, page: PageDep, clock: ClockDep
) -> SessionPage:
    """Where this person is signed in, newest first."""
    rows, following = await page.of(session, open_sessions(user.id, clock.utc()), NEWEST_SESSIONS)
    return SessionPage(items=[SessionView.of(row, this) for row in rows], next=following)


@router.delete("/sessions", status_code=204)
async def sign_out_elsewhere(user: AtBrowser, this: ThisSession, session: SessionDep, clock: ClockDep) -> None:
    """End all of this person's sessions but this one."""
    await end_others(session, user.id, this, clock.utc())


@router.delete("/sessions/{session_id}", status_code=204, responses=problems(UnknownSession))
async def end_one_session(session_id: SessionId, user: AtBrowser, session: SessionDep, clock: ClockDep) -> None:
    """End one session, this one too."""
    await end_session(session, user.id, session_id, clock.utc())


@router.get("/tokens", responses={**PAGED, **problems(BadCursor)})
async def my_tokens(user: AtBrowser, session: ReadingDep, page: PageDep, clock: ClockDep) -> TokenPage:
    """The tokens of this person's scripts, newest first."""
    rows, following = await page.of(session, good_tokens(user.id, clock.utc()), NEWEST_TOKENS)
    return TokenPage(items=[TokenView.of(row) for row in rows], next=following)


@router.post("/tokens", status_code=201, dependencies=CHANGES, responses=problems(429))
async def make_token(
    wish: TokenRequest, user: AtBrowser, session: SessionDep, clock: ClockDep, response: Response
) -> NewTokenView:
    """Make a token for a script: `Authorization: Bearer cmp_…`. It is shown now and never again."""
    row, text = await issue_token(session, user, wish.name, set(wish.scopes), timedelta(days=wish.days), clock.utc())
    response.headers["Cache-Control"] = "no-store"
    return NewTokenView(**TokenView.of(row).model_dump(), token=text)


@router.delete("/tokens/{prefix}", status_code=204, responses=problems(UnknownToken))
async def revoke_one_token(prefix: Prefix, user: AtBrowser, session: SessionDep, clock: ClockDep) -> None:
    """Revoke one token: it opens nothing from now on."""
    await revoke_token(session, user.id, prefix, clock.utc())
