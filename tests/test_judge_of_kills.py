"""The judge of the kills notices a robot that forgot, and has nothing against one that did not."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from benchmarks.body.kills_judge import Facts, judged_disk, judged_hello
from benchmarks.body.kills_robot import Remembered, remembered
from benchmarks.body.kills_service import Service, told_twice
from benchmarks.body.played_server import AT, from_server
from protocol.parts import Battery, Leg, Position, Purpose, Received, Stop, StopAction
from protocol.proofs import ShownCode
from protocol.to_robot import Grant, Mission
from protocol.to_server import Claim, Hello, Step
from robot.mission.memory import Memory
from robot.mission.mission import MissionManager
from robot.mission.outbox import Outbox
from robot.mission.store import Store

LOAD = Stop(id="s1", post="post1", action=StopAction.LOAD, order_id="o1")
RECEIVE = Stop(id="s2", post="post4", action=StopAction.RECEIVE, order_id="o1")
LETTER = Mission(id="m1", update=1, stops=(LOAD, RECEIVE))
LEG, OTHER_LEG = Leg(from_post="post1", to_post="post2"), Leg(from_post="post2", to_post="post4")
GRANT = Grant(claim_id="c1", legs=(LEG,))

Forgets = Callable[[Memory, Outbox], object]


def loaded(folder: Path, then: Forgets = lambda memory, outbox: None) -> Facts:
    """A robot that took a letter aboard on its way from post1, claims and holds a corridor, was killed, and `then`."""
    with Store(folder / "robot.db") as store:
        memory, outbox = Memory(store), Outbox(store)
        memory.resume("server-journal", 1)
        for seq, message in enumerate((LETTER, GRANT), start=1):
            memory.receive(from_server(message, seq))
        missions = MissionManager(store, memory, outbox, lambda: AT)
        missions.report(Step.ARRIVED, "s1", "post1")
        missions.handed_over((LETTER, LOAD), Purpose.LOAD, "post1", ShownCode("a" * 64, b"key"))
        told = {kept.seq: kept.message for kept in outbox.pending()}
        outbox.put(Claim(claim_id="c2", legs=(OTHER_LEG,)))  # which the server has not heard yet
        outbox.acknowledged(1)
        then(memory, outbox)
    return Facts(Service(said=[LETTER, GRANT], told=told, taken=2), LETTER, remembered(folder))


def test_a_robot_that_knows_everything_is_not_blamed(tmp_path: Path) -> None:
    facts = loaded(tmp_path)
    assert judged_disk(facts) == []
    assert judged_hello(facts, hello_of(facts.disk)) == []


@pytest.mark.parametrize(
    ("forgets", "sentence"),
    [
        (lambda memory, _: memory.unload("o1"), "cargo is (), must be ('o1',)"),
        (lambda memory, _: memory.load("o2"), "cargo is ('o1', 'o2'), must be ('o1',)"),
        (lambda memory, _: memory.clear(LEG), "grants are [], must be"),
        (lambda memory, _: memory.grant([OTHER_LEG]), "grants are ["),
        (lambda memory, _: memory.reach(0), "mission is id='m1' update=1 next_stop=0, must be id='m1'"),
        (lambda memory, _: memory.reach(2), "mission is id='m1' update=1 next_stop=2, must be id='m1'"),
        (lambda memory, _: memory.drop_mission(), "mission is None, must be id='m1'"),
        (lambda _, outbox: outbox.acknowledged(3), "reports are lost: [3]"),
    ],
)
def test_what_is_not_on_the_disk_as_it_must_be_is_named(forgets: Forgets, sentence: str, tmp_path: Path) -> None:
    (found,) = judged_disk(loaded(tmp_path, forgets))
    assert found.startswith(sentence)


def test_a_robot_that_spoke_or_acknowledged_before_it_was_on_the_disk_is_found_out(tmp_path: Path) -> None:
    facts = loaded(tmp_path)
    facts.service.told[3] = facts.disk.pending[3]
    facts.service.told[4] = Claim(claim_id="c3", legs=(LEG,))
    facts.service.taken = 3
    assert judged_disk(facts) == [
        "it acknowledged 3 and has 2 on its disk",
        "it told number 4 and would number on from 3",
    ]
    facts.service.told[3] = facts.service.told.pop(4)
    facts.service.taken = 2
    assert "other reports under numbers that were told: [3]" in judged_disk(facts)


def test_a_report_that_comes_again_under_another_number_was_told_twice(tmp_path: Path) -> None:
    told = loaded(tmp_path).service.told
    assert told_twice(told) == []
    assert len(told_twice(told | {number + 10: message for number, message in told.items()})) == len(told)


@pytest.mark.parametrize(
    ("said", "sentence"),
    [
        ({"cargo": ()}, "hello: cargo is (), on the disk ('o1',)"),
        ({"mission": None}, "hello: mission is None, on the disk id='m1'"),
        ({"position": Position(post="post3")}, "hello: last post is post3, on the disk post1"),
        ({"received": Received()}, "hello: received is "),
        ({"resume_from": 1}, "hello: resume_from is 1, on the disk 2"),
    ],
)
def test_what_the_restarted_daemon_says_must_be_what_was_on_its_disk(
    said: dict[str, Any], sentence: str, tmp_path: Path
) -> None:
    facts = loaded(tmp_path, lambda memory, _: memory.see("post1", AT))
    (found,) = judged_hello(facts, hello_of(facts.disk).model_copy(update=said))
    assert found.startswith(sentence)


def hello_of(disk: Remembered) -> Hello:
    return Hello(
        received=disk.received,
        resume_from=disk.resume_from,
        position=disk.position,
        cargo=disk.cargo,
        mission=disk.mission,
        battery=Battery(ratio=0.5, charging=False),
        software="test",
        map_version="test",
    )
