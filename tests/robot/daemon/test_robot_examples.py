"""The examples of the robot do what they say."""

from pathlib import Path

import pytest

from maps import find_map
from robot.core.config import load_settings
from tests.robot.daemon.simulated_run import SimulatedRun

EXAMPLES = Path(__file__).parents[3] / "examples" / "robot"


def test_the_example_settings_are_accepted_and_name_a_post_with_a_dock() -> None:
    settings = load_settings(EXAMPLES / "robot.toml", {})
    assert settings.home is not None
    assert find_map(settings.map).post(settings.home).dock is not None


@pytest.mark.nightly
def test_the_patrol_goes_three_rounds(tmp_path: Path) -> None:
    run = SimulatedRun(tmp_path, "post2:post1", mind__program=EXAMPLES / "patrol.asl", mind__percepts="latest")
    run.asks("", "patrol")
    run.until(lambda: run.mind.is_quiet and run.mind.cycles > 10, 900)
    to_and_fro = ["post2", "post1", "post1_bay2", "post1", "post2", "post3", "post3_bay1", "post3"]
    assert run.visited == (3 * to_and_fro)[:-1]
    assert run.mind.failures == []
    assert run.printed[-1] == "the patrol is over"
    run.close()


@pytest.mark.nightly
def test_the_courier_fetches_and_brings(tmp_path: Path) -> None:
    run = SimulatedRun(tmp_path, mind__program=EXAMPLES / "courier.asl", mind__percepts="latest")
    run.asks("", "fetch(post3,post4)")
    run.until(lambda: run.printed[-1:] == ["brought to post4"], 400)
    assert run.visited == ["post5_bay1", "post5", "post3", "post3_bay1", "post3", "post4", "post4_bay2"]
    assert "loaded at post3" in run.printed
    assert run.mind.failures == []
    run.close()
