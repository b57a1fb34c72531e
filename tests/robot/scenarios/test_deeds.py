"""People's acts on a robot in a scenario: a code shown, the cable pulled and put in again, the base reset, slip."""

import logging
from pathlib import Path
from typing import Any

import pytest
import structlog

from robot.scenarios.judging import shortfalls
from robot.scenarios.scenario import Scenario
from robot.scenarios.stage import Stage

LETTER = {"id": "o1", "from": "post1", "to": "post2"}
ON_THE_WAY: dict[str, Any] = {"after_post": "post1", "at_s": 12.0}
"""Loaded, and on the line to post2."""


@pytest.mark.parametrize(
    ("happens", "told"),
    [
        (
            {"deed": [{**ON_THE_WAY, "do": "unplug"}, {**ON_THE_WAY, "at_s": 17.0, "do": "plug_in"}]},
            "fault base_silent",
        ),
        ({"deed": [{**ON_THE_WAY, "do": "reset_base"}]}, "fault base_silent"),
        ({"fault": [{**ON_THE_WAY, "switch": "camera_frozen", "for_s": 6.0}]}, "fault camera_frozen"),
        ({"fault": [{**ON_THE_WAY, "switch": "slip", "value": 0.1}]}, "handover receive"),
        ({"deed": [{**ON_THE_WAY, "do": "show_code", "text": "CM1:of another", "for_s": 3.0}]}, "handover receive"),
    ],
    ids=["unplug and plug in", "reset", "frozen picture", "slip", "code"],
)
@pytest.mark.nightly
def test_the_letter_arrives_all_the_same(tmp_path: Path, happens: dict[str, Any], told: str) -> None:
    structlog.configure(wrapper_class=structlog.make_filtering_bound_logger(logging.CRITICAL))
    wanted = {"told": [told]}
    scenario = Scenario.model_validate({"order": [LETTER], "limit_s": 600, "expect": wanted, **happens})
    said: list[str] = []
    with Stage(scenario, tmp_path, say=lambda at_s, who, what: said.append(f"{at_s:7.1f} {who}: {what}")) as stage:
        ending = stage.run()
    assert shortfalls(ending, scenario.expect) == [], "\n".join(said)


def test_a_deed_shows_what_it_says_for_as_long_as_it_says(tmp_path: Path) -> None:
    deed = {"at_s": 1.0, "do": "show_code", "text": "anything", "for_s": 3.0}
    with Stage(Scenario.model_validate({"deed": [deed]}), tmp_path) as stage:
        (actor,) = stage.actors
        shown = []
        stage.watchers.append(lambda now: shown.append((now, actor.body.camera.shown)))
        stage.run(6.0)
    seen_s = [now for now, text in shown if text == "anything"]
    assert (min(seen_s), max(seen_s)) == pytest.approx((1.0, 3.9), abs=0.15)
