"""Tokens with which people's scripts sign in."""

from datetime import datetime

from sqlalchemy import JSON
from sqlmodel import Field, SQLModel

from app.models.columns import UtcTime


class PersonToken(SQLModel, table=True):
    """`cmp_<prefix>_<secret>`: the prefix finds the row, the secret is known by its hash alone."""

    __tablename__ = "person_tokens"

    prefix: str = Field(primary_key=True, max_length=32)
    secret_hash: str = Field(max_length=64)
    person_id: str = Field(foreign_key="people.id", index=True)
    name: str = Field(max_length=100)
    scopes: list[str] = Field(sa_type=JSON)
    created_at: datetime = Field(sa_type=UtcTime)
    expires_at: datetime = Field(sa_type=UtcTime)
    used_at: datetime | None = Field(default=None, sa_type=UtcTime)
    revoked_at: datetime | None = Field(default=None, sa_type=UtcTime)
