"""Inbox: robots' messages, taken once and in order: the same rules as on the robot's side (`protocol/sequence.py`)."""

from collections.abc import Sequence
from datetime import datetime
from typing import Any, Final

from sqlalchemy import bindparam, insert, update
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.database.database import connection_of
from app.models import RobotJournal, RobotMessage
from app.robots.errors import MessageGap
from protocol import sequence
from protocol.envelope import Envelope
from protocol.parts import Received
from protocol.sequence import Reception


async def resume(session: AsyncSession, robot: str, journal: str, resume_from: int, now: datetime) -> tuple[int, int]:
    """Take up a robot's journal at its hello: the number handled last, and how many are lost for ever."""
    row = await session.get(RobotJournal, (robot, journal))
    before = Received(journal=journal, seq=row.received_seq) if row else Received()
    resumption = sequence.resume(before, journal, resume_from)
    if row is None:
        row = RobotJournal(robot=robot, journal=journal, first_seen_at=now)
        session.add(row)
    row.received_seq = resumption.received.seq
    return row.received_seq, resumption.lost


async def knows_another_journal(session: AsyncSession, robot: str, journal: str) -> bool:
    """Tell if this robot has spoken before, but never from this journal: its memory is a new one."""
    journals = (await session.exec(select(RobotJournal.journal).where(RobotJournal.robot == robot))).all()
    return bool(journals) and journal not in journals


async def write_down(session: AsyncSession, said: Sequence[Envelope], now: datetime) -> list[bool | MessageGap]:
    """Judge durable messages of some robots in order, and write down the new ones.

    For each: True if it is new, False if it was handled before, a MessageGap if one before it is missing.
    """
    if not said:
        return []
    received = await _received(session, {envelope.robot for envelope in said})
    before = dict(received)
    verdicts = [_judge(received, envelope) for envelope in said]
    new = [envelope for envelope, verdict in zip(said, verdicts, strict=True) if verdict is True]
    if new:
        connection = await connection_of(session)
        await connection.execute(_WRITE_DOWN, [_row(envelope, now) for envelope in new])
        moved = [
            {"of": robot, "in_journal": journal, "up_to": seq}
            for (robot, journal), seq in received.items()
            if seq != before[robot, journal]
        ]
        await connection.execute(_MOVE_ON, moved)
    return verdicts


_WRITE_DOWN: Final = insert(RobotMessage)
_RECEIVED: Final = select(col(RobotJournal.robot), col(RobotJournal.journal), col(RobotJournal.received_seq)).where(
    col(RobotJournal.robot).in_(bindparam("robots", expanding=True))
)
_MOVE_ON: Final = (
    update(RobotJournal)
    .where(col(RobotJournal.robot) == bindparam("of"), col(RobotJournal.journal) == bindparam("in_journal"))
    .values(received_seq=bindparam("up_to"))
)


async def _received(session: AsyncSession, robots: set[str]) -> dict[tuple[str, str], int]:
    """The highest number taken so far, by robot and journal."""
    rows = await (await connection_of(session)).execute(_RECEIVED, {"robots": list(robots)})
    return {(robot, journal): seq for robot, journal, seq in rows.all()}


def _judge(received: dict[tuple[str, str], int], envelope: Envelope) -> bool | MessageGap:
    assert envelope.seq is not None  # noqa: S101  # the parser lets no durable message pass without
    place = (envelope.robot, envelope.journal)
    last = received.get(place)
    so_far = Received() if last is None else Received(journal=envelope.journal, seq=last)
    judged = sequence.reception(so_far, envelope.journal, envelope.seq)
    if judged is Reception.GAP:
        sentence = f"message {envelope.seq} came, {so_far.seq + 1} was next: connect again and resume"
        return MessageGap(sentence, envelope.seq)
    if judged is Reception.NEW:
        received[place] = envelope.seq
    return judged is Reception.NEW


def _row(envelope: Envelope, now: datetime) -> dict[str, Any]:
    return {
        "robot": envelope.robot,
        "journal": envelope.journal,
        "seq": envelope.seq,
        "type": envelope.type,
        "body": envelope.body.model_dump(mode="json"),
        "sent_at": envelope.at,
        "received_at": now,
    }
