"""People who send, receive, dispatch or maintain; also those who have only been sent something."""

from datetime import datetime
from enum import StrEnum

from sqlalchemy import JSON
from sqlmodel import Field, SQLModel

from app.models.columns import UtcTime


class Role(StrEnum):
    """Roles: permissions beyond a person's own orders."""

    MEMBER = "member"
    DISPATCHER = "dispatcher"
    MAINTAINER = "maintainer"


class Person(SQLModel, table=True):
    """`email` is lower case and the only thing that identifies a person from outside."""

    __tablename__ = "people"

    id: str = Field(primary_key=True, max_length=64)
    email: str = Field(unique=True, max_length=320)
    name: str = Field(max_length=200)
    language: str = Field(default="en", max_length=8)
    usual_post: str | None = Field(default=None, max_length=64)
    roles: list[str] = Field(default_factory=lambda: [str(Role.MEMBER)], sa_type=JSON)
    created_at: datetime = Field(sa_type=UtcTime)

    def has_role(self, role: Role) -> bool:
        return str(role) in self.roles
