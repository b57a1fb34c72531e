"""Signing in and out. Codes and sessions are known here by their hashes alone."""

import hmac
import re
import secrets
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Final

from sqlalchemy import bindparam
from sqlalchemy import select as sa_select
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.accounts.errors import AddressNotAllowed, CodeExpired, WrongCode
from app.accounts.sessions.sessions import hash_of, new_session
from app.core.database.database import columns_of, connection_of, row_of
from app.core.mail import Mail, Mailer
from app.core.server_key import ServerKey
from app.core.settings import Settings
from app.core.text_lines import LONGEST_NAME
from app.core.texts import LANGUAGES, text
from app.models import Person, PersonSession, Role, SignInCode
from protocol.ids import new_id

CODES_THAT_COUNT: Final = 3


def is_allowed(email: str, settings: Settings) -> bool:
    """Tell if a person with this address may have an account."""
    return email.rpartition("@")[2] in settings.allowed_domains


def may_be_sent_mail(email: str, settings: Settings) -> bool:
    """Tell if a new address may be an order's recipient."""
    return settings.allow_outside_recipients or is_allowed(email, settings)


def name_from(email: str) -> str:
    """`ada.king@…` is presumably Ada King."""
    words = re.split(r"[._+-]+", email.partition("@")[0])
    return (" ".join(word.capitalize() for word in words if word) or email)[:LONGEST_NAME].rstrip()


@dataclass(frozen=True)
class SignInService:
    """Mails codes and opens sessions."""

    settings: Settings
    key: ServerKey
    mailer: Mailer

    async def make_code(
        self, session: AsyncSession, email: str, now: datetime, browser: str = ""
    ) -> tuple[SignInCode, str]:
        """A new code for this browser, and its eight digits, which are kept as a hash. Raises AddressNotAllowed."""
        if not is_allowed(email, self.settings):
            domains = ", ".join(self.settings.allowed_domains)
            raise AddressNotAllowed(f"Sign in with an address of {domains}.")
        code = f"{secrets.randbelow(10**8):08d}"
        lifetime = timedelta(seconds=self.settings.sign_in_code_lifetime_s)
        row = SignInCode(
            email=email,
            browser_hash=hash_of(browser),
            code_hash=self._hash(email, code),
            created_at=now,
            expires_at=now + lifetime,
        )
        session.add(row)
        await session.flush()
        return row, code

    async def mail_code(self, row: SignInCode, code: str, language: str) -> None:
        """Mail a code whose row is committed: a mailed code is one that works."""
        facts = {"code": code, "minutes": str(round(self.settings.sign_in_code_lifetime_s / 60))}
        subject, body = text(language, "email.sign_in.title"), text(language, "email.sign_in.body", facts)
        mail = Mail(f"sign-in.{row.id}.{new_id()}", row.email, subject, body, row.created_at)
        await self.mailer.send_soon(mail)

    async def check_code(
        self, session: AsyncSession, email: str, code: str, now: datetime, browser: str
    ) -> WrongCode | CodeExpired | None:
        """Use up the codes of this browser, or a try of each. Errors are returned, not raised: tries are committed."""
        good = [row for row in await self._newest(session, email, browser) if row.is_good(now)]
        if not good:
            return CodeExpired("This browser has asked for no code that is still good. Ask for a new one.")
        shown = self._hash(email, code)
        if not any(hmac.compare_digest(row.code_hash, shown) for row in good):
            for row in good:
                row.tries_left -= 1
            return WrongCode(f"That is not the code. {max(row.tries_left for row in good)} tries are left.")
        for row in good:
            row.used_at = now
        return None

    async def _newest(self, session: AsyncSession, email: str, browser: str) -> Sequence[SignInCode]:
        """Those that count: mails overtake each other, and an older one may be open when a newer code is asked for."""
        asked = select(SignInCode).where(SignInCode.email == email, SignInCode.browser_hash == hash_of(browser))
        newest = asked.order_by(col(SignInCode.id).desc()).limit(CODES_THAT_COUNT)
        return (await session.exec(newest.with_for_update())).all()

    async def newcomer(self, session: AsyncSession, email: str, language: str, now: datetime) -> Person:
        """Return the person who signs in with this address, made at their first sign-in.

        A person who was only sent something so far was given the default language; what their browser speaks is nearer.
        """
        person = await self.person(session, email, now, language)
        if not await _has_signed_in(session, person):
            person.language = language
        return person

    def open_session(
        self, session: AsyncSession, person: Person, user_agent: str, now: datetime, browser: str = ""
    ) -> str:
        """The secret of a new session, for the cookie alone."""
        row, token = new_session(person, user_agent, self.settings.session_lifetime_s, now, browser)
        session.add(row)
        return token

    async def person(self, session: AsyncSession, email: str, now: datetime, language: str | None = None) -> Person:
        """Return the person with this address; a new row if there is none yet."""
        person = await find_person(session, email)
        if person is None:
            person = make_person(email, language or self.settings.default_language, now)
            session.add(person)
            await session.flush()
        return person

    def _hash(self, email: str, code: str) -> str:
        # Keyed: eight digits alone are found by trying them all.
        return self.key.derive("sign-in", email, code).hex()


def make_person(email: str, language: str, now: datetime) -> Person:
    """A new person, as a member."""
    return Person(id=new_id(), email=email, name=name_from(email), language=language, created_at=now)


async def find_person(session: AsyncSession, email: str) -> Person | None:
    """Return the person with this address (lower case), if there is one."""
    return (await session.exec(_WITH_ADDRESS, params={"address": email})).first()


_WITH_ADDRESS: Final = select(Person).where(col(Person.email) == bindparam("address"))
"""Put together once: that takes longer than asking."""


async def look_up_people(session: AsyncSession, emails: Collection[str]) -> dict[str, Person]:
    """The same for several, to look at only: the session does not know these rows, and takes three times as long."""
    rows = await (await connection_of(session)).execute(_ROWS_WITH_ADDRESS, {"addresses": list(emails)})
    return {row.email: row_of(Person, row._asdict()) for row in rows}


_ROWS_WITH_ADDRESS: Final = sa_select(*columns_of(Person)).where(
    col(Person.email).in_(bindparam("addresses", expanding=True))
)


async def _has_signed_in(session: AsyncSession, person: Person) -> bool:
    theirs = select(PersonSession.id).where(PersonSession.person_id == person.id).limit(1)
    return (await session.exec(theirs)).first() is not None


def set_roles(person: Person, add: set[Role], remove: set[Role]) -> None:
    """Give and take roles; everybody stays a member."""
    roles = ({Role(role) for role in person.roles} | add) - remove | {Role.MEMBER}
    person.roles = sorted(str(role) for role in roles)


def language_from(accept_language: str, default: str) -> str:
    """The first language of the browser that we speak."""
    for wish in accept_language.split(","):
        if (language := wish.strip()[:2].lower()) in LANGUAGES:
            return language
    return default
