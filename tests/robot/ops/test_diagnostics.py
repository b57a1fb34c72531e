"""Live diagnostics of a robot's mind while a person watches, and silence otherwise."""

import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from benchmarks.body.played_server import playing
from protocol.clock import SteppedClock
from protocol.diagnostics import MAX_DIAGNOSTICS_BYTES, Diagnostics, LeftOut, TraceLine
from protocol.parts import Stop, StopAction
from protocol.to_robot import Mission, Watch
from robot.core.config import load_settings
from robot.mission.memory import Memory
from robot.mission.outbox import Outbox
from robot.mission.store import Store
from robot.ops.assembly import Parts, Simulation, assemble
from robot.ops.diagnostics import DiagnosticsReporter
from robot.ops.diagnostics.service import MOST_LINES, within_bounds
from robot.ops.runners import LockstepRunner
from tests.robot.linked_robot import Robot, until

LETTER = Mission(id="m1", update=1, stops=(Stop(id="s1", post="post4", action=StopAction.LOAD, order_id="o1"),))


@dataclass
class Shown:
    """A link that keeps what it is given to send; `has_room` false is a network that takes nothing."""

    told: list[Diagnostics] = field(default_factory=list)
    has_room: bool = True

    def has_room_for_diagnostics(self) -> bool:
        return self.has_room

    def tell_diagnostics(self, diagnostics: Callable[[], Diagnostics]) -> None:
        self.told.append(diagnostics())


class WatchedRobot:
    """A simulated robot that is watched, in stepped time."""

    def __init__(self, folder: Path) -> None:
        self.clock, self.shown = SteppedClock(), Shown()
        settings = load_settings(None, {"home": "post5_bay1", "data": folder, "rates.line_hz": 50.0})
        self.parts: Parts = assemble(settings, self.clock, Simulation("dock:post5", seed=1, in_memory=True))
        self.runner = LockstepRunner(self.parts.daemon.loops(), self.clock)
        self.agent = self.parts.mind.agent
        self.reporter = DiagnosticsReporter(
            self.parts.mind, self.shown, self.runner.lags, self.clock.utc, self.clock.now
        )
        self._until_s = 0.0
        self.parts.daemon.watchers = (self.reporter.look, self._end)

    def _end(self, now: float) -> None:
        if now >= self._until_s:
            self.runner.stop()

    def lives(self, for_s: float) -> list[Diagnostics]:
        """Let time pass; what was told in it."""
        before, self._until_s = len(self.shown.told), self.clock.now() + for_s
        self.runner.restart()
        self.runner.run()
        return self.shown.told[before:]


@pytest.fixture
def watched(tmp_path: Path) -> Iterator[WatchedRobot]:
    robot = WatchedRobot(tmp_path)
    yield robot
    robot.parts.daemon.close(robot.runner.now_s)


def test_nobody_watches_nothing_is_told_and_nobody_listens_to_the_agent(watched: WatchedRobot) -> None:
    assert watched.lives(2.0) == []
    assert not watched.agent.output.listeners


def test_who_watches_sees_what_it_intends_by_which_plan_and_why(watched: WatchedRobot) -> None:
    watched.reporter.watch(30.0, whole=True)
    watched.lives(1.0)
    watched.parts.mind.hands.missions.give(LETTER)
    told = watched.lives(9.0)
    assert 15 <= len(told) <= 19, "twice a second"
    (driving,) = told[-1].intentions
    goals = [means.goal for means in driving.stack]
    assert goals[:3] == ["+!pursue(mission(m1,s1))", "+!fulfil(mission(m1,s1))", "+!serve(s1,post4,load,o1,600)"]
    assert (driving.state, driving.because.kind, driving.because.what) == ("action", "action", "follow_line")
    assert driving.because.sentence.startswith("follow(1) waits for action follow_line of plan ")
    travelling = next(means for means in driving.stack if means.goal == "+!go_to(post4)")
    assert travelling.place and travelling.place.startswith("travel.asl:")
    assert "at(post4) does not hold (believed: at(post5_bay1), at(post5))" in {
        one.why for one in travelling.passed_over
    }
    assert told[-1].sensors.skill == "follow_line"
    assert told[-1].sensors.wheels_mm_s[0] > 0
    chosen = [line for one in told for line in one.trace if line.kind == "chose"]
    assert "+!go_to(post4)" in {line.text for line in chosen}


