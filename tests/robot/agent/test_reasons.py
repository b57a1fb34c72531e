"""The sentences that people read when they ask what the robot is doing and waiting for."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path

import pytest

from protocol.parts import Purpose, Stop, StopAction
from protocol.to_robot import Mission
from robot.agent.navigator import Navigator
from robot.agent.reasons import reason
from robot.drivers.interfaces import BaseState
from robot.mission.custody import Waiting
from robot.mission.memory import Incoming, Memory
from robot.mission.mission import MissionManager
from robot.mission.outbox import Outbox
from robot.mission.store import Store
from robot.skills.interfaces import View
from tests.plain_maps import plain_map

MISSION = Mission(id="m1", update=1, stops=(Stop(id="s1", post="post1", action=StopAction.LOAD, order_id="o1"),))


@dataclass
class Robot:
    missions: MissionManager
    navigator: Navigator

    def why(self, *under_way: str, view: View | None = None, charging: bool = False) -> tuple[str, str | None]:
        said = reason(under_way, view or View(), self.navigator, self.missions, charging)
        return said.sentence, said.waiting_for


@pytest.fixture
def robot(tmp_path: Path) -> Iterator[Robot]:
    store = Store(tmp_path / "robot.db")
    missions = MissionManager(store, Memory(store), Outbox(store), lambda: datetime(2026, 1, 5, tzinfo=UTC))
    navigator = Navigator(plain_map("test_track"), "post5", missions, now=0.0)
    navigator.place("post3", "post4")
    yield Robot(missions, navigator)
    store.close()


def test_what_it_waits_for_is_named(robot: Robot) -> None:
    sentence, waits_for = robot.why('wait_handover(load,"o1","s1",600)')
    assert (sentence, waits_for) == ("Waiting for the sender at post3", "the sender's code")
    assert robot.why("wait_handover(receive,o1,s2,600)")[1] == "the recipient's code"
    assert robot.why("claim(post4)")[1] == "permission from the server"


def test_a_pause_is_said_to_be_for_what_it_is_for(robot: Robot) -> None:
    assert robot.why("rest(15)") == ("Waiting a moment before trying again", None)


def test_hands_in_its_box_are_named_before_what_it_waited_for(robot: Robot) -> None:
    robot.missions.custody.wait(Waiting((MISSION, MISSION.stops[0]), Purpose.LOAD, "post3", handed_over=True))
    action = 'wait_handover(load,"o1","s1",600)'
    assert robot.why(action) == ("Giving people at post3 a moment to step back", None)


def test_out_of_network_it_says_that_it_waits_for_the_network(robot: Robot) -> None:
    class Unreachable:
        online = False

        def incoming(self) -> list[Incoming]:
            return []

        def wake(self) -> None:
            pass

    robot.missions.join(Unreachable())
    assert robot.why("claim(post4)") == ("Waiting at post3 for the network", "the network")


def test_a_base_that_does_not_answer_is_not_said_to_be_charging(robot: Robot) -> None:
    silent = View(base=BaseState(at_s=0.0, home_base=True), faults=frozenset({"base_silent"}))
    assert "Charging" not in robot.why(view=silent, charging=True)[0]


def test_on_its_way_it_says_where_to(robot: Robot) -> None:
    robot.navigator.leave()
    assert robot.why("follow_line") == ("Driving towards post4", None)


def test_a_fault_comes_before_everything_else(robot: Robot) -> None:
    view = replace(View(), faults=frozenset({"bump"}))
    assert robot.why("follow_line", view=view) == ("Something stands in the robot's way.", "a free way")


def test_a_robot_that_charges_with_a_mission_says_what_for(robot: Robot) -> None:
    docked = View(base=BaseState(at_s=0.0, home_base=True))
    assert robot.why(view=docked) == ("In its dock at post3", None)
    robot.missions.give(MISSION)
    assert robot.why(view=docked, charging=True) == ("Charging at post3", "a full battery")
    assert reason((), docked, robot.navigator, robot.missions, True).goal == "to collect mail at post1"


def test_an_action_nobody_has_words_for_is_not_named(robot: Robot) -> None:
    assert robot.why("dance(tango)") == ("Carrying out its program", None)
    assert robot.why("report(departed,s1)") == ("Carrying out its program", None)
