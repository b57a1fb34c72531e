"""The address book: people that a person exchanged mail with, newest first, and those they saved."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any, Final

from sqlalchemy import Subquery, case, func, or_, tuple_
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.accounts.errors import UnknownContact
from app.accounts.search import says
from app.core.paging import Paging
from app.models import Contact, Order, Person

BOOK: Final = "address book"
MET: Final = "met"
SAVED: Final = "saved"


@dataclass(frozen=True)
class Known:
    """A contact of a person: `person` if they are known here, `saved` if they are in the book."""

    email: str
    person: Person | None
    saved: Contact | None
    last_mail_at: datetime | None


async def address_book(
    session: AsyncSession, person_id: str, search: str, page: Paging
) -> tuple[list[Known], str | None]:
    """Those with whom mail was exchanged, newest first; then the others who are saved, by label: one page of them, and
    the cursor of the next. Raises BadCursor."""
    which, *place = page.place(BOOK) or [MET]
    wanted, known = page.limit + 1, list[Known]()  # one more than is shown tells whether there is a next page
    if which == MET:
        known += await _met(session, person_id, search, place, wanted)
        place = []
    if len(known) < wanted:
        known += await _saved(session, person_id, search, place, wanted - len(known))
    shown = known[: page.limit]
    return shown, page.following(BOOK, _place_of(shown[-1])) if len(known) > len(shown) else None


def _place_of(known: Known) -> list[Any]:
    if known.last_mail_at is not None:
        return [MET, known.last_mail_at, known.email]
    return [SAVED, known.saved.label if known.saved else "", known.email]


def _mail_of(person_id: str) -> Subquery:
    """Whom this person exchanged mail with, and when last."""
    sent, coming = col(Order.sender_id) == person_id, col(Order.recipient_id) == person_id
    other = case((sent, col(Order.recipient_id)), else_=col(Order.sender_id))
    last = func.max(Order.created_at).label("last_at")
    return select(other.label("person_id"), last).where(or_(sent, coming)).group_by(other).subquery()


async def _met(session: AsyncSession, person_id: str, search: str, place: Sequence[Any], limit: int) -> list[Known]:
    mail = _mail_of(person_id)
    mine = (col(Contact.email) == col(Person.email)) & (col(Contact.person_id) == person_id)
    wanted = (
        select(Person, Contact, mail.c.last_at)
        .join(mail, mail.c.person_id == Person.id)
        .outerjoin(Contact, mine)
        .where(Person.id != person_id)
        .order_by(mail.c.last_at.desc(), col(Person.email).desc())
        .limit(limit)
    )
    if place:
        wanted = wanted.where(tuple_(mail.c.last_at, col(Person.email)) < tuple(place))
    if search:
        wanted = wanted.where(says(search, Person.name, Person.email, Contact.label))
    return [Known(one.email, one, saved, at) for one, saved, at in (await session.exec(wanted)).all()]


async def _saved(session: AsyncSession, person_id: str, search: str, place: Sequence[Any], limit: int) -> list[Known]:
    mail = _mail_of(person_id)
    met = select(mail.c.person_id).where(mail.c.person_id != person_id)
    wanted = (
        select(Contact, Person)
        .outerjoin(Person, col(Person.email) == col(Contact.email))
        .where(Contact.person_id == person_id, or_(col(Person.id).is_(None), col(Person.id).not_in(met)))
        .order_by(col(Contact.label), col(Contact.email))
        .limit(limit)
    )
    if place:
        wanted = wanted.where(tuple_(col(Contact.label), col(Contact.email)) > tuple(place))
    if search:
        wanted = wanted.where(says(search, Person.name, Contact.email, Contact.label))
    return [Known(contact.email, person, contact, None) for contact, person in (await session.exec(wanted)).all()]


async def save_contact(
    session: AsyncSession, person_id: str, email: str, label: str, post: str | None, now: datetime
) -> Known:
    """Put a contact into the book, or change what it says of them."""
    row = await session.get(Contact, (person_id, email))
    row = row or Contact(person_id=person_id, email=email, saved_at=now)
    row.label, row.post = label, post
    session.add(row)
    person = (await session.exec(select(Person).where(Person.email == email))).first()
    return Known(email, person, row, None)


async def forget_contact(session: AsyncSession, person_id: str, email: str) -> None:
    """Take a contact out of the book; mail that was exchanged stays known. Raises UnknownContact."""
    row = await session.get(Contact, (person_id, email))
    if row is None:
        raise UnknownContact(f"{email} is not in your address book.")
    await session.delete(row)
