"""One-time codes by which a robot is enrolled: only their hash, a few tries, a short life."""

from datetime import datetime

from sqlmodel import Field, SQLModel

from app.models.columns import UtcTime


class EnrolmentCode(SQLModel, table=True):
    """The newest one of a name is the one that counts. `robot` need not be known yet: the code makes it so."""

    __tablename__ = "enrolment_codes"

    id: int | None = Field(default=None, primary_key=True)
    robot: str = Field(index=True, max_length=64)
    code_hash: str = Field(max_length=64)
    made_by_id: str | None = Field(default=None, foreign_key="people.id")
    created_at: datetime = Field(sa_type=UtcTime)
    expires_at: datetime = Field(sa_type=UtcTime)
    tries_left: int = 5
    used_at: datetime | None = Field(default=None, sa_type=UtcTime)
