"""Chain of custody: every time mail changed hands, as the robot's receipt says. Only the robot writes custody."""

from datetime import datetime

from sqlalchemy import UniqueConstraint
from sqlmodel import Field, SQLModel

from app.tables.columns import UtcTime


class Handover(SQLModel, table=True):
    """One receipt. `purpose` is load or receive; `code_sha256` is None if nobody was identified."""

    __tablename__ = "handovers"
    __table_args__ = (UniqueConstraint("order_id", "stop_id", "purpose"),)

    id: int | None = Field(default=None, primary_key=True)
    order_id: str = Field(foreign_key="orders.id", index=True)
    stop_id: str = Field(max_length=64)
    purpose: str = Field(max_length=16)
    robot: str = Field(foreign_key="robots.name")
    post: str = Field(max_length=64)
    code_sha256: str | None = Field(default=None, max_length=64)
    robot_at: datetime = Field(sa_type=UtcTime)
    at: datetime = Field(sa_type=UtcTime)
