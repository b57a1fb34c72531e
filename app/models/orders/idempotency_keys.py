"""Answers kept for 24 hours, so that a request sent twice is done once."""

from datetime import datetime
from typing import Any

from sqlalchemy import JSON
from sqlmodel import Field, SQLModel

from app.models.columns import UtcTime


class IdempotencyKey(SQLModel, table=True):
    """Scoped to the person. Written in the transaction of the order itself: both exist or neither."""

    __tablename__ = "idempotency_keys"

    person_id: str = Field(primary_key=True, foreign_key="people.id")
    key: str = Field(primary_key=True, max_length=255)
    body_hash: str = Field(max_length=64)
    status: int
    headers: dict[str, str] = Field(sa_type=JSON)
    answer: dict[str, Any] = Field(sa_type=JSON)
    created_at: datetime = Field(sa_type=UtcTime, index=True)
