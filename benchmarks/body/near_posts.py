"""Kills in the last 600 mm before a post: nothing tells the restarted robot how far it came, and a branch lies ahead.

In stepped time: what a kill leaves on the disk is judged by `kills`; here it is where the robot drives afterwards. The
simulated base stands at once when its computer dies, as with `ExecStopPost`; a real one may roll on.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import Any

from benchmarks.body.lone_letter import LetterRun
from benchmarks.body.missions import MEMORY, PROCESSES
from benchmarks.body.report import Samples, Wanted, quietly, say
from robot.localization.steps import REACHED_MM
from robot.scenarios.replay.drawing import WORLDS

LAST_MM = 600.0
KILLS_OF_A_LETTER = 4

WANTED = (
    Wanted("without_grant", at_most=0, unit="letters"),
    Wanted("false_place", at_most=0, unit="letters"),
    Wanted("delivered_share", at_least=1.0, unit="of the letters"),
)


@dataclass(frozen=True)
class Outcome:
    """The outcome of one letter."""

    world: str
    seed: int
    kills: int
    delivered: bool
    problems: tuple[str, ...]
    asked_person: int
    """So often it could not tell where it was or found no line, and a person was told."""


Moment = Callable[[], bool]
Play = Callable[[str, int], Outcome]


def measure(samples: Samples) -> dict[str, Any]:
    """`samples.kills` of them, a few for each letter, on both maps in turn."""
    return on_both_maps(letter, samples.first_seed, -(-samples.kills // KILLS_OF_A_LETTER))


def on_both_maps(play: Play, first_seed: int, letters: int) -> dict[str, Any]:
    """So many letters, on one map after the other."""
    worlds = list(WORLDS)
    tasks = [(worlds[number % len(worlds)], first_seed + number) for number in range(letters)]
    with ProcessPoolExecutor(PROCESSES, mp_context=get_context("spawn")) as pool:
        return summary(list(pool.map(partial(_told, play), *zip(*tasks, strict=True))))


def _told(play: Play, world: str, seed: int) -> Outcome:
    outcome = play(world, seed)
    found = [*outcome.problems, *([] if outcome.delivered else ["not delivered"])]
    say(f"  {world} {seed}: {outcome.kills} kills; {'; '.join(found) or 'as wanted'}")
    return outcome


def letter(world: str, seed: int, kills: int = KILLS_OF_A_LETTER) -> Outcome:
    """One letter, whose robot is killed near posts, so often at most."""
    return killed_letter(world, seed, kills, _Nears)


def killed_letter(
    world: str,
    seed: int,
    kills: int,
    moment: Callable[[LetterRun, Random], Moment],
    drains_to: float | None = None,
) -> Outcome:
    """One letter, whose robot is killed whenever the `moment` drawn anew after each start has come."""
    quietly()
    random = Random(f"{world}/{seed}/kills")
    with TemporaryDirectory(prefix="letter-", dir=MEMORY if MEMORY.is_dir() else None) as folder:
        run = LetterRun(Path(folder), world, seed, drains_to=drains_to)
        killed = 0
        while killed < kills and run.run(moment(run, random)):
            killed += 1
            run.kill()
            run.start()
        run.run()
        asked = run.faults("place_unknown") + run.faults("stuck")
        outcome = Outcome(world, seed, killed, run.delivered, tuple(run.problems), asked)
        run.close()
    return outcome


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


def summary(outcomes: Sequence[Outcome]) -> dict[str, Any]:
    problems = [(one, problem) for one in outcomes for problem in one.problems]
    return {
        "letters": len(outcomes),
        "kills": sum(one.kills for one in outcomes),
        "without_grant": len({one.seed for one, problem in problems if "without a grant" in problem}),
        "false_place": len({one.seed for one, problem in problems if "believes" in problem}),
        "asked_person": sum(one.asked_person for one in outcomes),
        "delivered_share": sum(one.delivered for one in outcomes) / len(outcomes),
        "wrong": [f"{one.world} {one.seed}: {problem}" for one, problem in problems],
        "not_delivered": [f"{one.world} {one.seed}" for one in outcomes if not one.delivered],
    }
