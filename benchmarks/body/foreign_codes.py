"""Plain codes of posts that a stranger shows to the camera at random places: none may be believed.

Each letter meets one, for three seconds: another post's name, or the name of the post ahead far too early; on the way,
or while the robot stands at a post.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import Any

from benchmarks.body.lone_letter import LetterRun, on_both_maps
from benchmarks.body.missions import MEMORY
from benchmarks.body.report import Samples, Wanted, quietly, say

SHOWN_FOR_S = 3.0
SHARE = (0.05, 0.6)
"""Of the corridor, when it is shown."""
STANDS, NEXT_POST = 0.2, 0.5
"""Shares of the showings: at a post; with the name of the post ahead."""

WANTED = (
    Wanted("believed", at_most=0, unit="showings"),
    Wanted("delivered_share", at_least=1.0, unit="of the letters"),
)


@dataclass(frozen=True)
class Showing:
    """One showing of a code: where, whether people were told of it, and what was wrong afterwards."""

    world: str
    seed: int
    shown: str
    told: int
    delivered: bool
    problems: tuple[str, ...]


def measure(samples: Samples) -> dict[str, Any]:
    """`samples.seeds` of them, on both maps in turn."""
    return summary(on_both_maps(showing, samples.first_seed, samples.seeds))


def showing(world: str, seed: int) -> Showing:
    """One letter and one stranger."""
    quietly()
    random = Random(f"{world}/{seed}/stranger")
    with TemporaryDirectory(prefix="foreign-", dir=MEMORY if MEMORY.is_dir() else None) as folder:
        run = LetterRun(Path(folder), world, seed)
        stands, share, passes = random.random() < STANDS, random.uniform(*SHARE), random.randrange(3)
        came = run.run(lambda: len(run.navigator.visited) > passes and (_is_at if stands else _is_on_way)(run, share))
        shown = _show(run, random) if came else "nothing"
        run.run()
        told = run.faults("foreign_marker")
        result = Showing(world, seed, shown, told, run.delivered, tuple(run.problems))
        run.close()
    say(f"  {world} {seed}: {shown}; told {told} times; {'; '.join(result.problems) or 'not believed'}")
    return result


def _is_at(run: LetterRun, _: float) -> bool:
    return run.navigator.at is not None and not run.robot.docked


def _is_on_way(run: LetterRun, share: float) -> bool:
    leg, left_mm = run.navigator.corridor, run.navigator.way_left_mm
    if leg is None or left_mm is None:
        return False
    return left_mm <= 1000 * (1 - share) * run.campus.corridor(leg.from_post, leg.to_post).length_m


def _show(run: LetterRun, random: Random) -> str:
    navigator, campus = run.navigator, run.campus
    ahead, at = navigator.towards, navigator.at
    neighbours = [post.name for post, _ in campus.neighbours(at)] if at else [ahead] if ahead else []
    others = [post for post in sorted(campus.posts) if post not in (*neighbours, at)]
    post = random.choice(neighbours if random.random() < NEXT_POST else others)
    run.robot.show_code(post, SHOWN_FOR_S)
    return f"{post} shown {f'at {at}' if at else f'between {navigator.came_from} and {ahead}'}"


def summary(showings: Sequence[Showing]) -> dict[str, Any]:
    return {
        "showings": sum(one.shown != "nothing" for one in showings),
        "told": sum(one.told > 0 for one in showings),
        "believed": sum(bool(one.problems) for one in showings),
        "delivered_share": sum(one.delivered for one in showings) / len(showings),
        "wrong": [f"{one.world} {one.seed}: {one.shown}: {problem}" for one in showings for problem in one.problems],
        "not_delivered": [f"{one.world} {one.seed}: {one.shown}" for one in showings if not one.delivered],
    }
