"""A plain code that a stranger shows to the camera: the robot believes only what map and wheels allow."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from protocol.parts import Leg
from robot.mission.store import Store
from robot.simulated.start import start_pose
from tests.robot.agent.walk import CAMPUS, Walk
from tests.robot.daemon.simulated_run import SimulatedRun

LEG = Leg(from_post="post2", to_post="post3")


@pytest.fixture
def walk(tmp_path: Path) -> Iterator[Walk]:
    """At post2, looking along its corridor to post3, which it was granted."""
    with Store(tmp_path / "robot.db") as store:
        walk = Walk(store)
        walk.look()
        walk.missions.memory.grant([LEG])
        walk.navigator.place("post2", "post3")
        yield walk


def shown(walk: Walk, post: str) -> None:
    walk.body.sees(post)
    walk.look()


def is_on_its_way(walk: Walk) -> bool:
    where = walk.navigator.at, walk.navigator.corridor, walk.navigator.towards, walk.missions.held.grants
    return where == (None, LEG, "post3", (LEG,))


@pytest.mark.parametrize("post", ["post1", "post2", "post3", "post4", "post5"])
def test_in_the_middle_of_a_corridor_no_code_is_believed_and_people_are_told(walk: Walk, post: str) -> None:
    walk.navigator.leave()
    walk.body.rolls(900.0)
    shown(walk, post)
    walk.body.rolls(300.0)
    walk.look()
    assert is_on_its_way(walk)
    assert "foreign_marker" in walk.missions.held.faults
    walk.body.rolls(500.0)
    shown(walk, "post3")
    walk.body.rolls(300.0)
    walk.look()
    assert walk.navigator.at == "post3"
    assert "foreign_marker" not in walk.missions.held.faults, "the marker that was expected says that all is well"


@pytest.mark.parametrize("post", ["post1", "post3", "post4", "post5"])
def test_a_robot_that_stands_at_a_post_believes_no_other(walk: Walk, post: str) -> None:
    shown(walk, post)
    assert walk.navigator.at == "post2"
    walk.navigator.leave()
    walk.body.rolls(300.0)
    walk.look()
    assert is_on_its_way(walk)


def test_the_code_of_the_post_where_it_stands_does_not_send_it_on(walk: Walk) -> None:
    shown(walk, "post2")
    assert walk.navigator.at == "post2"


@pytest.mark.parametrize("counted", [0.93, 1.0, 1.07])
def test_worn_wheels_do_not_make_the_real_marker_foreign(walk: Walk, counted: float) -> None:
    walk.navigator.leave()
    walk.body.rolls(1700.0 * counted)
    shown(walk, "post3")
    walk.body.rolls(300.0)
    walk.look()
    assert walk.navigator.at == "post3"


def test_a_search_on_the_way_leaves_more_room(walk: Walk) -> None:
    walk.navigator.leave()
    walk.body.searched()
    walk.body.rolls(1300.0)
    shown(walk, "post3")
    walk.body.rolls(300.0)
    walk.look()
    assert walk.navigator.at == "post3"


def test_the_dock_agrees_with_a_marker_that_was_not_believed(walk: Walk) -> None:
    walk.navigator.leave()
    walk.body.rolls(700.0)
    shown(walk, "post5")
    assert is_on_its_way(walk)
    walk.body.battery(0.5, docked=True)
    walk.look()
    assert walk.navigator.at == "post5"
    assert "foreign_marker" not in walk.missions.held.faults


@pytest.mark.slow
def test_a_robot_that_drives_stops_at_no_code_of_a_stranger(run: SimulatedRun) -> None:
    run.asks("", "visit(post2)")
    run.until(lambda: run.is_at("post3") and run.robot.pose.x_m < 1.3)
    run.robot.show_code("post1", 3.0)
    run.until(lambda: "fault foreign_marker" in run.told(), 5)
    run.until(lambda: run.is_at("post2"), 60)
    assert run.visited == ["post5_bay1", "post5", "post3", "post2"]
    assert run.told().count("fault foreign_marker") == 2, "begun and over"


@pytest.mark.nightly
def test_carried_on_a_trolley_it_is_found_out_by_the_second_marker(run: SimulatedRun) -> None:
    run.asks("", "visit(post1)")
    run.until(lambda: run.is_at("post2"))
    run.until(lambda: run.parts.navigator.corridor is not None and run.robot.pose.y_m > 2.4)
    run.robot.place(start_pose(CAMPUS, "post4:post3"))
    run.until(lambda: run.is_at("post1"), 600)
    assert run.robot.pose.y_m > 3.6
