"""Sessions of browsers: the cookie's secret is known here by its hash alone."""

from datetime import datetime

from sqlmodel import Field, SQLModel

from app.models.columns import UtcTime


class PersonSession(SQLModel, table=True):
    """`token_hash` is the SHA-256 of the cookie; `revoked_at` ends it before its time.

    `device` says in words what it was opened with ("Firefox, Windows"); `seen_at` is some minutes behind.
    `browser_hash` is the SHA-256 of the cookie of the browser that asked for the code; empty if none was mailed.
    """

    __tablename__ = "sessions"

    id: int | None = Field(default=None, primary_key=True)
    token_hash: str = Field(unique=True, max_length=64)
    person_id: str = Field(foreign_key="people.id", index=True)
    device: str = Field(default="", max_length=64)
    browser_hash: str = Field(default="", max_length=64, sa_column_kwargs={"server_default": ""})
    created_at: datetime = Field(sa_type=UtcTime)
    seen_at: datetime | None = Field(default=None, sa_type=UtcTime)
    expires_at: datetime = Field(sa_type=UtcTime)
    revoked_at: datetime | None = Field(default=None, sa_type=UtcTime)
