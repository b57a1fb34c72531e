"""What each robot is to do: a mission is an ordered list of stops."""

from datetime import datetime
from enum import StrEnum

from sqlmodel import Field, SQLModel

from app.tables.columns import UtcTime, WordOf


class MissionState(StrEnum):
    """A robot has at most one mission that is active."""

    ACTIVE = "active"
    DONE = "done"
    CANCELLED = "cancelled"
    GAVE_UP = "gave_up"


class MissionRow(SQLModel, table=True):
    """`update_number` grows by one whenever the stops change; the robot holds the newest."""

    __tablename__ = "missions"

    id: str = Field(primary_key=True, max_length=64)
    robot: str = Field(foreign_key="robots.name", index=True)
    update_number: int = 1
    state: MissionState = Field(default=MissionState.ACTIVE, sa_type=WordOf(MissionState), index=True)
    created_at: datetime = Field(sa_type=UtcTime)
    accepted_at: datetime | None = Field(default=None, sa_type=UtcTime)
    finished_at: datetime | None = Field(default=None, sa_type=UtcTime)


class StopRow(SQLModel, table=True):
    """`position` counts from 0; `action` is one of `protocol.parts.StopAction`."""

    __tablename__ = "stops"

    id: str = Field(primary_key=True, max_length=64)
    mission_id: str = Field(foreign_key="missions.id", index=True)
    position: int
    post: str = Field(max_length=64)
    action: str = Field(max_length=16)
    order_id: str | None = Field(default=None, foreign_key="orders.id", index=True)
    wait_limit_s: float = 600.0
    departed_at: datetime | None = Field(default=None, sa_type=UtcTime)
    arrived_at: datetime | None = Field(default=None, sa_type=UtcTime)
    done_at: datetime | None = Field(default=None, sa_type=UtcTime)
    gave_up_at: datetime | None = Field(default=None, sa_type=UtcTime)
