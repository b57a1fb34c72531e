"""Outbox: messages to robots, kept until they have them. Written in the transaction of whatever it follows from."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any, Final

from sqlalchemy import Text, bindparam, cast, exists, func, insert, select, update
from sqlmodel import col
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.database.database import connection_of
from app.models import MessageToRobot, RobotRow, RobotToken
from protocol.envelope import type_of
from protocol.ids import new_uuid
from protocol.parts import Part, Received


async def keep(session: AsyncSession, robot: RobotRow, message: Part, now: datetime) -> int:
    """Number a durable message and keep it; it is sent as soon as the transaction is committed and the robot there."""
    robot.last_seq += 1
    await (await connection_of(session)).execute(_KEEP, [_row(robot.name, robot.last_seq, message, now)])
    return robot.last_seq


@dataclass(frozen=True, slots=True)
class Waiting:
    """A message that is to go out; `body` is its JSON. `may_hear` is false once the connection's token is revoked."""

    seq: int
    type: str
    body: str
    may_hear: bool


def _row(robot: str, seq: int, message: Part, now: datetime) -> dict[str, Any]:
    body = message.model_dump(mode="json")
    return {"robot": robot, "seq": seq, "type": type_of(message), "body": body, "created_at": now}


_KEEP: Final = insert(MessageToRobot)


async def pending(session: AsyncSession, robot: str, prefix: str, after: int, limit: int) -> Sequence[Waiting]:
    """Return what the robot has not acknowledged, beyond `after`, in order; `prefix` is the token that it came in
    with."""
    asked = {"of": robot, "prefix": prefix, "after": after, "at_most": limit}
    return [Waiting(*row) for row in (await (await connection_of(session)).execute(_PENDING, asked)).all()]


_IS_GOOD: Final = exists().where(col(RobotToken.prefix) == bindparam("prefix"), col(RobotToken.revoked_at).is_(None))
_PENDING: Final = (
    select(col(MessageToRobot.seq), col(MessageToRobot.type), cast(col(MessageToRobot.body), Text), _IS_GOOD)
    .where(
        col(MessageToRobot.robot) == bindparam("of"),
        col(MessageToRobot.seq) > bindparam("after"),
        col(MessageToRobot.acked_at).is_(None),
    )
    .order_by(col(MessageToRobot.seq))
    .limit(bindparam("at_most"))
)


async def acknowledged_by(session: AsyncSession, news: Mapping[str, tuple[int, int]], now: datetime) -> None:
    """These robots have stored everything up to the second number; what they had before ends with the first."""
    few = {robot: range(had + 1, has + 1) for robot, (had, has) in news.items() if has - had <= FEW}
    one_by_one = [{"of": robot, "one": seq, "at": now} for robot, numbers in few.items() for seq in numbers]
    rest = [{"of": robot, "up_to": has, "at": now} for robot, (_, has) in news.items() if robot not in few]
    connection = await connection_of(session)
    if one_by_one:  # by their keys, which is quick
        await connection.execute(_HAS, one_by_one)
    if rest:
        await connection.execute(_HAVE, rest)


FEW: Final = 10
_HAS: Final = (
    update(MessageToRobot)
    .where(col(MessageToRobot.robot) == bindparam("of"), col(MessageToRobot.seq) == bindparam("one"))
    .values(acked_at=bindparam("at"))
)
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
    await (await connection_of(session)).execute(_HAVE, {"of": robot, "up_to": seq, "at": now})


async def resume_from(session: AsyncSession, robot: RobotRow) -> int:
    """The lowest number that can still be sent."""
    lowest = (await (await connection_of(session)).execute(_LOWEST, {"of": robot.name})).scalar_one()
    return lowest or robot.last_seq + 1


_LOWEST: Final = select(func.min(MessageToRobot.seq)).where(
    col(MessageToRobot.robot) == bindparam("of"), col(MessageToRobot.acked_at).is_(None)
)


def went_back_in_time(robot: RobotRow, received: Received) -> bool:
    """Tell if the robot has had messages from this journal that we have not written yet.

    Then this database was put back from an older copy, and the numbers that come next would look like repetitions.
    """
    return received.journal == robot.server_journal and received.seq > robot.last_seq


def renew_journal(robot: RobotRow) -> None:
    """Begin another journal; the numbers go on, and what waits belongs to the new one."""
    robot.server_journal = new_uuid()
