"""Whatever robots repeat, skip or send late: each message is written down once, and in order."""

import asyncio
from datetime import UTC, datetime

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sqlmodel import SQLModel, select

from app.core.database.database import Database
from app.models import RobotMessage, RobotRow
from app.robots.link import inbox
from protocol.envelope import Envelope
from protocol.parts import Leg
from protocol.to_server import Clear

AT = datetime(2026, 1, 5, 9, 0, tzinfo=UTC)
# A robot's journal and a number in it; or, at 0, a hello that resumes from the lowest number not yet taken.
arrivals = st.lists(st.tuples(st.sampled_from(["journal-a", "journal-b"]), st.integers(0, 6)), max_size=30)


def message(journal: str, seq: int) -> Envelope:
    body = Clear(leg=Leg(from_post="post1", to_post="post2"))
    return Envelope(type="clear", robot="r1", journal=journal, seq=seq, at=AT, body=body)


async def everything_taken(arriving: list[tuple[str, int]]) -> tuple[list[tuple[str, int]], list[tuple[str, int]]]:
    """Return the messages reported as new, and those in the table afterwards."""
    database = Database("sqlite://")
    new = []
    async with database.writing.begin() as connection:
        await connection.run_sync(SQLModel.metadata.create_all)
    async with database.transaction() as session:
        session.add(RobotRow(name="r1", enrolled_at=AT, server_journal="server"))
    for journal, seq in arriving:
        async with database.transaction() as session:
            if seq == 0:
                await inbox.resume(session, "r1", journal, 1, AT)
                continue
            (verdict,) = await inbox.write_down(session, [message(journal, seq)], AT)
            new += [(journal, seq)] if verdict is True else []
    async with database.reading() as session:
        rows = (await session.exec(select(RobotMessage))).all()
    await database.close()
    return new, [(row.journal, row.seq) for row in rows]


@settings(max_examples=40)
@given(arrivals)
@pytest.mark.nightly
def test_each_message_is_new_once_and_journals_do_not_mix(arriving: list[tuple[str, int]]) -> None:
    new, kept = asyncio.run(everything_taken(arriving))
    assert sorted(new) == sorted(kept)
    for journal in ("journal-a", "journal-b"):
        taken = [seq for one, seq in new if one == journal]
        assert taken == list(range(1, len(taken) + 1))
        expected, greeted = 0, False
        for seq in (seq for one, seq in arriving if one == journal):
            greeted = greeted or seq == 0
            expected += greeted and seq == expected + 1
        assert len(taken) == expected
