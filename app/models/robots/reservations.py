"""Reservation requests for corridors, and grants: no time-out ever frees one."""

from datetime import datetime
from typing import Any

from sqlalchemy import JSON
from sqlmodel import Field, SQLModel

from app.models.columns import UtcTime


class ClaimRow(SQLModel, table=True):
    """A robot's wish, and its answer: granted, or denied with the corridors to avoid; neither as long as it waits.

    `goal` is the post that the robot is going to now, if it has said so.
    """

    __tablename__ = "claims"

    robot: str = Field(primary_key=True, foreign_key="robots.name")
    claim_id: str = Field(primary_key=True, max_length=64)
    legs: list[dict[str, Any]] = Field(sa_type=JSON)
    at: datetime = Field(sa_type=UtcTime)
    granted: bool | None = None
    reason: str | None = Field(default=None, max_length=500)
    goal: str | None = Field(default=None, max_length=64)


class GrantRow(SQLModel, table=True):
    """One corridor in one direction, held until the robot is clear of it. `corridor` is `maps.corridor_name`.

    `left_at` is where the robot stood when it was clear: the near end, if it never drove through.
    `freed_by`: the command by which a person took it back.
    """

    __tablename__ = "grants"

    id: int | None = Field(default=None, primary_key=True)
    robot: str = Field(foreign_key="robots.name")
    claim_id: str = Field(max_length=64)
    corridor: str = Field(max_length=130, index=True)
    from_post: str = Field(max_length=64)
    to_post: str = Field(max_length=64)
    granted_at: datetime = Field(sa_type=UtcTime)
    cleared_at: datetime | None = Field(default=None, sa_type=UtcTime)
    left_at: str | None = Field(default=None, max_length=64)
    freed_by: str | None = Field(default=None, max_length=64)


class ClosedCorridor(SQLModel, table=True):
    """Closed for all robots by a person, until a person opens it again. `corridor` is `maps.corridor_name`."""

    __tablename__ = "closed_corridors"

    corridor: str = Field(primary_key=True, max_length=130)
    closed_at: datetime = Field(sa_type=UtcTime)
    closed_by_id: str = Field(foreign_key="people.id")
    reason: str = Field(max_length=500)
