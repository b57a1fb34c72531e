"""Codes mailed for signing in: only their hash, a few tries, a short life."""

from datetime import datetime

from sqlmodel import Field, SQLModel

from app.models.columns import UtcTime


class SignInCode(SQLModel, table=True):
    """The newest ones that a browser asked for are good there; `used_at` makes them single use."""

    __tablename__ = "sign_in_codes"

    id: int | None = Field(default=None, primary_key=True)
    email: str = Field(index=True, max_length=320)
    browser_hash: str = Field(default="", max_length=64, sa_column_kwargs={"server_default": ""})
    code_hash: str = Field(max_length=64)
    created_at: datetime = Field(sa_type=UtcTime)
    expires_at: datetime = Field(sa_type=UtcTime)
    tries_left: int = 5
    used_at: datetime | None = Field(default=None, sa_type=UtcTime)

    def is_good(self, now: datetime) -> bool:
        return self.used_at is None and self.expires_at > now and self.tries_left > 0