def test_beliefs_are_told_once_and_then_only_what_came_and_went(watched: WatchedRobot) -> None:
    watched.reporter.watch(30.0, whole=True)
    first, *later = watched.lives(3.0)
    assert (first.number, first.whole) == (1, True)
    assert [one.number for one in later] == list(range(2, len(later) + 2))
    believed = set(first.came)
    watched.parts.mind.hands.missions.give(LETTER)
    for one in (*later, *watched.lives(8.0)):
        assert not one.whole
        assert set(one.went) <= believed
        assert not set(one.came) & believed
        believed = believed - set(one.went) | set(one.came)
    assert believed == {str(belief) for belief in watched.agent.beliefs}
    watched.reporter.watch(30.0, whole=True)
    again = watched.lives(0.6)[0]
    assert (again.number, again.whole, again.went) == (1, True, ()), "for a person who has just begun to look"
    assert "mission(m1,1)[source(percept)]" in believed & set(again.came)


def test_it_ends_by_itself_when_nobody_says_that_they_still_look(watched: WatchedRobot) -> None:
    watched.reporter.watch(2.0, whole=False)
    assert len(watched.lives(5.0)) == 4
    assert not watched.agent.output.listeners
    assert not watched.agent.choices


@pytest.mark.nightly
def test_a_slow_network_makes_it_rarer_and_what_was_dropped_is_counted(watched: WatchedRobot) -> None:
    watched.reporter.watch(60.0, whole=True)
    watched.lives(1.0)
    watched.shown.has_room = False
    watched.parts.mind.hands.missions.give(LETTER)
    assert watched.lives(30.0) == []
    watched.shown.has_room = True
    (next_one, *_) = watched.lives(1.0)
    assert len(next_one.trace) == MOST_LINES
    assert next_one.left_out.trace > 0


def test_an_insight_is_never_larger_than_a_message_may_be(watched: WatchedRobot) -> None:
    watched.reporter.watch(5.0, whole=True)
    diagnostics = watched.lives(1.0)[0]
    line = TraceLine(cycle=1, kind="chose", text="ä" * 300)
    large = diagnostics.model_copy(update={"trace": (line,) * MOST_LINES, "came": ("ö" * 300,) * 400})
    bounded = within_bounds(large)
    assert len(bounded.model_dump_json().encode()) <= MAX_DIAGNOSTICS_BYTES
    assert len(bounded.trace) + bounded.left_out.trace == MOST_LINES
    assert len(bounded.came) + bounded.left_out.beliefs == 400
    assert diagnostics.left_out == LeftOut()


async def test_the_link_hears_of_a_watch_and_sends_one_insight_after_the_other(
    tmp_path: Path, watched: WatchedRobot
) -> None:
    watched.reporter.watch(5.0, whole=True)
    diagnostics = watched.lives(1.0)[0]
    with Store(tmp_path / "link.db") as store:
        robot = Robot(store, Outbox(store), Memory(store))
        async with playing() as server, robot.linked(server.url) as link:
            heard: list[Watch] = []
            link.on_watch = heard.append
            assert not link.has_room_for_diagnostics(), "no service is connected yet"
            await until(lambda: link.online)
            await server.send(Watch(for_s=30.0, whole=True))
            await until(lambda: heard == [Watch(for_s=30.0, whole=True)])
            made_in: list[str] = []
            looked = threading.Event()

            def make() -> Diagnostics:
                assert looked.wait(5)
                made_in.append(threading.current_thread().name)
                return diagnostics

            link.tell_diagnostics(make)
            assert not link.has_room_for_diagnostics()
            looked.set()
            await until(lambda: server.types()[-1] == "insight" and link.has_room_for_diagnostics())
            assert server.heard[-1].body == diagnostics
            assert made_in == ["link"], "the mind does not wait until it is written down"
