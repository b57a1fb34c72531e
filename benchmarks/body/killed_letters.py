"""Letters in stepped time whose robot is killed and started again: where it drives afterwards, and what they come to.

What a kill leaves on the disk is judged by `kills`. The simulated base stands at once when its computer dies, as with
`ExecStopPost`; a real one may roll on.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import Any

from benchmarks.body.lone_letter import LetterRun
from benchmarks.body.missions import MEMORY
from benchmarks.body.report import Wanted, quietly, say

WANTED = (
    Wanted("without_grant", at_most=0, unit="letters"),
    Wanted("false_place", at_most=0, unit="letters"),
    Wanted("delivered_share", at_least=1.0, unit="of the letters"),
)

KillTime = Callable[[LetterRun, Random], Callable[[], bool]]
"""Draws when to kill; what it makes tells whether that has come."""


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


def killed_letter(world: str, seed: int, kills: int, kill_time: KillTime, drains_to: float | None = None) -> Outcome:
    """One letter, whose robot is killed at times that are drawn anew after each start, so often at most."""
    quietly()
    random = Random(f"{world}/{seed}/kills")
    with TemporaryDirectory(prefix="letter-", dir=MEMORY if MEMORY.is_dir() else None) as folder:
        run = LetterRun(Path(folder), world, seed, drains_to=drains_to)
        killed = 0
        while killed < kills and run.run(kill_time(run, random)):
            killed += 1
            run.kill()
            run.start()
        run.run()
        asked = run.faults("place_unknown") + run.faults("stuck")
        outcome = Outcome(world, seed, killed, run.delivered, tuple(run.problems), asked)
        run.close()
    found = [*outcome.problems, *([] if outcome.delivered else ["not delivered"])]
    say(f"  {world} {seed}: {killed} kills; {'; '.join(found) or 'as wanted'}")
    return outcome


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
