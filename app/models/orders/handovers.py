"""Chain of custody: every time mail changed hands, as the robot's receipt says. Only the robot writes custody."""

from datetime import datetime
from enum import StrEnum

from sqlalchemy import UniqueConstraint
from sqlmodel import Field, SQLModel

from app.models.columns import UtcTime


class Evidence(StrEnum):
    """The evidence of a hand-over, from a code that was proved to be shown down to nothing but the robot's word."""

    PROOF = "proof"
    TAP = "tap"
    DIGITS = "digits"
    DISPATCHER = "dispatcher"
    DIGEST = "digest"
    """An older robot repeats what it was told of the code: it could do so without having seen it."""
    BUTTON = "button"
    CLAIMED = "claimed"


class Settled(StrEnum):
    """The finding of a hand-over that was only claimed."""

    TRUE = "true"
    FALSE = "false"


class Handover(SQLModel, table=True):
    """One receipt. `purpose` is load, receive or return; `code_sha256` is None if no person was identified.

    `how`: code, tap, digits or button by a receipt; `dispatcher` if a person fetched the mail by hand. `holder` says
    whose code it was (one of `app.orders.custody.codes.Holder`), `person_id` and `delegate_id` who that is,
    as far as known.
    `signature` None: the robot was enrolled without a key.

    `evidence` says what it goes by. If that is nothing but the robot's word, `problem` says why, and `settled` what was
    found since: until then mail that is said to be out is still the robot's to answer for.
    """

    __tablename__ = "handovers"
    __table_args__ = (UniqueConstraint("order_id", "stop_id", "purpose"),)

    id: int | None = Field(default=None, primary_key=True)
    order_id: str = Field(foreign_key="orders.id", index=True)
    stop_id: str = Field(max_length=64)
    purpose: str = Field(max_length=16)
    robot: str = Field(foreign_key="robots.name", index=True)
    post: str = Field(max_length=64)
    code_sha256: str | None = Field(default=None, max_length=64)
    robot_at: datetime = Field(sa_type=UtcTime)
    at: datetime = Field(sa_type=UtcTime)
    how: str = Field(default="code", max_length=16)
    holder: str | None = Field(default=None, max_length=16)
    person_id: str | None = Field(default=None, foreign_key="people.id")
    delegate_id: str | None = Field(default=None, foreign_key="delegates.id")
    command_id: str | None = Field(default=None, max_length=64)
    signature: str | None = Field(default=None, max_length=100)
    evidence: str = Field(default=Evidence.DIGEST, max_length=16)
    problem: str | None = Field(default=None, max_length=64)
    settled: str | None = Field(default=None, max_length=16)


class RefusedReceipt(SQLModel, table=True):
    """A receipt that proves nothing: a bad signature, or a code that is none of the order's. Custody has not moved."""

    __tablename__ = "refused_receipts"

    id: int | None = Field(default=None, primary_key=True)
    robot: str = Field(foreign_key="robots.name")
    order_id: str = Field(max_length=64, index=True)
    stop_id: str = Field(max_length=64)
    purpose: str = Field(max_length=16)
    post: str = Field(max_length=64)
    code_sha256: str | None = Field(default=None, max_length=64)
    how: str = Field(max_length=16)
    command_id: str | None = Field(default=None, max_length=64)
    signature: str | None = Field(default=None, max_length=100)
    robot_at: datetime = Field(sa_type=UtcTime)
    at: datetime = Field(sa_type=UtcTime)
    problem: str = Field(max_length=64)
