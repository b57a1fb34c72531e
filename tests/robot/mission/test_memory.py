"""The robot's memory after a power cut."""

import os
import random
import signal
import subprocess
import sys
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol.envelope import Envelope, type_of
from protocol.parts import Leg, Part, Position, Purpose, Received, Stop, StopAction
from protocol.sequence import Reception
from protocol.to_robot import Cancel, Grant, Mission, Verifier, Verifiers
from robot.mission.memory import Incoming, Memory
from robot.mission.mission_updates import MissionConflict
from robot.mission.outbox import Outbox
from robot.mission.store import Store

AT = datetime(2026, 1, 5, 9, 0, tzinfo=UTC)
LOAD = Stop(id="s1", post="post1", action=StopAction.LOAD, order_id="o1")
RECEIVE = Stop(id="s2", post="post4", action=StopAction.RECEIVE, order_id="o1")
PARK = Stop(id="s3", post="post5", action=StopAction.PARK)
MISSION = Mission(id="m1", update=1, stops=(LOAD, RECEIVE))
LEG, OTHER_LEG = Leg(from_post="post1", to_post="post2"), Leg(from_post="post2", to_post="post3")


def a_verifier(purpose: Purpose, digit: str) -> Verifier:
    return Verifier(order_id="o1", purpose=purpose, sha256=digit * 64, expires_at=AT)


def from_server(message: Part, seq: int, journal: str = "server") -> Envelope:
    return Envelope(type=type_of(message), robot="r1", journal=journal, seq=seq, at=AT, body=message)


def test_everything_is_known_again_after_a_restart(tmp_path: Path) -> None:
    with Store(tmp_path / "robot.db") as store:
        memory = Memory(store)
        memory.hold(MISSION)
        memory.reach(1)
        memory.load("o1")
        memory.keep_verifiers(
            Verifiers(verifiers=(a_verifier(Purpose.LOAD, "a"), a_verifier(Purpose.RECEIVE, "b"))), AT
        )
        memory.grant((LEG, OTHER_LEG))
        memory.clear(LEG)
        memory.see("post1", AT, towards="post2")
        memory.see("post2", AT + timedelta(seconds=9))
        memory.first_time("m1", "departed s1")
    with Store(tmp_path / "robot.db") as store:
        memory = Memory(store)
        assert (memory.mission(), memory.next_stop(), memory.cargo()) == (MISSION, 1, ("o1",))
        assert memory.grants() == (OTHER_LEG,)
        assert [verifier.purpose for verifier in memory.verifiers()] == [Purpose.LOAD, Purpose.RECEIVE]
        seen_at = AT + timedelta(seconds=9)
        assert memory.position() == Position(post="post2", previous="post1", towards=None, seen_at=seen_at)
        assert not memory.first_time("m1", "departed s1")
        assert memory.first_time("m1", "departed s2")


def test_the_same_mission_again_changes_nothing_and_an_older_update_neither(store: Store) -> None:
    memory = Memory(store)
    newer = Mission(id="m1", update=2, stops=(LOAD, RECEIVE, PARK))
    assert memory.hold(newer)
    memory.reach(2)
    assert not memory.hold(newer)
    assert not memory.hold(MISSION)
    assert (memory.mission(), memory.next_stop()) == (newer, 2)


def test_what_was_done_is_not_done_again_by_an_update_that_comes_when_the_mission_is_over(store: Store) -> None:
    """Without network it was unknown: an update that lets it wait longer, say, was under way."""
    memory = Memory(store)
    memory.hold(MISSION)
    for stop in MISSION.stops:
        memory.pass_stop(stop.id)
    memory.drop_mission()
    memory.hold(Mission(id="return-1", update=1, stops=(PARK,)))
    memory.drop_mission()
    memory.hold(Mission(id="m1", update=2, stops=(LOAD, RECEIVE, PARK)))
    assert memory.next_stop() == 2, "what is new is still to come"
    memory.drop_mission()
    memory.hold(Mission(id="m2", update=1, stops=(LOAD,)))
    assert memory.next_stop() == 0, "another mission is another one"


def test_other_stops_under_the_same_number_are_an_error_and_the_first_are_kept(store: Store) -> None:
    memory = Memory(store)
    memory.hold(MISSION)
    with pytest.raises(MissionConflict, match="m1 update 1"):
        memory.hold(Mission(id="m1", update=1, stops=(RECEIVE,)))
    assert memory.mission() == MISSION


def test_an_update_keeps_done_what_was_done(store: Store) -> None:
    memory = Memory(store)
    memory.hold(MISSION)
    memory.reach(1)
    memory.hold(Mission(id="m1", update=2, stops=(LOAD, PARK, RECEIVE)))
    assert memory.next_stop() == 1
    memory.hold(Mission(id="m1", update=3, stops=(RECEIVE,)))
    assert memory.next_stop() == 0
    memory.hold(Mission(id="m2", update=1, stops=(LOAD, PARK)))
    assert memory.next_stop() == 0


