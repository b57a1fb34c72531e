"""A corridor that the robot took for closed is open again because a person who has looked says so."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest

from protocol.parts import Leg
from protocol.to_robot import OpenWay
from protocol.to_server import CommandAnswer, Event, Fault
from robot.agent.actions.corridors import WAY_BLOCKED, tried_again
from robot.agent.navigator import Navigator
from robot.localization.closed import CLOSED_S
from robot.mission.memory import Incoming, Memory
from robot.mission.mission import MissionManager
from robot.mission.outbox import Outbox
from robot.mission.store import Store
from tests.plain_maps import plain_map

CAMPUS = plain_map("test_track")
STARTED_AT = datetime(2026, 1, 5, 9, tzinfo=UTC)
TO_POST3 = Leg(from_post="post2", to_post="post3")


@dataclass
class Robot:
    """Duties and navigator over one store, at a time that tests set."""

    store: Store
    now_s: float = 0.0
    online: bool = True
    _waiting: list[Incoming] = field(default_factory=list)
    _said: int = 0

    def __post_init__(self) -> None:
        self.missions = MissionManager(self.store, Memory(self.store), Outbox(self.store), self._utc, self)
        self.navigator = Navigator(CAMPUS, "post5", self.missions, self.now_s)

    def _utc(self) -> datetime:
        return STARTED_AT + timedelta(seconds=self.now_s)

    def incoming(self) -> list[Incoming]:
        taken, self._waiting = self._waiting, []
        return taken

    def wake(self) -> None:
        pass

    def turns_back(self, now_s: float, leg: Leg = TO_POST3) -> None:
        self.now_s = now_s
        self.navigator.closed.close(leg, now_s)

    def hears(self, now_s: float, *ends: str, looked_at_s: float | None = None, command_id: str = "c1") -> Any:
        """Return what the robot answers; None if it has nothing to say."""
        self.now_s = now_s
        self.navigator.closed.pass_time(now_s)
        (a, b), looked_s = ends, now_s if looked_at_s is None else looked_at_s
        self._said += 1
        wish = OpenWay(command_id=command_id, ends=(a, b), looked_at=STARTED_AT + timedelta(seconds=looked_s))
        self._waiting.append(Incoming(wish, "service", self._said))
        before = len(self.answers)
        self.missions.take_messages()
        return (self.answers[before:] or [None])[0]

    @property
    def answers(self) -> list[CommandAnswer]:
        told = [one.message for one in self.missions.outbox.pending(limit=100)]
        return [one.happened for one in told if isinstance(one, Event) and isinstance(one.happened, CommandAnswer)]

    @property
    def closed(self) -> frozenset[str]:
        return self.navigator.closed.names


@pytest.fixture
def store(tmp_path: Path) -> Iterator[Store]:
    store = Store(tmp_path / "robot.db")
    yield store
    store.close()


@pytest.mark.parametrize("ends", [("post2", "post3"), ("post3", "post2")])
def test_it_is_open_at_once_in_both_directions_and_stays_so_through_a_restart(store: Store, ends: Any) -> None:
    robot = Robot(store)
    robot.turns_back(10.0)
    robot.turns_back(20.0, Leg(from_post="post2", to_post="post4"))
    assert robot.hears(60.0, *ends).accepted
    assert robot.closed == {"post2-post4"}, "the other one is closed as before"
    assert Robot(store, now_s=70.0).closed == {"post2-post4"}


def test_a_message_that_comes_again_does_not_open_what_was_found_closed_since(store: Store) -> None:
    robot = Robot(store)
    robot.turns_back(10.0)
    assert robot.hears(60.0, "post2", "post3").accepted
    robot.turns_back(90.0)
    assert robot.hears(91.0, "post2", "post3", looked_at_s=60.0) is None, "answered before"
    again = Robot(store, now_s=92.0)
    assert again.hears(92.0, "post2", "post3", looked_at_s=60.0) is None, "known after a restart, too"
    assert again.closed == {"post2-post3"}


def test_a_robot_that_turned_back_after_somebody_looked_knows_better(store: Store) -> None:
    robot = Robot(store)
    robot.turns_back(90.0)
    refused = robot.hears(95.0, "post2", "post3", looked_at_s=60.0)
    assert (refused.accepted, refused.reason) == (
        False,
        "The robot has turned back between post2 and post3 again since.",
    )
    assert robot.closed == {"post2-post3"}


def test_a_corridor_that_its_map_does_not_have_is_refused_by_name(store: Store) -> None:
    robot = Robot(store)
    refused = robot.hears(5.0, "post1", "post9")
    assert not refused.accepted
    assert refused.reason == "There is no corridor between post1 and post9 on this robot's map."


def test_whatever_was_open_already_is_told_to_be_so_once_more(store: Store) -> None:
    """Its own word that it was over may have been lost with a power cut, and a person still believes it closed."""
    robot = Robot(store)
    assert robot.hears(5.0, "post2", "post3").accepted
    assert robot.navigator.closed.over == {"post2-post3"}


def test_each_corridor_is_over_by_itself(store: Store) -> None:
    robot = Robot(store)
    robot.turns_back(10.0)
    robot.turns_back(100.0, Leg(from_post="post2", to_post="post4"))
    robot.navigator.closed.pass_time(10.0 + CLOSED_S)
    assert robot.navigator.closed.over == {"post2-post3"}
    robot.navigator.closed.note_told()
    assert robot.navigator.closed.over == frozenset()
    assert Robot(store, now_s=100.0 + CLOSED_S).navigator.closed.over == {"post2-post3", "post2-post4"}, "told anew"


def test_of_several_faults_under_one_name_each_is_told(store: Store) -> None:
    missions = Robot(store).missions
    for reason, cleared, lasts in (("a", False, True), ("b", False, True), ("a", True, True), ("b", True, False)):
        missions.report_one_fault(WAY_BLOCKED, reason, "post2", cleared, lasts)
        assert (WAY_BLOCKED in missions.held.faults) == lasts
    told = [one.message.happened for one in missions.outbox.pending() if isinstance(one.message, Event)]
    assert [(one.reason, one.cleared) for one in told if isinstance(one, Fault)] == [
        *(("a", False), ("b", False)),
        *(("a", True), ("b", True)),
    ]
    assert tried_again("post2-post3") == "The robot tries the corridor between post2 and post3 again."
