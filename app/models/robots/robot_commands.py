"""Commands of people and of the service to robots, and the answers."""

from datetime import datetime

from sqlmodel import Field, SQLModel

from app.models.columns import UtcTime


class RobotCommand(SQLModel, table=True):
    """One command and its one answer; `kind` is the wire name of its message. `asked_by_id` None: the service itself.

    `asked_because`: the reason that they gave. `how` and `code_sha256` are those of a `confirm`: what its receipt must
    repeat.
    """

    __tablename__ = "robot_commands"

    command_id: str = Field(primary_key=True, max_length=64)
    robot: str = Field(foreign_key="robots.name")
    kind: str = Field(max_length=32)
    order_id: str | None = Field(default=None, foreign_key="orders.id", index=True)
    asked_by_id: str | None = Field(default=None, foreign_key="people.id")
    asked_at: datetime = Field(sa_type=UtcTime)
    asked_because: str | None = Field(default=None, max_length=500)
    how: str | None = Field(default=None, max_length=16)
    code_sha256: str | None = Field(default=None, max_length=64)
    answered_at: datetime | None = Field(default=None, sa_type=UtcTime)
    accepted: bool | None = None
    reason: str | None = Field(default=None, max_length=500)
