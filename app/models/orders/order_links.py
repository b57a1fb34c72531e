"""Links to one order, for a person without an account: mailed, and known here by their hash alone."""

from datetime import datetime

from sqlalchemy import UniqueConstraint
from sqlmodel import Field, SQLModel

from app.models.columns import UtcTime


class OrderLink(SQLModel, table=True):
    """The token derives from the server key and `nonce`, so that a mail can be written again; `token_hash` finds it."""

    __tablename__ = "order_links"
    __table_args__ = (UniqueConstraint("order_id", "person_id"),)

    nonce: str = Field(primary_key=True, max_length=32)
    order_id: str = Field(foreign_key="orders.id")
    person_id: str = Field(foreign_key="people.id", index=True)
    token_hash: str = Field(unique=True, max_length=64)
    created_at: datetime = Field(sa_type=UtcTime)
    expires_at: datetime = Field(sa_type=UtcTime)
    revoked_at: datetime | None = Field(default=None, sa_type=UtcTime)
