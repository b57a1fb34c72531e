"""The address book: those somebody exchanged mail with, newest first, and those they saved."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime

from sqlalchemy import case, func, or_
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.people.errors import UnknownContact
from app.people.search import says
from app.tables import Contact, Order, Person


@dataclass(frozen=True)
class Known:
    """Somebody that a person knows: `person` if they are known here, `saved` if they are in the book."""

    email: str
    person: Person | None
    saved: Contact | None
    last_mail_at: datetime | None


async def address_book(session: AsyncSession, person_id: str, search: str, limit: int) -> list[Known]:
    """Those with whom mail was exchanged, newest first; then the others who are saved, by label."""
    met = [Known(one.email, one, saved, at) for one, saved, at in await _met(session, person_id, search, limit)]
    emails = {known.email for known in met}
    saved = await _saved(session, person_id, search, limit)
    others = [Known(contact.email, person, contact, None) for contact, person in saved if contact.email not in emails]
    return [*met, *others][:limit]


async def _met(
    session: AsyncSession, person_id: str, search: str, limit: int
) -> Sequence[tuple[Person, Contact | None, datetime]]:
    sent, coming = col(Order.sender_id) == person_id, col(Order.recipient_id) == person_id
    other = case((sent, col(Order.recipient_id)), else_=col(Order.sender_id))
    last = func.max(Order.created_at).label("last_at")
    mail = select(other.label("person_id"), last).where(or_(sent, coming)).group_by(other).subquery()
    mine = (col(Contact.email) == col(Person.email)) & (col(Contact.person_id) == person_id)
    wanted = (
        select(Person, Contact, mail.c.last_at)
        .join(mail, mail.c.person_id == Person.id)
        .outerjoin(Contact, mine)
        .where(Person.id != person_id)
        .order_by(mail.c.last_at.desc(), col(Person.email))
        .limit(limit)
    )
    if search:
        wanted = wanted.where(says(search, Person.name, Person.email, Contact.label))
    return (await session.exec(wanted)).all()


async def _saved(
    session: AsyncSession, person_id: str, search: str, limit: int
) -> Sequence[tuple[Contact, Person | None]]:
    wanted = (
        select(Contact, Person)
        .outerjoin(Person, col(Person.email) == col(Contact.email))
        .where(Contact.person_id == person_id)
        .order_by(col(Contact.label), col(Contact.email))
        .limit(2 * limit)  # at most `limit` of them were met, and are left out here
    )
    if search:
        wanted = wanted.where(says(search, Person.name, Contact.email, Contact.label))
    return (await session.exec(wanted)).all()


async def save_contact(
    session: AsyncSession, person_id: str, email: str, label: str, post: str | None, now: datetime
) -> Known:
    """Put somebody into the book, or change what it says of them."""
    row = await session.get(Contact, (person_id, email))
    row = row or Contact(person_id=person_id, email=email, saved_at=now)
    row.label, row.post = label, post
    session.add(row)
    person = (await session.exec(select(Person).where(Person.email == email))).first()
    return Known(email, person, row, None)


async def forget_contact(session: AsyncSession, person_id: str, email: str) -> None:
    """Take somebody out of the book; mail that was exchanged stays known. Raises UnknownContact."""
    row = await session.get(Contact, (person_id, email))
    if row is None:
        raise UnknownContact(f"{email} is not in your address book.")
    await session.delete(row)
