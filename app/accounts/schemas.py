"""People over HTTP."""

import re
from datetime import datetime
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

from app.accounts.contacts import Known
from app.accounts.scopes import Scope
from app.core.paging import PageOf
from app.core.text_lines import Label, Name
from app.models import Person, PersonSession, PersonToken, Role
from protocol.one_line import ONE_LINE

# The pattern of HTML's <input type=email>, with a dot in the domain, and without what sends mail elsewhere: `=?…?=`
# is decoded in headers (to another address, say), `%` and `!` are routes to old mail servers.
EMAIL = re.compile(
    r"^[A-Za-z0-9.#$&'*+/=^_`{|}~-]+@[A-Za-z0-9](?:[A-Za-z0-9-]*[A-Za-z0-9])?(?:\.[A-Za-z0-9](?:[A-Za-z0-9-]*[A-Za-z0-9])?)+$"
)
MAX_EMAIL = 254
Email = Annotated[str, StringConstraints(max_length=MAX_EMAIL, to_lower=True, pattern=EMAIL.pattern)]


class CodeRequest(BaseModel):
    """Mail me a code."""

    email: Email


class CodeMailed(BaseModel):
    """Until when the mailed code is good."""

    expires_at: datetime


class SignIn(BaseModel):
    """The code from the mail."""

    email: Email
    code: Annotated[str, StringConstraints(pattern=r"^[0-9]{8}$")]


class PersonView(BaseModel):
    """A person: oneself, or a person of the campus as dispatchers and maintainers see them."""

    id: str
    email: str
    name: str
    language: str
    usual_post: str | None
    roles: list[Role]

    @classmethod
    def of(cls, person: Person) -> "PersonView":
        return cls.model_validate(person, from_attributes=True)


class MyView(PersonView):
    """Oneself, with what every page shows of it."""

    unread_notices: int


class PeoplePage(PageOf[PersonView]):
    """Some people, by mail address."""


def _without_defaults(schema: dict[str, Any]) -> None:
    """Take out the defaults: what is absent is not changed."""
    for kind in schema["properties"].values():
        kind.pop("default", None)


class AboutMe(BaseModel):
    """Changes of one's own account; what is absent stays as it is."""

    model_config = ConfigDict(extra="forbid", json_schema_extra=_without_defaults)

    name: Name = ""
    language: Literal["en", "fr"] = "en"
    usual_post: Annotated[str, StringConstraints(max_length=64, pattern=ONE_LINE)] | None = None


class SessionView(BaseModel):
    """A session of a person; `seen_at` is some minutes behind."""

    id: int
    device: str = Field(description="Browser and system in words, such as `Firefox, Windows`; empty if unknown.")
    created_at: datetime
    seen_at: datetime | None
    expires_at: datetime
    current: bool = Field(description="The session of this very request.")

    @classmethod
    def of(cls, row: PersonSession, current: int) -> "SessionView":
        return cls.model_validate({**row.model_dump(), "current": row.id == current})


class SessionPage(PageOf[SessionView]):
    """Some sessions, newest first."""


class TokenRequest(BaseModel):
    """A token for a script of mine."""

    model_config = ConfigDict(extra="forbid")

    name: Name
    scopes: list[Scope] = Field(min_length=1, max_length=len(Scope))
    days: int = Field(90, ge=1, le=366, description="For how many days it is to be good.")


class TokenView(BaseModel):
    """A token without its secret."""

    prefix: str
    name: str
    scopes: list[Scope]
    created_at: datetime
    expires_at: datetime
    used_at: datetime | None

    @classmethod
    def of(cls, row: PersonToken) -> "TokenView":
        return cls.model_validate(row, from_attributes=True)


class NewTokenView(TokenView):
    """A token as it is made: the only time that its `token` is shown."""

    token: str


class TokenPage(PageOf[TokenView]):
    """Some tokens that still open something, newest first."""


class ContactRequest(BaseModel):
    """The entry that the address book is to have of a contact."""

    model_config = ConfigDict(extra="forbid")

    label: Label = ""
    post: Annotated[str, StringConstraints(max_length=64, pattern=ONE_LINE)] | None = None


class ContactView(BaseModel):
    """A contact. `post` is the saved one, else the one they call their usual post."""

    email: str
    name: str
    label: str
    post: str | None
    saved: bool
    last_mail_at: datetime | None

    @classmethod
    def of(cls, known: Known) -> "ContactView":
        usual = known.person.usual_post if known.person else None
        return cls(
            email=known.email,
            name=known.person.name if known.person else "",
            label=known.saved.label if known.saved else "",
            post=(known.saved.post if known.saved else None) or usual,
            saved=known.saved is not None,
            last_mail_at=known.last_mail_at,
        )


class AddressBook(PageOf[ContactView]):
    """Those with whom mail was exchanged, newest first; then the others who are saved, by label."""
