"""What is done about people from the command line."""

from app.database import Database
from app.errors import StartError
from app.people.service import find_person, name_from, new_id, set_roles
from app.schema_version import bring_to_head
from app.settings import Settings, make_data_folder, open_clock
from app.tables import Person, Role


class UnknownRole(StartError):
    """Somebody asked for a role that there is not."""


async def change_roles(settings: Settings, email: str, add: list[str], remove: list[str]) -> list[str]:
    """Give and take roles; the roles afterwards. Raises UnknownRole."""
    given, taken = _roles(add), _roles(remove)
    make_data_folder(settings)
    database = Database(settings.url_of_database)
    try:
        await bring_to_head(database)
        async with database.transaction() as session:
            person = await find_person(session, email.lower())
            if person is None:
                now = open_clock(settings).utc()
                person = Person(
                    id=new_id(),
                    email=email.lower(),
                    name=name_from(email),
                    language=settings.default_language,
                    created_at=now,
                )
            set_roles(person, given, taken)
            session.add(person)
            return person.roles
    finally:
        await database.close()


def _roles(names: list[str]) -> set[Role]:
    try:
        return {Role(name) for name in names}
    except ValueError as error:
        raise UnknownRole(f"{error}. There are: {', '.join(Role)}.") from None
