"""Messages from and to robots: numbered both ways, so that nothing is lost or done twice."""

from datetime import datetime
from typing import Any

from sqlalchemy import JSON
from sqlmodel import Field, SQLModel

from app.models.columns import UtcTime


class RobotJournal(SQLModel, table=True):
    """One outbox of one robot; `received_seq` is the highest contiguous number handled from it."""

    __tablename__ = "robot_journals"

    robot: str = Field(primary_key=True, foreign_key="robots.name")
    journal: str = Field(primary_key=True, max_length=64)
    received_seq: int = 0
    first_seen_at: datetime = Field(sa_type=UtcTime)


class RobotMessage(SQLModel, table=True):
    """A durable message from a robot; its primary key is what makes a repetition harmless."""

    __tablename__ = "robot_messages"

    robot: str = Field(primary_key=True, foreign_key="robots.name")
    journal: str = Field(primary_key=True, max_length=64)
    seq: int = Field(primary_key=True)
    type: str = Field(max_length=32)
    body: dict[str, Any] = Field(sa_type=JSON)
    sent_at: datetime = Field(sa_type=UtcTime)
    received_at: datetime = Field(sa_type=UtcTime)


class MessageToRobot(SQLModel, table=True):
    """A durable message to a robot, kept until it is acknowledged."""

    __tablename__ = "server_outbox"

    robot: str = Field(primary_key=True, foreign_key="robots.name")
    seq: int = Field(primary_key=True)
    type: str = Field(max_length=32)
    body: dict[str, Any] = Field(sa_type=JSON)
    created_at: datetime = Field(sa_type=UtcTime)
    acked_at: datetime | None = Field(default=None, sa_type=UtcTime)
