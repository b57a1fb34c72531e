"""Roles of people. The last maintainer stays: roles can only be given by one."""

import structlog
from sqlalchemy import String, cast
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.accounts.errors import LastMaintainer, UnknownPerson
from app.accounts.sign_in.service import set_roles
from app.models import Person, Role

log = structlog.get_logger(__name__)


async def change_role(session: AsyncSession, person_id: str, role: Role, *, give: bool, by: Person) -> Person:
    """Give a person a role or take it. Raises UnknownPerson, LastMaintainer."""
    maintainers = await _maintainers(session)
    person = await session.get(Person, person_id)
    if person is None:
        raise UnknownPerson(f"No person has the id {person_id}.")
    if not give and role is Role.MAINTAINER and maintainers == {person_id}:
        raise LastMaintainer(f"{person.name} is the last maintainer. Make another person one first.")
    if person.has_role(role) is not give:
        set_roles(person, {role} if give else set(), set() if give else {role})
        log.info("role changed", person=person.id, role=str(role), given=give, by=by.id)
    return person


async def _maintainers(session: AsyncSession) -> set[str]:
    """Their ids, locked in one order: two who take each other's role at once must not both succeed."""
    those = select(Person).where(cast(Person.roles, String).contains(f'"{Role.MAINTAINER}"')).order_by(col(Person.id))
    return {person.id for person in (await session.exec(those.with_for_update())).all()}
