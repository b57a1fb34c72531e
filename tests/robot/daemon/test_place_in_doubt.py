"""Where the robot is, when it cannot tell: after a kill just before a post, and after an error of the map."""

from pathlib import Path

import pytest

from maps import UnknownCorridor
from robot.drivers.interfaces import WheelSpeeds
from robot.scenarios.places import corridor_at
from robot.simulated.start import start_pose
from robot.skills.interfaces import View
from tests.robot.daemon.simulated_run import SimulatedRun


def killed_before_post3(folder: Path, left_mm: float) -> None:
    """On its way to post1: at post3 it would turn into the corridor to post2."""
    first = SimulatedRun(folder)
    first.asks("", "visit(post2)")
    first.until(lambda: first.is_at("post3") or way_left_mm(first) < left_mm)
    assert not first.is_at("post3")
    first.kill()


def way_left_mm(run: SimulatedRun) -> float:
    post = run.parts.navigator.campus.post("post3")
    return 1000 * abs(run.robot.pose.y_m - post.y_m)


@pytest.mark.parametrize("left_mm", [45.0, 120.0, 290.0])
@pytest.mark.nightly
def test_killed_just_before_a_post_it_finds_its_marker_before_it_drives_on(tmp_path: Path, left_mm: float) -> None:
    killed_before_post3(tmp_path, left_mm)
    second = SimulatedRun(tmp_path)
    second.asks("", "visit(post2)")
    corridors = set[str | None]()
    second.until(lambda: second.is_at("post3") or corridors.add(corridor_of(second)))
    assert corridors <= {"post3-post5", None}
    second.until(lambda: second.is_at("post2"))
    assert second.visited == ["post3", "post2"]
    assert "fault place_unknown" not in second.told()
    second.close()


def corridor_of(run: SimulatedRun) -> str | None:
    return corridor_at(run.parts.navigator.campus, run.robot.pose.x_m, run.robot.pose.y_m)


@pytest.mark.nightly
def test_without_its_marker_it_stands_and_says_so_until_it_is_put_down_elsewhere(tmp_path: Path) -> None:
    killed_before_post3(tmp_path, 60.0)
    second = SimulatedRun(tmp_path)
    second.robot.soil({"post3": 1.0})
    second.asks("", "visit(post2)")
    second.until(lambda: "fault place_unknown" in second.told(), 60)
    stood_mm = second.robot.driven_mm
    second.passes(30)
    assert second.robot.driven_mm == stood_mm
    assert second.mind.why and second.mind.why.sentence == "Waiting to be put down at a post or in a dock"
    second.robot.lift(True)
    second.passes(1)
    second.robot.place(start_pose(second.parts.navigator.campus, "post1:post2"))
    second.robot.lift(False)
    second.passes(1)
    second.robot.press("spot")
    second.until(lambda: second.is_at("post2"))
    assert second.told().count("fault place_unknown") == 2, "begun and over"
    second.close()


@pytest.mark.nightly
def test_an_error_of_the_map_stops_the_wheels_is_told_and_ends_no_loop(run: SimulatedRun) -> None:
    run.asks("", "visit(post1)")
    run.until(lambda: run.is_at("post3") and run.robot.pose.x_m < 1.3)
    look, sent = run.parts.navigator.look, list[WheelSpeeds]()

    def fails_once(view: View) -> None:
        run.parts.navigator.look = look  # type: ignore[method-assign]
        raise UnknownCorridor("post2-post4", "test_track")

    run.parts.navigator.look = fails_once  # type: ignore[method-assign]
    run.until(lambda: sent.append(run.mind.hands.body.view.sent) or run.mind.hands.body.view.sent.still, 2)
    assert run.told().count("fault place_unknown") == 1
    assert (run.parts.navigator.is_known, run.parts.navigator.corridor) == (False, None)
    run.until(lambda: run.is_at("post1"), 400)
    assert run.told().count("fault place_unknown") == 2, "the next marker tells where it is"
