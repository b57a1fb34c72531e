"""A tune is heard in the end, also by a person who comes when the base has just been started."""

from collections.abc import Callable

from robot.drive_loop.speaker import STALE_S
from robot.skills import Say, Undock
from robot.skills.tunes import ACCEPTED
from tests.robot.skills.track import Drive

NOTES = [tuple(note for note, _ in ACCEPTED)]
Make = Callable[..., Drive]


def test_what_is_said_as_soon_as_the_base_speaks_is_heard_once_it_can_play(drive: Make) -> None:
    robot = drive("post1:post2")
    robot.tick()
    robot.do(Say("accepted"), 1.0)
    assert robot.robot.tunes_since(0)[1] == []
    robot.steps(STALE_S)
    assert robot.robot.tunes_since(0)[1] == NOTES


def test_what_a_base_that_charges_could_not_play_is_not_played_hours_later(drive: Make) -> None:
    robot = drive("dock")
    robot.steps(1.0)
    robot.do(Say("accepted"), 1.0)
    robot.steps(STALE_S)
    robot.do(Undock(shape=robot.shape))
    robot.steps(1.0)
    assert robot.robot.tunes_since(0)[1] == []
