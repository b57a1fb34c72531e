"""Kills at any moment of a letter and of the charge in its middle: in turns, in searches, half way out of a dock.

In stepped time, as `near_posts`: here it is where the robot believes to be afterwards, and whether it finds its way.
"""

from random import Random
from typing import Any

from benchmarks.body.lone_letter import LetterRun
from benchmarks.body.near_posts import WANTED, Outcome, killed_letter, on_both_maps
from benchmarks.body.report import Samples

__all__ = ["WANTED", "letter", "measure"]

KILLS_OF_A_LETTER = 6
MOST_S = 45.0
LOW_RATIO = 0.2


def measure(samples: Samples) -> dict[str, Any]:
    """`samples.kills` of them, six for each letter, on both maps in turn."""
    return on_both_maps(letter, samples.first_seed, -(-samples.kills // KILLS_OF_A_LETTER))


def letter(world: str, seed: int) -> Outcome:
    """One letter, whose robot is killed within 45 s of each start, six times."""
    return killed_letter(world, seed, KILLS_OF_A_LETTER, _Later, LOW_RATIO)


class _Later:
    """A condition: a time drawn after the start has passed."""

    def __init__(self, run: LetterRun, random: Random) -> None:
        self._clock = run.clock
        self._until_s = run.clock.now() + random.uniform(0.0, MOST_S)

    def __call__(self) -> bool:
        return self._clock.now() >= self._until_s
