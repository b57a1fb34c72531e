"""The outbox: durable before it returns, numbered for ever, never half written."""

import sqlite3
from datetime import UTC, datetime
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol.parts import Battery, Leg, Position
from protocol.to_server import Clear, Event, Fault, Hello
from robot.mission.memory import Memory
from robot.mission.outbox import NotDurable, Outbox
from robot.mission.store import StorageFailed, StorageFull, StorageInUse, StorageNewer, Store

AT = datetime(2026, 1, 5, 9, 0, tzinfo=UTC)


def a_fault(reason: str = "") -> Event:
    return Event(happened=Fault(name="bump", happened_at=AT, reason=reason))


def clear(post: str) -> Clear:
    return Clear(leg=Leg(from_post="post1", to_post=post))


def test_messages_come_back_in_order_with_their_numbers(store: Store) -> None:
    outbox = Outbox(store)
    assert [outbox.put(clear("post2")), outbox.put(a_fault("x")), outbox.put(clear("post3"))] == [1, 2, 3]
    assert [(kept.seq, kept.message) for kept in outbox.pending(after=1)] == [(2, a_fault("x")), (3, clear("post3"))]


def test_numbers_do_not_restart_after_everything_was_acknowledged_and_the_robot_restarted(tmp_path: Path) -> None:
    store = Store(tmp_path / "robot.db")
    outbox = Outbox(store)
    journal = outbox.journal
    outbox.acknowledged(outbox.put(clear("post2")))
    store.close()
    with Store(tmp_path / "robot.db") as store:
        again = Outbox(store)
        assert (again.journal, again.resume_from(), again.put(clear("post3"))) == (journal, 2, 2)


def test_a_new_database_is_a_new_journal(tmp_path: Path) -> None:
    with Store(tmp_path / "a.db") as a, Store(tmp_path / "b.db") as b:
        assert Outbox(a).journal != Outbox(b).journal


def test_a_renewed_journal_takes_over_what_still_waits(store: Store) -> None:
    outbox = Outbox(store)
    journal = outbox.journal
    for post in ("post2", "post3", "post4"):
        outbox.put(clear(post))
    outbox.acknowledged(1)
    outbox.renew_journal()
    assert outbox.journal != journal
    assert [kept.message for kept in outbox.pending()] == [clear("post3"), clear("post4")]
    assert (outbox.resume_from(), outbox.put(clear("post5"))) == (2, 4)


def test_what_is_replaced_by_newer_news_is_not_kept(store: Store) -> None:
    outbox = Outbox(store)
    hello = Hello(position=Position(), battery=Battery(ratio=1.0), software="0.1", map_version="m")
    with pytest.raises(NotDurable, match="hello is not kept"):
        outbox.put(hello)


@given(st.lists(st.one_of(st.none(), st.integers(0, 30)), max_size=25))
def test_whatever_was_put_and_not_acknowledged_is_pending(steps: list[int | None]) -> None:
    """None puts a message, a number acknowledges up to it."""
    store = Store(None)
    outbox, put, acknowledged = Outbox(store), 0, 0
    for step in steps:
        if step is None:
            put += 1
            assert outbox.put(clear("post2")) == put
        elif step <= put:  # a message that was never sent is never acknowledged
            acknowledged = max(acknowledged, step)
            outbox.acknowledged(step)
    assert [kept.seq for kept in outbox.pending()] == list(range(acknowledged + 1, put + 1))
    assert outbox.resume_from() == acknowledged + 1
    assert (outbox.waiting(), outbox.last_seq()) == (put - acknowledged, put)
    store.close()


def test_a_full_disk_is_named_and_leaves_nothing_half_written(tmp_path: Path) -> None:
    store = Store(tmp_path / "robot.db", max_bytes=128 * 1024)
    outbox, memory = Outbox(store), Memory(store)

    def fill() -> None:
        while True:
            outbox.put(a_fault("x" * 500))

    with pytest.raises(StorageFull, match="no room left"):
        fill()
    kept = outbox.waiting()
    with pytest.raises(StorageFull), store.transaction():
        memory.load("order-1")
        for _ in range(20):
            outbox.put(a_fault("x" * 500))
    assert memory.cargo() == ()
    assert outbox.waiting() == kept > 10
    outbox.acknowledged(kept)
    assert outbox.put(a_fault()) == outbox.last_seq()
    store.close()


def test_a_failure_that_somebody_caught_half_way_still_undoes_the_whole_transaction(store: Store) -> None:
    outbox, memory = Outbox(store), Memory(store)
    with pytest.raises(StorageFailed, match="all of it was undone"), store.transaction():
        memory.load("order-1")
        try:
            with store.transaction() as database:
                database.execute("INSERT INTO nowhere VALUES (1)")
        except StorageFailed:
            outbox.put(clear("post2"))
    assert (memory.cargo(), outbox.waiting()) == ((), 0)


def test_two_daemons_cannot_share_one_memory(tmp_path: Path) -> None:
    first = Store(tmp_path / "robot.db")
    with pytest.raises(StorageInUse, match="stop that robot daemon first"):
        Store(tmp_path / "robot.db")
    first.close()
    Store(tmp_path / "robot.db").close()


def test_a_file_of_a_later_version_is_refused(tmp_path: Path) -> None:
    Store(tmp_path / "robot.db").close()
    with sqlite3.connect(tmp_path / "robot.db") as database:
        database.execute("PRAGMA user_version = 99")
    database.close()
    with pytest.raises(StorageNewer, match="layout 99"):
        Store(tmp_path / "robot.db")


def test_a_file_that_is_no_database_is_refused(tmp_path: Path) -> None:
    (tmp_path / "robot.db").write_text("a letter, not a database " * 100)
    with pytest.raises(StorageFailed, match="not a database"):
        Store(tmp_path / "robot.db")


def test_a_folder_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(StorageFailed, match="nowhere"):
        Store(tmp_path / "nowhere" / "robot.db")
