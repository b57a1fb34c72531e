"""Scripts sign in with `cmp_<prefix>_<secret>`: for some of what their person may do, for some time."""

from collections.abc import Iterable
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Final

from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession
from sqlmodel.sql.expression import SelectOfScalar

from app.accounts.errors import UnknownToken
from app.accounts.scopes import narrowed
from app.core.bearer_tokens import make_token, read_token
from app.models import Person, PersonToken

KIND: Final = "cmp"


@dataclass(frozen=True)
class Script:
    """A token that was good. `person` is whose it is, with no more roles than its scopes leave."""

    person: Person
    token: PersonToken


async def find_script(session: AsyncSession, authorization: str, now: datetime) -> Script | None:
    """Return the script of this Authorization header; None if the token is refused."""
    shown = read_token(KIND, authorization)
    row = await session.get(PersonToken, shown.prefix) if shown else None
    if shown is None or row is None or row.revoked_at or row.expires_at <= now or not shown.fits(row.secret_hash):
        return None
    person = await session.get_one(Person, row.person_id)
    # A copy: roles in the database are not narrowed by what a script may do.
    return Script(Person(**{**person.model_dump(), "roles": narrowed(person.roles, row.scopes)}), row)


async def issue_token(
    session: AsyncSession, person: Person, name: str, scopes: Iterable[str], lifetime: timedelta, now: datetime
) -> tuple[PersonToken, str]:
    """A new token and its text, which is shown once."""
    new = make_token(KIND)
    row = PersonToken(
        prefix=new.prefix,
        secret_hash=new.secret_hash,
        person_id=person.id,
        name=name,
        scopes=sorted(str(scope) for scope in scopes),
        created_at=now,
        expires_at=now + lifetime,
    )
    session.add(row)
    await session.flush()
    return row, new.text


def good_tokens(person_id: str, now: datetime) -> SelectOfScalar[PersonToken]:
    """The tokens of a person that still open something."""
    return select(PersonToken).where(
        PersonToken.person_id == person_id, col(PersonToken.revoked_at).is_(None), PersonToken.expires_at > now
    )


async def revoke_token(session: AsyncSession, person_id: str, prefix: str, now: datetime) -> None:
    """It opens nothing from now on. Raises UnknownToken, for another's too."""
    row = await session.get(PersonToken, prefix)
    if row is None or row.person_id != person_id or row.revoked_at:
        raise UnknownToken(f"There is no token {prefix} among yours.")
    row.revoked_at = now
