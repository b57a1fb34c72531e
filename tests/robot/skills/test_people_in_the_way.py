"""People before the robot on its line: how it comes near, touches, waits and goes on. Stepped."""

from collections.abc import Callable
from dataclasses import dataclass

import pytest

from robot.drivers.interfaces import STOP
from robot.simulated import Options, Person, Wall
from robot.skills.follow_line import FollowLine
from tests.plain_maps import plain_map
from tests.robot.skills.track import Drive

TRACK = plain_map("test_track")
AHEAD_M = 0.7
"""From the axle to the middle of a person in the way: a third of a metre to the touch."""
REFLEX_S = 3.4
"""Until the reflex lets it go on: 3 s after the touch, which ends soon after it begins to go back."""
WAITS_S = (6.0, 8.0)


@dataclass
class Meeting:
    """A robot that follows its line southwards at full speed."""

    robot: Drive
    touched_mm_s: float = 0.0

    @property
    def speed_mm_s(self) -> float:
        left, right = self.robot.robot.state()["wheels_mm_s"]
        return float(left + right) / 2

    def somebody_stands_ahead(self) -> Person:
        pose = self.robot.robot.pose
        person = Person(pose.x_m, pose.y_m - AHEAD_M)
        self.robot.robot.world.obstacles.append(person)
        return person

    def leaves(self, person: Person) -> None:
        self.robot.robot.world.obstacles.remove(person)

    def until_touched(self) -> None:
        """Notes the speed in the tick that tells the wheels to stand: they still turn as they touched."""
        self.robot.until(lambda: self.robot.loop.view.base is not None and self.robot.loop.view.base.bump, 30.0)
        self.touched_mm_s = self.speed_mm_s
        self.robot.tick()

    def until_it_goes_on(self) -> float:
        """Seconds until it drives forward, from now."""
        return self.robot.until(lambda: sum(self.robot.loop.view.sent) > 0, 30.0)


@pytest.fixture
def meets(drive: Callable[..., Drive]) -> Callable[..., Meeting]:
    def under_way(*obstacles: Wall) -> Meeting:
        robot = drive("post1:post2", options=Options(obstacles=obstacles))
        robot.loop.start(FollowLine(TRACK, "post1", shape=robot.shape), robot.now)
        robot.steps(2.0)
        return Meeting(robot)

    return under_way


def test_it_comes_slowly_to_somebody_whom_it_sees(meets: Callable[..., Meeting]):
    met = meets()
    assert met.speed_mm_s > 150, "so it would have touched without light bumpers"
    met.somebody_stands_ahead()
    met.until_touched()
    assert 50 <= met.touched_mm_s <= 80


@pytest.mark.parametrize("after_s", [3.0, REFLEX_S + 3.0])
def test_whoever_steps_aside_while_it_waits_lets_it_go_on_at_once(meets: Callable[..., Meeting], after_s: float):
    met = meets()
    person = met.somebody_stands_ahead()
    met.until_touched()
    met.robot.steps(after_s)
    assert met.robot.loop.view.sent == STOP
    met.leaves(person)
    assert 0.9 <= met.until_it_goes_on() <= 1.5, "a second to see that they are really gone"


def test_whoever_stays_is_waited_for_and_touched_slowly_again(meets: Callable[..., Meeting]):
    met = meets()
    met.somebody_stands_ahead()
    for waits_s in WAITS_S:
        met.until_touched()
        assert met.touched_mm_s <= 80
        assert met.until_it_goes_on() == pytest.approx(REFLEX_S + waits_s, abs=0.3)


def test_a_hand_on_the_bumper_with_nobody_there_costs_no_more_than_the_reflex(meets: Callable[..., Meeting]):
    met = meets()
    met.robot.robot.bump("both", 0.2)
    met.until_touched()
    met.robot.steps(1.3)
    assert 1.8 <= met.until_it_goes_on() <= 2.3, "it has gone back before that"


def test_somebody_whom_it_does_not_see_has_the_whole_time_after_the_second_touch(meets: Callable[..., Meeting]):
    met = meets()
    met.robot.robot.set_fault("lights_blind", True)
    met.somebody_stands_ahead()
    met.until_touched()
    met.robot.steps(2.5)
    assert met.until_it_goes_on() <= 1.0
    met.until_touched()
    met.robot.steps(REFLEX_S)
    assert met.until_it_goes_on() == pytest.approx(WAITS_S[1], abs=0.3)


def test_light_bumpers_that_always_see_something_make_it_slow_but_never_stop_it(meets: Callable[..., Meeting]):
    met = meets()
    met.robot.robot.set_fault("lights_dazzled", True)
    met.robot.steps(1.0)
    assert 55 <= met.speed_mm_s <= 80
    met.robot.robot.bump("both", 0.2)
    met.until_touched()
    met.robot.steps(REFLEX_S)
    assert met.until_it_goes_on() == pytest.approx(WAITS_S[0], abs=0.3)


@pytest.mark.parametrize("beside_m", [0.3, -0.25])
def test_a_wall_along_the_line_does_not_slow_it(meets: Callable[..., Meeting], beside_m: float):
    free, walled = meets(), meets(Wall(beside_m, 0.0, beside_m, 6.0))
    assert walled.robot.sent == free.robot.sent
    assert walled.speed_mm_s > 150
