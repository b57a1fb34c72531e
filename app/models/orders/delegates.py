"""Delegates, who may hand over instead of the sender or the recipient, and digits that were mistyped too often."""

from datetime import datetime

from sqlmodel import Field, SQLModel

from app.models.columns import UtcTime


class Delegate(SQLModel, table=True):
    """Named by the person whose turn it would be. The code is not stored: it derives from the key and this id."""

    __tablename__ = "delegates"

    id: str = Field(primary_key=True, max_length=64)
    order_id: str = Field(foreign_key="orders.id", index=True)
    purpose: str = Field(max_length=16)
    name: str = Field(max_length=200)
    email: str | None = Field(default=None, max_length=320)
    named_by_id: str = Field(foreign_key="people.id")
    named_at: datetime = Field(sa_type=UtcTime)
    revoked_at: datetime | None = Field(default=None, sa_type=UtcTime)


class DigitLock(SQLModel, table=True):
    """Wrong digits of one order since they were last released; the QR form is never locked."""

    __tablename__ = "digit_locks"

    order_id: str = Field(primary_key=True, foreign_key="orders.id")
    wrong_tries: int = 0
    locked_at: datetime | None = Field(default=None, sa_type=UtcTime)
