"""The robots, what they last said of themselves, and the tokens they sign in with."""

from datetime import datetime
from typing import Any

from sqlalchemy import JSON
from sqlmodel import Field, SQLModel

from app.models.columns import UtcTime


class RobotRow(SQLModel, table=True):
    """`server_journal` is the journal of what the server sends to this robot, `last_seq` its highest number so far.

    `online` says that its socket is open now; every start of the service begins with no robot online. `public_key`
    (Ed25519, base64) is what its receipts are signed with; None: enrolled without one. `clock_off_s` is how far its
    clock was ahead at its last hello, or when it was seen to have been set since. `docked` as it says; None: it has
    not said. `home`: the post in whose dock it rests; `home_bay`: on maps with bays the bay that is its home, which
    counts for the traffic whether it has a dock or not. `waits_for`: the corridor it wishes to enter, for which robots,
    until about when. `taken_out_at`: a person has given its corridors to others, and it has not heard so yet.
    `proves_since`: from then on its receipts prove that a code was shown; it stays even if a later hello does not say
    so, until it is enrolled again.
    """

    __tablename__ = "robots"

    name: str = Field(primary_key=True, max_length=64)
    enrolled_at: datetime = Field(sa_type=UtcTime)
    server_journal: str = Field(max_length=64)
    last_seq: int = 0
    online: bool = False
    heard_at: datetime | None = Field(default=None, sa_type=UtcTime)
    software: str | None = Field(default=None, max_length=500)
    map_version: str | None = Field(default=None, max_length=500)
    post: str | None = Field(default=None, max_length=64)
    previous: str | None = Field(default=None, max_length=64)
    towards: str | None = Field(default=None, max_length=64)
    seen_at: datetime | None = Field(default=None, sa_type=UtcTime)
    activity: str = Field(default="idle", max_length=32)
    battery_ratio: float | None = None
    charging: bool = False
    why: str | None = Field(default=None, max_length=500)
    public_key: str | None = Field(default=None, max_length=64)
    takes_confirm: bool = False
    clock_off_s: float = 0.0
    home: str | None = Field(default=None, max_length=64)
    home_bay: str | None = Field(default=None, max_length=64)
    docked: bool | None = None
    waits_for: dict[str, Any] | None = Field(default=None, sa_type=JSON(none_as_null=True))
    taken_out_at: datetime | None = Field(default=None, sa_type=UtcTime)
    proves_since: datetime | None = Field(default=None, sa_type=UtcTime)


class RobotToken(SQLModel, table=True):
    """`cmr_<prefix>_<secret>`: the prefix finds the row, the secret is known by its hash alone."""

    __tablename__ = "robot_tokens"

    prefix: str = Field(primary_key=True, max_length=32)
    secret_hash: str = Field(max_length=64)
    robot: str = Field(foreign_key="robots.name", index=True)
    created_at: datetime = Field(sa_type=UtcTime)
    used_at: datetime | None = Field(default=None, sa_type=UtcTime)
    revoked_at: datetime | None = Field(default=None, sa_type=UtcTime)


class Alarm(SQLModel, table=True):
    """Something about a robot that a dispatcher should look at, such as a second socket with the same token."""

    __tablename__ = "alarms"

    id: int | None = Field(default=None, primary_key=True)
    robot: str = Field(foreign_key="robots.name")
    name: str = Field(max_length=64)
    reason: str = Field(max_length=500)
    post: str | None = Field(default=None, max_length=64)
    at: datetime = Field(sa_type=UtcTime)
    cleared_at: datetime | None = Field(default=None, sa_type=UtcTime)
    acknowledged_at: datetime | None = Field(default=None, sa_type=UtcTime)
    acknowledged_by_id: str | None = Field(default=None, foreign_key="people.id")
