"""Codes mailed for signing in: only their hash, a few tries, a short life."""

from datetime import datetime

from sqlmodel import Field, SQLModel

from app.tables.columns import UtcTime


class SignInCode(SQLModel, table=True):
    """The newest one of an address is the one that counts; `used_at` makes it single use."""

    __tablename__ = "sign_in_codes"

    id: int | None = Field(default=None, primary_key=True)
    email: str = Field(index=True, max_length=320)
    code_hash: str = Field(max_length=64)
    created_at: datetime = Field(sa_type=UtcTime)
    expires_at: datetime = Field(sa_type=UtcTime)
    tries_left: int = 5
    used_at: datetime | None = Field(default=None, sa_type=UtcTime)
