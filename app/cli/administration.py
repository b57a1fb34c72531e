"""Work of the command line: each function is one transaction on the database, running service or not."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from datetime import datetime

from sqlmodel.ext.asyncio.session import AsyncSession

from app.accounts.schemas import EMAIL
from app.accounts.sign_in.service import find_person, is_allowed, make_person, set_roles
from app.core.database.database import Database
from app.core.database.schema_version import bring_to_head
from app.core.errors import StartError
from app.core.server_key import open_server_key
from app.core.settings import Settings, make_data_folder, open_clock, open_map
from app.models import Person, Role
from app.robots import service as fleet
from app.robots.enrolment.service import EnrolmentService


class UnknownRole(StartError):
    """There is no role of this name."""


class CannotSignIn(StartError):
    """A new person was to have a role, with an address that cannot sign in."""

    def __init__(self, email: str, domains: tuple[str, ...]) -> None:
        super().__init__(
            f"{email} could not sign in: addresses of {', '.join(domains)} can. "
            "Correct it, or set CAMPUS_MAIL_ALLOWED_DOMAINS."
        )


@asynccontextmanager
async def database_at_head(settings: Settings) -> AsyncIterator[AsyncSession]:
    """A transaction on the database, whose schema is brought up to date first. Raises NewerDatabase."""
    make_data_folder(settings)
    database = Database(settings.url_of_database)
    try:
        await bring_to_head(database)
        async with database.transaction() as session:
            yield session
    finally:
        await database.close()


async def migrate(settings: Settings) -> None:
    """Bring the schema up to date and do nothing else."""
    async with database_at_head(settings):
        pass


async def change_roles(settings: Settings, email: str, add: list[str], remove: list[str]) -> list[str]:
    """Give and take roles; return the roles afterwards. A new person is made. Raises UnknownRole, CannotSignIn."""
    given, taken = _roles(add), _roles(remove)
    async with database_at_head(settings) as session:
        person = await find_person(session, email.lower()) or _newcomer(settings, email.lower())
        set_roles(person, given, taken)
        session.add(person)
        return person.roles


def _newcomer(settings: Settings, email: str) -> Person:
    if not EMAIL.fullmatch(email) or not is_allowed(email, settings):
        raise CannotSignIn(email, settings.allowed_domains)
    return make_person(email, settings.default_language, open_clock(settings).utc())


def _roles(names: list[str]) -> set[Role]:
    try:
        return {Role(name) for name in names}
    except ValueError as error:
        raise UnknownRole(f"{error}. There are: {', '.join(Role)}.") from None


async def make_enrolment_code(settings: Settings, name: str) -> tuple[str, datetime]:
    """A one-time code for a robot of this name, and until when it is good. Raises RobotNameInvalid."""
    async with database_at_head(settings) as session:
        desk = EnrolmentService(
            settings, open_map(settings), open_server_key(settings.server_key_path), open_clock(settings)
        )
        row, code = await desk.make_code(session, name)
        return code, row.expires_at


async def enrol(settings: Settings, name: str, again: bool) -> str:
    """Make a robot known, or give it a new token; the token, which is shown once. Its receipts will be unsigned."""
    clock = open_clock(settings)
    async with database_at_head(settings) as session:
        token = await (fleet.new_token if again else fleet.enrol)(session, clock, name)
        (await fleet.known_robot(session, name)).public_key = None
        return token


async def revoke(settings: Settings, name: str, prefix: str | None = None) -> int:
    """Make all tokens of a robot worthless, or the one with this prefix; how many that were. Raises UnknownRobot."""
    clock = open_clock(settings)
    async with database_at_head(settings) as session:
        return await fleet.revoke_tokens(session, clock, name, prefix)