def test_what_was_given_up_is_not_begun_again_though_an_update_puts_new_stops_before_it(store: Store) -> None:
    """The service did not know of it yet when it sent the robot to another sender first."""
    memory = Memory(store)
    memory.hold(MISSION)
    memory.pass_stop("s2")
    another = Stop(id="s4", post="post2", action=StopAction.LOAD, order_id="o2")
    for update in (2, 3):
        memory.hold(Mission(id="m1", update=update, stops=(another, RECEIVE, PARK)))
        assert memory.next_stop() == 0
    memory.pass_stop("s4")
    assert memory.next_stop() == 2
    memory.hold(Mission(id="m2", update=1, stops=(RECEIVE,)))
    assert memory.next_stop() == 0


def test_a_newer_code_takes_the_place_of_the_older_and_used_ones_are_forgotten(store: Store) -> None:
    memory = Memory(store)
    memory.keep_verifiers(Verifiers(verifiers=(a_verifier(Purpose.LOAD, "a"),)), AT)
    memory.keep_verifiers(Verifiers(verifiers=(a_verifier(Purpose.LOAD, "c"),)), AT)
    assert [verifier.sha256 for verifier in memory.verifiers()] == ["c" * 64]
    memory.forget_verifiers("o1")
    assert memory.verifiers() == ()


def test_codes_that_have_expired_do_not_pile_up(store: Store) -> None:
    memory = Memory(store)
    memory.keep_verifiers(Verifiers(verifiers=(a_verifier(Purpose.LOAD, "a"),)), AT)
    memory.keep_verifiers(Verifiers(verifiers=(a_verifier(Purpose.RECEIVE, "b"),)), AT + timedelta(seconds=1))
    assert [verifier.sha256 for verifier in memory.verifiers()] == ["b" * 64]


def test_mail_is_aboard_once_however_often_it_is_loaded(store: Store) -> None:
    memory = Memory(store)
    for order_id in ("o1", "o2", "o1"):
        memory.load(order_id)
    assert memory.cargo() == ("o2", "o1")
    memory.unload("o2")
    assert memory.cargo() == ("o1",)


def test_a_new_message_takes_effect_and_waits_to_be_handled(store: Store) -> None:
    memory = Memory(store)
    memory.resume("server", 1)
    cancel = Cancel(command_id="c1", order_id="o1")
    messages = [MISSION, Grant(claim_id="k1", legs=(LEG,)), cancel]
    for seq, message in enumerate(messages, 1):
        assert memory.receive(from_server(message, seq)).reception is Reception.NEW
    assert memory.received() == Received(journal="server", seq=3)
    assert (memory.mission(), memory.grants()) == (MISSION, (LEG,))
    memory.handled(Incoming(MISSION, "server", 1))
    assert [incoming.message for incoming in memory.unhandled()] == messages[1:]


@given(st.lists(st.integers(1, 8), max_size=40))
def test_whatever_comes_in_whatever_order_is_taken_once_and_in_order(numbers: list[int]) -> None:
    with Store(None) as store:
        memory = Memory(store)
        memory.resume("server", 1)
        for seq in numbers:
            memory.receive(from_server(Cancel(command_id=f"c{seq}", order_id="o1"), seq))
        taken = [incoming.seq for incoming in memory.unhandled()]
        assert taken == list(range(1, memory.received().seq + 1))
        expected = 0
        for seq in numbers:
            expected += seq == expected + 1
        assert memory.received().seq == expected


HAND_OVER = """
import sys
from pathlib import Path
from protocol.parts import Leg
from protocol.to_server import Clear
from robot.mission.memory import Memory
from robot.mission.outbox import Outbox
from robot.mission.store import Store

store = Store(Path(sys.argv[1]))
memory, outbox = Memory(store), Outbox(store)
print("ready", flush=True)
number = 0
while True:
    number += 1
    with store.transaction():
        memory.load(f"o{number}")
        if number > 1:
            memory.unload(f"o{number - 1}")
        memory.reach(number)
        seq = outbox.put(Clear(leg=Leg(from_post="post1", to_post=f"post{number}")))
    print(seq, flush=True)
"""


def test_a_kill_at_any_moment_loses_nothing_that_was_said_to_be_kept_and_leaves_no_half(tmp_path: Path) -> None:
    """Cargo, next stop and outbox move together in one transaction; the killed process printed what was durable."""
    chance = random.Random(2)
    for attempt in range(4):
        database = tmp_path / f"robot{attempt}.db"
        process = subprocess.Popen(
            [sys.executable, "-c", HAND_OVER, str(database)],
            stdout=subprocess.PIPE,
            text=True,
            cwd=Path(__file__).parents[3],
            env={**os.environ, "PYTHONPATH": "."},
        )
        assert process.stdout is not None
        with process, process.stdout as said:
            lines = [said.readline() for _ in range(chance.randint(2, 60))]  # the first one is "ready"
            process.send_signal(signal.SIGKILL)
            durable = len([*lines, *said.readlines()]) - 1
        with Store(database) as store:
            memory, outbox = Memory(store), Outbox(store)
            reached = memory.next_stop()
            assert reached >= durable
            assert outbox.last_seq() == outbox.waiting() == reached
            assert memory.cargo() == ((f"o{reached}",) if reached else ())
    assert process.returncode == -signal.SIGKILL


def test_the_home_that_the_service_gave_survives_a_restart(store: Store) -> None:
    assert Memory(store).home() is None
    Memory(store).keep_home("post4_bay2")
    assert Memory(store).home() == "post4_bay2"
