"""Kills in the last 600 mm before a post: nothing tells the restarted robot how far it came, and a branch is ahead."""

from random import Random
from typing import Any

from benchmarks.body.killed_letters import WANTED, Outcome, killed_letter, summary
from benchmarks.body.lone_letter import LetterRun, on_both_maps
from benchmarks.body.report import Samples
from robot.localization.steps import REACHED_MM

__all__ = ["WANTED", "letter", "measure"]

LAST_MM = 600.0
KILLS_OF_A_LETTER = 4


def measure(samples: Samples) -> dict[str, Any]:
    """`samples.kills` of them, a few for each letter, on both maps in turn."""
    return summary(on_both_maps(letter, samples.first_seed, -(-samples.kills // KILLS_OF_A_LETTER)))


def letter(world: str, seed: int, kills: int = KILLS_OF_A_LETTER) -> Outcome:
    """One letter, whose robot is killed so often at most."""
    return killed_letter(world, seed, kills, _Nears)


class _Nears:
    """A condition: the robot is as near to the post ahead as was drawn; one post in two is passed.

    Within 30 mm of a post it counts as reached, and is told so.
    """

    def __init__(self, run: LetterRun, random: Random) -> None:
        self._run, self._left_mm, self._passes = run, random.uniform(REACHED_MM, LAST_MM), random.randint(1, 2)
        self._towards: str | None = None

    def __call__(self) -> bool:
        towards = self._run.navigator.towards
        if towards != self._towards:
            self._passes -= towards is not None
            self._towards = towards
        near = towards is not None and 1000 * self._run.distance_m(towards) <= self._left_mm
        return near and self._passes <= 0
