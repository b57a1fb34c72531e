"""Power cuts: what was synchronised is on the disk; of what was written since, some sectors are, in any order."""

from collections.abc import Callable, Iterator
from functools import partial
from itertools import pairwise
from pathlib import Path
from random import Random

from protocol.envelope import Envelope, type_of
from protocol.parts import Part, Purpose
from protocol.proofs import ShownCode
from protocol.to_robot import Grant
from protocol.to_server import Claim
from robot.mission.memory import Memory
from robot.mission.mission import MissionManager
from robot.mission.outbox import Outbox
from robot.mission.store import Store
from tests.robot.mission.test_mission import LETTER, LOAD, NOW, RECEIVE, TO_POST3, TO_POST4, FakeServer

SECTOR, LOG_HEAD = 512, 32
Files = tuple[bytes, bytes]
"""The database and its log of writes."""


def content(store: Store) -> list[str]:
    with store.transaction() as database:
        return list(database.iterdump())


def steps(missions: MissionManager, server: FakeServer) -> Iterator[Callable[[], object]]:
    """Letters one after the other. Each step is on the disk as a whole or not at all."""
    memory, outbox = missions.memory, missions.outbox
    yield partial(memory.resume, "server", 1)

    def hears(seq: int, message: Part) -> Callable[[], object]:
        envelope = Envelope(type=type_of(message), robot="r1", journal="server", seq=seq, at=NOW, body=message)
        return partial(memory.receive, envelope)

    for number in range(3):
        letter = LETTER.model_copy(update={"id": f"m{number}"})
        yield hears(2 * number + 1, letter)
        yield partial(missions.claims.ask, (TO_POST3, TO_POST4))
        claim = outbox.pending()[-1].message
        assert isinstance(claim, Claim)
        yield hears(2 * number + 2, Grant(claim_id=claim.claim_id, legs=(TO_POST3, TO_POST4)))
        for incoming in memory.unhandled():
            server.waiting = [incoming]
            yield missions.take_messages
        yield partial(missions.handed_over, (letter, LOAD), Purpose.LOAD, "post1", ShownCode("a" * 64, b"key"))
        yield partial(missions.claims.clear, [TO_POST3, TO_POST4])
        yield lambda: outbox.acknowledged(outbox.last_seq())
        yield partial(missions.handed_over, (letter, RECEIVE), Purpose.RECEIVE, "post4", ShownCode("b" * 64, b"key"))
        yield partial(missions.finish_mission, letter.id, "post4")


def torn(old: bytes, new: bytes, chance: Random) -> bytes:
    """A file of which some sectors are written and the others are as before; what was never written reads as zeros."""
    length = max(len(old), len(new))
    old, new = old.ljust(length, b"\0"), new.ljust(length, b"\0")
    share = chance.choice((0.1, 0.5, 0.9, 1.0))
    sectors = [(new if chance.random() < share else old)[at : at + SECTOR] for at in range(0, length, SECTOR)]
    return b"".join(sectors)


def cuts(old: Files, new: Files, chance: Random) -> Iterator[Files]:
    """Yield torn files. SQLite synchronises them apart, so one at a time: the log's head, its frames, the database."""
    log = new[1][:LOG_HEAD] + old[1][LOG_HEAD:]
    for _ in range(4):
        yield old[0], torn(log, new[1], chance)
    if old[0] != new[0]:
        yield torn(old[0], new[0], chance), new[1]


def test_whenever_the_power_fails_a_step_is_on_the_disk_as_a_whole_or_not_at_all(tmp_path: Path) -> None:
    path, copy = tmp_path / "robot.db", tmp_path / "copy.db"
    chance = Random(4)
    with Store(path) as store:
        with store.transaction() as database:
            database.execute("PRAGMA wal_autocheckpoint = 20")  # pages; SQLite's thousand would not come

        def look() -> tuple[Files, list[str]]:
            return (path.read_bytes(), path.with_name("robot.db-wal").read_bytes()), content(store)

        server = FakeServer(Memory(store))
        missions = MissionManager(store, server.memory, Outbox(store), lambda: NOW, server)
        looks = [look()]
        for step in steps(missions, server):
            step()
            looks.append(look())
    found = {"before": 0, "after": 0}
    for (old, before), (new, after) in pairwise(looks):
        assert before != after, "every step writes"
        for found_database, log in cuts(old, new, chance):
            copy.write_bytes(found_database)
            copy.with_name("copy.db-wal").write_bytes(log)
            with Store(copy) as restarted:
                known = content(restarted)
            assert known in (before, after), f"half a step: {[line for line in known if line not in after]}"
            found["after" if known == after else "before"] += 1
    assert min(found.values()) > 20, found
    assert len({old[0] for (old, _) in looks}) > 3, "the log was copied back into the database now and then"


def test_a_transaction_that_returns_is_on_the_disk_and_not_on_its_way_there(store: Store) -> None:
    with store.transaction() as database:
        pragmas = {name: database.execute(f"PRAGMA {name}").fetchone()[0] for name in ("journal_mode", "synchronous")}
    assert pragmas == {"journal_mode": "wal", "synchronous": 2}
