"""The address book: people that a person has saved. Those they exchanged mail with are found among the orders."""

from datetime import datetime

from sqlmodel import Field, SQLModel

from app.models.columns import UtcTime


class Contact(SQLModel, table=True):
    """One saved address; the other need not have an account."""

    __tablename__ = "contacts"

    person_id: str = Field(primary_key=True, foreign_key="people.id")
    email: str = Field(primary_key=True, max_length=320)
    label: str = Field(default="", max_length=100)
    post: str | None = Field(default=None, max_length=64)
    saved_at: datetime = Field(sa_type=UtcTime)
