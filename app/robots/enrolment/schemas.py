"""Enrolment over HTTP."""

from datetime import datetime
from typing import Annotated

from pydantic import BaseModel, ConfigDict, StringConstraints

from app.models import RobotToken

RobotName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]*$", max_length=64)]


class EnrolmentCodeView(BaseModel):
    """A one-time code, shown once: type it at the robot before it expires."""

    robot: str
    code: str
    expires_at: datetime


class Enrolment(BaseModel):
    """A robot's enrolment: its code, and the public half of its Ed25519 key, in base64."""

    model_config = ConfigDict(extra="forbid")

    name: RobotName
    code: Annotated[str, StringConstraints(min_length=8, max_length=32, pattern=r"^[0-9A-Za-z -]+$")]
    public_key: Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9+/]{43}=$")]


class Enrolled(BaseModel):
    """The robot's token, told once and never again."""

    name: str
    token: str


class RobotTokenView(BaseModel):
    """A token by its readable prefix: when it was made, used last, and taken back."""

    prefix: str
    created_at: datetime
    used_at: datetime | None
    revoked_at: datetime | None

    @classmethod
    def of(cls, row: RobotToken) -> "RobotTokenView":
        return cls(prefix=row.prefix, created_at=row.created_at, used_at=row.used_at, revoked_at=row.revoked_at)
