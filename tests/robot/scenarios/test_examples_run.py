"""Each example scenario ends as it says, by the truth of the world."""

import logging
from pathlib import Path

import pytest
import structlog

from robot.scenarios.judging import shortfalls
from robot.scenarios.loading import read_scenario
from robot.scenarios.stage import Stage

WITH_EVERY_CHANGE = "first_letter"
EXAMPLES = sorted((Path(__file__).parents[3] / "examples" / "scenarios").glob("*.toml"))


@pytest.mark.parametrize(
    "path",
    [
        pytest.param(
            path, id=path.stem, marks=pytest.mark.slow if path.stem == WITH_EVERY_CHANGE else pytest.mark.nightly
        )
        for path in EXAMPLES
    ],
)
def test_the_example_ends_as_expected(path, tmp_path):
    structlog.configure(wrapper_class=structlog.make_filtering_bound_logger(logging.CRITICAL))
    scenario = read_scenario(path)
    told: list[str] = []
    with Stage(scenario, tmp_path, path, lambda at_s, who, what: told.append(f"{at_s:7.1f} {who}: {what}")) as stage:
        ending = stage.run()
    assert shortfalls(ending, scenario.expect) == [], "\n".join(told)
