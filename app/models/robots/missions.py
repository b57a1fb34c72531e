"""Missions: ordered lists of stops."""

from datetime import datetime
from enum import StrEnum

from sqlmodel import Field, SQLModel

from app.models.columns import EnumColumn, UtcTime


class MissionState(StrEnum):
    """A robot has at most one mission that is active."""

    ACTIVE = "active"
    DONE = "done"
    CANCELLED = "cancelled"
    GAVE_UP = "gave_up"


class MissionRow(SQLModel, table=True):
    """`update_number` grows by one whenever the stops change; the robot is told of it when `told_update` is smaller.

    A mission whose id begins with `return-` is one that the robot gave to itself (decision 0017).
    """

    __tablename__ = "missions"

    id: str = Field(primary_key=True, max_length=64)
    robot: str = Field(foreign_key="robots.name")
    update_number: int = 1
    told_update: int = 0
    accepted_update: int = 0
    state: MissionState = Field(default=MissionState.ACTIVE, sa_type=EnumColumn(MissionState), index=True)
    created_at: datetime = Field(sa_type=UtcTime)
    accepted_at: datetime | None = Field(default=None, sa_type=UtcTime)
    finished_at: datetime | None = Field(default=None, sa_type=UtcTime)


class StopRow(SQLModel, table=True):
    """`position` orders the stops; `action` is one of `protocol.parts.StopAction`.

    `until_ratio`: the charge until which the robot stays in a dock. `since_update` is the mission's
    update that brought it. A stop is over when it is done, given up, or dropped: taken out of the mission by a later
    update.
    """

    __tablename__ = "stops"

    id: str = Field(primary_key=True, max_length=64)
    mission_id: str = Field(foreign_key="missions.id", index=True)
    position: int
    post: str = Field(max_length=64)
    action: str = Field(max_length=16)
    order_id: str | None = Field(default=None, foreign_key="orders.id", index=True)
    wait_limit_s: float = 600.0
    until_ratio: float | None = None
    since_update: int = 1
    departed_at: datetime | None = Field(default=None, sa_type=UtcTime)
    arrived_at: datetime | None = Field(default=None, sa_type=UtcTime)
    done_at: datetime | None = Field(default=None, sa_type=UtcTime)
    gave_up_at: datetime | None = Field(default=None, sa_type=UtcTime)
    dropped_at: datetime | None = Field(default=None, sa_type=UtcTime)
