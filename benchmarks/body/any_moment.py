"""Kills at any moment of a letter and of the charge in its middle, every second one in a turn, a search or at a dock.

There the robot neither stands at a post nor looks along a line, and what it wrote down last is not where it is.
"""

from collections.abc import Callable
from random import Random
from typing import Any

from benchmarks.body.killed_letters import WANTED, Outcome, killed_letter, summary
from benchmarks.body.lone_letter import LetterRun, on_both_maps
from benchmarks.body.report import Samples
from robot.skills import Dock, FindLine, Turn, Undock

__all__ = ["WANTED", "letter", "measure"]

KILLS_OF_A_LETTER = 6
MOST_S, MOST_IN_S = 45.0, 4.0
"""So long after a start at most, and after the beginning of a turn, a search, a docking."""
OFF_THE_LINE = frozenset({Turn.name, FindLine.name, Dock.name, Undock.name})
LOW_RATIO = 0.2


def measure(samples: Samples) -> dict[str, Any]:
    """`samples.kills` of them, six for each letter, on both maps in turn."""
    return summary(on_both_maps(letter, samples.first_seed, -(-samples.kills // KILLS_OF_A_LETTER)))


def letter(world: str, seed: int) -> Outcome:
    """One letter, whose robot is killed six times at most."""
    return killed_letter(world, seed, KILLS_OF_A_LETTER, _some_time, LOW_RATIO)


def _some_time(run: LetterRun, random: Random) -> Callable[[], bool]:
    until_s = run.clock.now() + random.uniform(0.0, MOST_S)
    return _off_the_line(run, random) if random.random() < 0.5 else lambda: run.clock.now() >= until_s


def _off_the_line(run: LetterRun, random: Random) -> Callable[[], bool]:
    for_s, since_s = random.uniform(0.0, MOST_IN_S), None

    def is_far_enough_in() -> bool:
        nonlocal since_s
        view = run.mind.hands.view
        if view.motion not in OFF_THE_LINE and not view.searching:
            since_s = None
            return False
        since_s = run.clock.now() if since_s is None else since_s
        return run.clock.now() - since_s >= for_s

    return is_far_enough_in
