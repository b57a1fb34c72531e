"""Short runs of the benchmark's kills before posts and of its strangers with codes, and wheels that err and slip."""

from pathlib import Path

import pytest

from benchmarks.body import any_moment, foreign_codes, near_posts
from benchmarks.body.lone_letter import LetterRun
from robot.simulated import Motion


@pytest.mark.nightly
def test_a_robot_killed_just_before_posts_enters_nothing_ungranted_and_delivers():
    outcome = near_posts.letter("track", 9001, kills=3)
    assert (outcome.kills, outcome.delivered, outcome.problems, outcome.asked_person) == (3, True, (), 0)


@pytest.mark.parametrize("seed", [9001, 9002])
@pytest.mark.nightly
def test_a_robot_killed_at_any_moment_believes_nothing_false_and_delivers(seed: int) -> None:
    outcome = any_moment.letter("track", seed)
    assert (outcome.kills, outcome.delivered, outcome.problems, outcome.asked_person) == (6, True, (), 0)


@pytest.mark.parametrize("seed", [9001, 9002])
@pytest.mark.nightly
def test_no_code_of_a_stranger_is_believed(seed: int) -> None:
    showing = foreign_codes.showing("track", seed)
    assert showing.shown != "nothing"
    assert (showing.delivered, showing.problems) == (True, ())


@pytest.mark.nightly
def test_wheels_that_err_and_slip_enter_nothing_ungranted(tmp_path: Path) -> None:
    run = LetterRun(tmp_path, "track", 1, Motion(wheel_error=0.05), slip=0.1)
    run.run()
    run.close()
    assert (run.delivered, run.problems) == (True, [])
