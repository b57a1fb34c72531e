"""Durations that were learned, and promised arrivals of orders."""

from datetime import datetime

from sqlmodel import Field, SQLModel

from app.models.columns import UtcTime


class DurationRow(SQLModel, table=True):
    """One duration (`fleet.eta.durations.Thing`), beside what map and settings assume of it."""

    __tablename__ = "durations"

    id: int | None = Field(default=None, primary_key=True)
    kind: str = Field(max_length=16)
    name: str = Field(max_length=130)
    assumed_s: float
    seconds: float
    at: datetime = Field(sa_type=UtcTime, index=True)


class Quantiles(SQLModel):
    """`raw_…` is as it was worked out, `told_…` as people were told, `map_…` as the lengths on the map alone say."""

    raw_p10_s: float
    raw_p50_s: float
    raw_p90_s: float
    told_p10_s: float
    told_p50_s: float
    told_p90_s: float
    map_p10_s: float
    map_p50_s: float
    map_p90_s: float


class ForecastRow(Quantiles, table=True):
    """The promise of an order when it was placed, in seconds since `begins_at`, and when its robot came. `fetch_…`
    names the wait that it began with."""

    __tablename__ = "forecasts"

    # No reference: what it says of estimates outlives the order, and is about no person.
    order_id: str = Field(primary_key=True, max_length=64)
    begins_at: datetime = Field(sa_type=UtcTime, index=True)
    fetch_name: str = Field(max_length=130)
    fetch_assumed_s: float
    arrived_at: datetime | None = Field(default=None, sa_type=UtcTime, index=True)


class ForecastUnderWayRow(Quantiles, table=True):
    """The promise of an order that a robot has, in seconds since `told_at`, and when the robot came: the first that
    was told, and the first after the mail was loaded."""

    __tablename__ = "forecasts_under_way"

    order_id: str = Field(primary_key=True, max_length=64)
    is_aboard: bool = Field(primary_key=True)
    told_at: datetime = Field(sa_type=UtcTime, index=True)
    arrived_at: datetime | None = Field(default=None, sa_type=UtcTime, index=True)
