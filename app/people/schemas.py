"""What is said about people over HTTP."""

from datetime import datetime
from typing import Annotated

from pydantic import BaseModel, StringConstraints

from app.tables import Person

# The pattern of HTML's <input type=email>, with a dot in the domain.
Email = Annotated[
    str,
    StringConstraints(
        max_length=254,
        to_lower=True,
        pattern=r"^[A-Za-z0-9.!#$%&'*+/=?^_`{|}~-]+@[A-Za-z0-9](?:[A-Za-z0-9-]*[A-Za-z0-9])?(?:\.[A-Za-z0-9](?:[A-Za-z0-9-]*[A-Za-z0-9])?)+$",
    ),
]


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
    """Who is signed in."""

    id: str
    email: str
    name: str
    language: str
    roles: list[str]

    @classmethod
    def of(cls, person: Person) -> "PersonView":
        return cls(id=person.id, email=person.email, name=person.name, language=person.language, roles=person.roles)
