"""The last word of each robot on what its body is wholly in: nothing else says that anything is free."""

from datetime import datetime

from sqlmodel import Field, SQLModel

from app.models.columns import UtcTime


class OccupancyRow(SQLModel, table=True):
    """`kind` is bay, crossing or corridor; `place` the bay, the post, or the end of the corridor that lies behind, with
    `towards` the other end. `evidence` and `way_mm` as the robot tells them (`protocol.to_server.Occupancy`)."""

    __tablename__ = "occupancies"

    robot: str = Field(primary_key=True, foreign_key="robots.name")
    kind: str = Field(max_length=16)
    place: str = Field(max_length=64)
    towards: str | None = Field(default=None, max_length=64)
    evidence: str = Field(max_length=16)
    way_mm: int | None = None
    at: datetime = Field(sa_type=UtcTime)
