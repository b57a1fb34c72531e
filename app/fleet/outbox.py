"""What robots are to be told, kept until they have it. Written in the transaction of whatever it follows from."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any, Final
from uuid import uuid4

from sqlalchemy import bindparam, exists
from sqlmodel import col, func, select, update
from sqlmodel.ext.asyncio.session import AsyncSession

from app.tables import MessageToRobot, RobotRow, RobotToken
from protocol.envelope import type_of
from protocol.parts import Part, Received


async def keep(session: AsyncSession, robot: RobotRow, message: Part, now: datetime) -> int:
    """Number a durable message and keep it; it is sent as soon as the transaction is committed and the robot there."""
    robot.last_seq += 1
    body = message.model_dump(mode="json")
    row = MessageToRobot(robot=robot.name, seq=robot.last_seq, type=type_of(message), body=body, created_at=now)
    session.add(row)
    await session.flush()
    return robot.last_seq


@dataclass(frozen=True, slots=True)
class Waiting:
    """A message that is to go out. `may_hear` is false once the token of the connection is revoked."""

    seq: int
    type: str
    body: Mapping[str, Any]
    may_hear: bool


async def pending(session: AsyncSession, robot: str, prefix: str, after: int, limit: int) -> Sequence[Waiting]:
    """What the robot has not acknowledged, beyond `after`, in order; `prefix` is the token that it came in with."""
    good = exists().where(col(RobotToken.prefix) == prefix, col(RobotToken.revoked_at).is_(None))
    wanted = (
        select(MessageToRobot.seq, MessageToRobot.type, MessageToRobot.body, good)
        .where(MessageToRobot.robot == robot, MessageToRobot.seq > after, col(MessageToRobot.acked_at).is_(None))
        .order_by(col(MessageToRobot.seq))
        .limit(limit)
    )
    return [Waiting(*row) for row in (await session.exec(wanted)).all()]


async def acknowledged_by(session: AsyncSession, up_to: Mapping[str, int], now: datetime) -> None:
    """These robots have stored everything up to these numbers."""
    rows = [{"of": robot, "up_to": seq, "at": now} for robot, seq in up_to.items()]
    await (await session.connection()).execute(_HAVE, rows)


_HAVE: Final = (
    update(MessageToRobot)
    .where(
        col(MessageToRobot.robot) == bindparam("of"),
        col(MessageToRobot.seq) <= bindparam("up_to"),
        col(MessageToRobot.acked_at).is_(None),
    )
    .values(acked_at=bindparam("at"))
)


async def acknowledged(session: AsyncSession, robot: str, seq: int, now: datetime) -> None:
    """The robot has stored everything up to `seq`."""
    await acknowledged_by(session, {robot: seq}, now)


async def resume_from(session: AsyncSession, robot: RobotRow) -> int:
    """The lowest number that can still be sent."""
    lowest = select(func.min(MessageToRobot.seq)).where(
        MessageToRobot.robot == robot.name, col(MessageToRobot.acked_at).is_(None)
    )
    return (await session.exec(lowest)).one() or robot.last_seq + 1


def went_back_in_time(robot: RobotRow, received: Received) -> bool:
    """Whether the robot has had messages from this journal that we have not written yet.

    Then this database was put back from an older copy, and the numbers that come next would look like repetitions.
    """
    return received.journal == robot.server_journal and received.seq > robot.last_seq


def renew_journal(robot: RobotRow) -> None:
    """Begin another journal; the numbers go on, and what waits belongs to the new one."""
    robot.server_journal = str(uuid4())
