"""Identities at the campus's own sign-in (OpenID Connect)."""

from datetime import datetime

from sqlmodel import Field, SQLModel

from app.models.columns import UtcTime


class Identity(SQLModel, table=True):
    """Issuer and subject never change, whatever becomes of the address."""

    __tablename__ = "identities"

    issuer: str = Field(primary_key=True, max_length=255)
    subject: str = Field(primary_key=True, max_length=255)
    person_id: str = Field(foreign_key="people.id", index=True)
    created_at: datetime = Field(sa_type=UtcTime)
