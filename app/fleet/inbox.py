"""What robots say, taken once and in order: the same rules as on the robot's side (`protocol/sequence.py`)."""

from datetime import datetime

from sqlmodel import select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.fleet.errors import MessageGap
from app.tables import RobotJournal, RobotMessage
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
    """Whether this robot has spoken before, but never from this journal: its memory is a new one."""
    journals = (await session.exec(select(RobotJournal.journal).where(RobotJournal.robot == robot))).all()
    return bool(journals) and journal not in journals


async def take(session: AsyncSession, robot: str, envelope: Envelope, now: datetime) -> bool:
    """Write down a durable message; False if it was handled before. Raises MessageGap."""
    assert envelope.seq is not None  # noqa: S101  # the parser lets no durable message pass without
    row = await session.get(RobotJournal, (robot, envelope.journal))
    received = Received(journal=row.journal, seq=row.received_seq) if row else Received()
    judged = sequence.reception(received, envelope.journal, envelope.seq)
    if judged is Reception.GAP or row is None:
        sentence = f"message {envelope.seq} came, {received.seq + 1} was next: connect again and resume"
        raise MessageGap(sentence, envelope.seq)
    if judged is Reception.REPEATED:
        return False
    row.received_seq = envelope.seq
    session.add(
        RobotMessage(
            robot=robot,
            journal=envelope.journal,
            seq=envelope.seq,
            type=envelope.type,
            body=envelope.body.model_dump(mode="json"),
            sent_at=envelope.at,
            received_at=now,
        )
    )
    await session.flush()
    return True
