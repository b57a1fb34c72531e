"""The whole robot with our agent program in the simulated world: bytes, pins and pictures, no network."""

from pathlib import Path

import pytest

from protocol.parts import Purpose
from tests.robot.daemon.simulated_run import SimulatedRun

PROGRESS = [
    "progress accepted",
    "progress departed",
    "progress passed",
    "progress passed",
    "progress arrived",
    "handover load",
    "progress departed",
    "progress passed",
    "progress passed",
    "progress arrived",
    "handover receive",
    "progress done",
]


def test_a_letter_is_fetched_delivered_and_the_robot_goes_home(run: SimulatedRun) -> None:
    run.given_a_letter()
    run.until(lambda: run.waits_for("wait_handover(load"))
    assert run.visited == ["post5_bay1", "post5", "post3", "post2", "post1", "post1_bay2"]
    run.passes(10)
    assert run.waits_for("wait_handover(load"), "no code has been shown yet"
    run.shows(Purpose.RECEIVE)
    run.passes(5)
    assert run.missions.held.cargo == (), "the wrong code opens nothing"
    run.shows(Purpose.LOAD)
    run.until(lambda: run.missions.held.cargo == ("o1",), 10)
    run.until(lambda: run.waits_for("wait_handover(receive"))
    run.shows(Purpose.RECEIVE)
    run.until(lambda: run.missions.held.mission is None, 10)
    run.until(lambda: run.is_home)
    home = ["post4_bay2", "post4", "post3", "post5", "post5_bay1"]
    assert run.visited[5:] == ["post1_bay2", "post1", "post2", "post3", "post4", *home]
    assert [one for one in run.told() if one != "occupancy"] == PROGRESS
    assert run.bays == ["post5_bay1", "post1_bay2", "post4_bay2", "post5_bay1"]


@pytest.mark.nightly
def test_a_battery_low_with_mail_aboard_is_charged_and_each_thing_told_once(run: SimulatedRun) -> None:
    run.given_a_letter()
    run.until(lambda: run.waits_for("wait_handover(load"))
    run.shows(Purpose.LOAD)
    run.until(lambda: run.is_at("post2"))
    run.robot.sag(0.2)
    run.until(lambda: run.robot.docked)
    run.until(lambda: not run.robot.docked)
    run.until(lambda: run.waits_for("wait_handover(receive"))
    told = run.told()
    assert [one for one in told if one.startswith("charge")] == ["charge low", "charge charging", "charge charged"]
    assert told.count("progress departed") == 2
    assert told.count("handover load") == 1


@pytest.mark.nightly
def test_a_change_of_mind_just_before_a_post_does_not_drive_it_past_the_post(run: SimulatedRun) -> None:
    """So near it does not see the marker again, and the line bends there."""
    run.given_a_letter()
    run.until(lambda: run.waits_for("wait_handover(load"))
    run.shows(Purpose.LOAD)
    run.until(lambda: run.missions.held.cargo and (run.parts.navigator.sighted or ("",))[0] == "post2")
    run.until(lambda: run.robot.pose.y_m < 2.12)
    run.robot.sag(0.2)
    run.until(lambda: run.robot.docked, 90)
    assert "find_line" not in run.did


@pytest.mark.nightly
def test_a_recipient_who_never_comes_does_not_keep_the_robot(run: SimulatedRun) -> None:
    run.given_a_letter()
    run.until(lambda: run.waits_for("wait_handover(load"))
    run.shows(Purpose.LOAD)
    run.until(lambda: run.waits_for("wait_handover(receive"))
    run.until(lambda: run.is_home, 900)
    assert run.visited.count("post1") == 2, "it tried to give the mail back to its sender"
    assert run.missions.held.cargo == ("o1",), "the mail stays aboard and is known to be"
    assert run.told()[-3:] == ["progress gave_up", "progress done", "fault mail_aboard"]


@pytest.mark.nightly
def test_killed_on_the_way_with_mail_it_wakes_up_knowing_and_delivers(tmp_path: Path) -> None:
    first = SimulatedRun(tmp_path)
    first.given_a_letter()
    first.until(lambda: first.waits_for("wait_handover(load"))
    first.shows(Purpose.LOAD)
    first.until(lambda: first.is_at("post2"))
    first.passes(6)
    pose = first.robot.pose
    first.kill()

    second = SimulatedRun(tmp_path)
    assert abs(second.robot.pose.x_m - pose.x_m) < 0.15, "the robot stands where it stood"
    assert second.missions.held.cargo == ("o1",)
    second.until(lambda: second.waits_for("wait_handover(receive"))
    second.shows(Purpose.RECEIVE)
    second.until(lambda: second.missions.held.mission is None, 10)
    told = second.told()
    second.close()
    assert told == PROGRESS


@pytest.mark.slow
def test_killed_while_it_waits_for_the_sender_it_goes_on_waiting_there(tmp_path: Path) -> None:
    first = SimulatedRun(tmp_path, start="post2:post1")
    first.given_a_letter()
    first.until(lambda: first.waits_for("wait_handover(load"))
    first.passes(2)
    first.kill()

    second = SimulatedRun(tmp_path)
    second.until(lambda: second.waits_for("wait_handover(load"), 10)
    second.shows(Purpose.LOAD)
    second.until(lambda: second.is_at("post3"))
    second.close()


@pytest.mark.slow
def test_somebody_in_the_way_is_waited_for(run: SimulatedRun) -> None:
    run.asks("", "visit(post4)")
    run.until(lambda: run.is_at("post3"))
    run.passes(3)
    run.robot.bump("both")
    run.until(lambda: "bump" in run.mind.hands.view.faults, 5)
    run.until(lambda: run.is_at("post4"))
    assert run.told().count("fault bump") == 2, "that it happened, and that it is over"


@pytest.mark.slow
def test_a_lifted_robot_stands_until_it_is_put_down_and_let_go_and_then_goes_on(run: SimulatedRun) -> None:
    run.asks("", "visit(post4)")
    run.until(lambda: run.is_at("post3"))
    run.passes(3)
    run.robot.lift(True)
    run.passes(5)
    assert run.mind.hands.view.sent.still
    assert not run.waits_for("follow_line")
    run.robot.lift(False)
    run.passes(5)
    assert run.mind.hands.view.sent.still, "no person has let it go yet"
    run.missions.rearm_asked = True
    run.until(lambda: run.is_at("post4"))


def test_an_emergency_stop_outlives_a_restart(tmp_path: Path) -> None:
    first = SimulatedRun(tmp_path, start="post3:post4")
    first.asks("", "visit(post4)")
    first.until(lambda: first.robot.driven_mm > 50)
    first.mind.hands.body.emergency_stop()
    first.passes(2)
    first.kill()

    second = SimulatedRun(tmp_path)
    second.asks("", "visit(post4)")
    second.passes(5)
    assert second.robot.driven_mm < 5
    assert second.mind.activity() == "stopped"
    second.missions.rearm_asked = True
    second.until(lambda: second.is_at("post4"))
    second.close()
