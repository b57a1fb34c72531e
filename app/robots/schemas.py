"""Robots, their alarms and commands as dispatchers and maintainers see them."""

from datetime import datetime
from typing import Annotated

from pydantic import BaseModel, ConfigDict, StringConstraints

from app.core.text_lines import Reason
from app.core.texts.reasons import Words, words_of
from app.models import Alarm, RobotCommand, RobotRow
from app.orders.views.robot_view import RobotView
from app.robots.corridors.closed_corridors import closed_corridor
from protocol.one_line import ONE_LINE


class CommandReason(BaseModel):
    """The reason: the robot keeps it, and later readers of the log want to know."""

    model_config = ConfigDict(extra="forbid")

    reason: Reason


class WayIsOpen(BaseModel):
    """Which corridor is free again: the name that it has on the map."""

    model_config = ConfigDict(extra="forbid")

    corridor: Annotated[str, StringConstraints(min_length=1, max_length=129, pattern=ONE_LINE)]


class CommandView(BaseModel):
    """A command to a robot, and its result: `accepted` null until it answers; `reason` is its own sentence, in
    English, `reason_words` the same as a text of the catalogue, if it is one.

    `online` false: it has not heard of it yet, and will when it is back.
    """

    command_id: str
    robot: str
    kind: str
    order_id: str | None
    asked_at: datetime
    answered_at: datetime | None
    accepted: bool | None
    reason: str | None
    reason_words: Words | None
    online: bool

    @classmethod
    def of(cls, row: RobotCommand, online: bool) -> "CommandView":
        words = words_of(row.reason) if row.reason else None
        return cls.model_validate({**row.model_dump(), "reason_words": words, "online": online})


class AlarmView(BaseModel):
    """Something about a robot that a person should look at; over when `cleared_at` says so.

    `reason` is a sentence in English; `why_words` the same as a text of the catalogue, if it is one. `corridor`: the
    one that the robot found closed, and in which it goes nowhere until the alarm is over.
    """

    id: int
    robot: str
    name: str
    reason: str
    why_words: Words | None
    post: str | None
    corridor: str | None
    at: datetime
    cleared_at: datetime | None
    acknowledged_at: datetime | None

    @classmethod
    def of(cls, row: Alarm) -> "AlarmView":
        known = {"why_words": words_of(row.reason), "corridor": closed_corridor(row.name, row.reason)}
        return cls.model_validate({**row.model_dump(), **known})


class RobotDetails(BaseModel):
    """One robot in full. `clock_off_s`: how far its clock is ahead; times shown are put right by it.

    `signs_receipts`: it has a key, so that its receipts are checked. `takes_taps`: hand-overs can be confirmed in the
    app. `alarms` are those that are not over.
    """

    robot: RobotView
    enrolled_at: datetime
    software: str | None
    map_version: str | None
    clock_off_s: float
    signs_receipts: bool
    takes_taps: bool
    alarms: list[AlarmView]

    @classmethod
    def of(cls, row: RobotRow, view: RobotView, alarms: list[Alarm]) -> "RobotDetails":
        return cls(
            robot=view,
            enrolled_at=row.enrolled_at,
            software=row.software,
            map_version=row.map_version,
            clock_off_s=round(row.clock_off_s, 1),
            signs_receipts=row.public_key is not None,
            takes_taps=row.takes_confirm,
            alarms=[AlarmView.of(alarm) for alarm in alarms],
        )
