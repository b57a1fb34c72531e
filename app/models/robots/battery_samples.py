"""Battery samples of robots over time."""

from datetime import datetime

from sqlmodel import Field, Index, SQLModel

from app.models.columns import UtcTime


class BatterySample(SQLModel, table=True):
    """Charge of one robot at one moment, as a ratio of its capacity; `at` is the service's time."""

    __tablename__ = "battery_samples"
    __table_args__ = (Index("ix_battery_samples_robot_at", "robot", "at"),)

    id: int | None = Field(default=None, primary_key=True)
    robot: str = Field(foreign_key="robots.name")
    at: datetime = Field(sa_type=UtcTime, index=True)
    ratio: float
    charging: bool
