"""Commands to robots: each is a row, and each row has one answer, which finds it by its id."""

from collections.abc import Sequence
from datetime import datetime
from typing import Final, Protocol

from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import RobotCommand, RobotRow
from app.robots.errors import UnknownCommand
from protocol.clock import Clock
from protocol.envelope import type_of
from protocol.ids import new_id
from protocol.parts import Part
from protocol.to_robot import Cancel, Confirm, EmergencyStop, OpenWay, Pause, Recall, Resume, Revoke
from protocol.to_server import CommandAnswer

REVOKE: Final = "revoke"
Command = Cancel | Confirm | Pause | Resume | Recall | EmergencyStop | OpenWay | Revoke


class Teller(Protocol):
    """The fleet, as far as it concerns commands."""

    @property
    def clock(self) -> Clock: ...

    async def tell(self, session: AsyncSession, robot: RobotRow, message: Part) -> int: ...


def new_command_id(kind: str) -> str:
    """Readable in a log, and never given twice: `pause-5d0e7a94c2b6f183`."""
    return f"{kind}-{new_id()}"


async def ask(
    session: AsyncSession, fleet: Teller, robot: RobotRow, message: Command, asked_by: str | None = None
) -> RobotCommand:
    """Tell a robot to do something, and remember who wanted it (`asked_by`: a person's id; None: the service)."""
    row = note(session, fleet, robot, message, asked_by)
    await fleet.tell(session, robot, message)
    return row


def note(
    session: AsyncSession, fleet: Teller, robot: RobotRow, message: Command, asked_by: str | None = None
) -> RobotCommand:
    """Remember it alone: the robot is told another time."""
    confirm = message if isinstance(message, Confirm) else None
    row = RobotCommand(
        command_id=message.command_id,
        robot=robot.name,
        kind=type_of(message),
        order_id=getattr(message, "order_id", None),
        asked_by_id=asked_by,
        asked_at=fleet.clock.utc(),
        asked_because=getattr(message, "reason", None),
        how=confirm.how if confirm else None,
        code_sha256=confirm.by if confirm else None,
    )
    session.add(row)
    return row


async def answered(session: AsyncSession, robot: str, answer: CommandAnswer, now: datetime) -> RobotCommand:
    """Write the robot's answer to its command. Raises UnknownCommand: this robot was not told so."""
    row = await session.get(RobotCommand, answer.command_id)
    if row is None or row.robot != robot:
        raise UnknownCommand(f"{robot} was given no command {answer.command_id}")
    if row.answered_at is None:
        row.answered_at, row.accepted, row.reason = now, answer.accepted, answer.reason
    return row


async def unanswered(
    session: AsyncSession, *, robot: str | None = None, kind: str | None = None, order_id: str | None = None
) -> Sequence[RobotCommand]:
    """Return the commands that robots have not answered yet, oldest first."""
    wanted = select(RobotCommand).where(col(RobotCommand.answered_at).is_(None))
    given = {"robot": robot, "kind": kind, "order_id": order_id}
    wanted = wanted.filter_by(**{name: value for name, value in given.items() if value is not None})
    return (await session.exec(wanted.order_by(col(RobotCommand.asked_at), col(RobotCommand.command_id)))).all()
