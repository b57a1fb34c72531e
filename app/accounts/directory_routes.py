"""The people of the campus: found by dispatchers, given roles by maintainers."""

from typing import Annotated

from fastapi import APIRouter, Path, Query
from sqlmodel import col, select

from app.accounts.current_user import DispatcherOrMaintainer, Maintainer
from app.accounts.errors import LastMaintainer, RoleNeeded, UnknownPerson
from app.accounts.roles import change_role
from app.accounts.schemas import PeoplePage, PersonView
from app.accounts.search import SearchText, says
from app.core.database.database import ReadingDep, SessionDep
from app.core.errors import problems
from app.core.paging import PAGED, BadCursor, PageDep, Sorting
from app.models import Person, Role

router = APIRouter(tags=["people"])
address_router = APIRouter(tags=["address book"])

PersonId = Annotated[str, Path(pattern=r"^[A-Za-z0-9_-]{1,64}$")]
Search = Annotated[SearchText, Query(description="Part of a name or mail address.")]
BY_ADDRESS = Sorting("people", col(Person.email))


@address_router.get("/people", responses={**PAGED, **problems(BadCursor, RoleNeeded)})
async def find_people(
    user: DispatcherOrMaintainer, session: ReadingDep, page: PageDep, search: Search = ""
) -> PeoplePage:
    """Everybody, by mail address; `search` narrows it down."""
    wanted = select(Person)
    if search:
        wanted = wanted.where(says(search, Person.name, Person.email))
    rows, following = await page.of(session, wanted, BY_ADDRESS)
    return PeoplePage(items=[PersonView.of(row) for row in rows], next=following)


@router.put("/people/{person_id}/roles/{role}", responses=problems(UnknownPerson, RoleNeeded))
async def give_role(person_id: PersonId, role: Role, user: Maintainer, session: SessionDep) -> PersonView:
    """Give a person a role."""
    return PersonView.of(await change_role(session, person_id, role, give=True, by=user))


@router.delete("/people/{person_id}/roles/{role}", responses=problems(UnknownPerson, LastMaintainer, RoleNeeded))
async def take_role(person_id: PersonId, role: Role, user: Maintainer, session: SessionDep) -> PersonView:
    """Take a role from a person; everybody stays a member."""
    return PersonView.of(await change_role(session, person_id, role, give=False, by=user))
