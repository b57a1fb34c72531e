"""After the tune that says yes the robot stands: a person takes seconds to put mail into its box, or to take it out.

The judge is the simulated world: when its wheels turn, and where the letter really is.
"""

from collections.abc import Callable
from pathlib import Path

import pytest

from protocol.to_robot import Pause, Resume
from robot.scenarios.judging import Fate
from robot.scenarios.scenario import Scenario
from robot.scenarios.stage import Stage

LETTER = {"id": "o1", "from": "post1", "to": "post2"}
SLOWEST_S = 4.5
"""The slowest hands of these tests, whatever the robot takes for enough."""
Disturbs = Callable[[Stage], None]


def stood_after_each_yes(stage: Stage, disturb: Disturbs) -> list[float]:
    """For how long the wheels stood from each "accepted" on. `disturb` is called half a second after each."""
    (actor,) = stage.actors
    heard_s: list[float] = []
    stood_s: list[float] = []

    def look(now: float) -> None:
        if "accepted" in actor.heard:
            heard_s.append(now)
        if len(heard_s) > len(stood_s) and actor.body.body.base.moving:
            stood_s.append(now - heard_s[-1])
        if heard_s and now == pytest.approx(heard_s[-1] + 0.5, abs=0.01):
            disturb(stage)

    stage.watchers.append(look)
    stage.run()
    return stood_s


def pause_and_resume(stage: Stage) -> None:
    number = f"{stage.clock.now():.0f}"
    stage.service.push("r1", Pause(command_id=f"pause-{number}", reason="a test"))
    stage.service.push("r1", Resume(command_id=f"resume-{number}"))


@pytest.mark.parametrize(
    "disturb",
    [
        lambda stage: None,
        lambda stage: stage.actors[0].body.sag(0.15),
        pause_and_resume,
    ],
    ids=["nothing", "low battery", "pause"],
)
@pytest.mark.nightly
def test_no_wheel_turns_while_a_hand_may_be_in_the_box(tmp_path: Path, disturb: Disturbs) -> None:
    with Stage(Scenario.model_validate({"order": [LETTER], "limit_s": 150}), tmp_path) as stage:
        stood_s = stood_after_each_yes(stage, disturb)
    assert stood_s, "it went on at all"
    assert min(stood_s) > SLOWEST_S, stood_s


@pytest.mark.nightly
def test_slow_hands_find_the_box_where_it_was(tmp_path: Path) -> None:
    with Stage(Scenario.model_validate({"order": [LETTER], "limit_s": 600}), tmp_path) as stage:
        for person in stage.handings:
            person.takes_s = (SLOWEST_S - 0.1, SLOWEST_S)
        ending = stage.run()
    assert [one.fate for one in ending.verdicts] == [Fate.DELIVERED]


@pytest.mark.nightly
def test_a_push_while_a_code_is_read_leaves_the_letter_with_its_robot(tmp_path: Path) -> None:
    """It goes back a hand's breadth, says yes all the same, and stands for the hand that follows."""
    pushed: list[float] = []
    with Stage(Scenario.model_validate({"order": [LETTER], "limit_s": 600}), tmp_path) as stage:
        (actor,) = stage.actors

        def push_it(_: float) -> None:
            if actor.body.camera.shown and not pushed:
                pushed.append(stage.clock.now())
                actor.body.bump("both", 0.5)

        stage.watchers.append(push_it)
        ending = stage.run()
    assert pushed
    assert ending.bumps == 1
    assert [one.fate for one in ending.verdicts] == [Fate.DELIVERED]
