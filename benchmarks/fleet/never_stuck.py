"""Robots that claim from the product's controller for 100,000 hours: none meets or is stuck, no order is forgotten.

Each run is one map with one seed. Ways take 20 % more or less than planned; in half of the runs robots also fall silent
in corridors and at posts until a person has looked, are switched off and on, and people close corridors for an hour; in
half of them, and in half of the others, they are let into as much of their way as no other enters before them.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from math import ceil
from random import Random
from typing import Any, Final

from benchmarks.body.report import Wanted, say
from benchmarks.fleet.claimants import Campus, Faults
from benchmarks.fleet.claimants_dispatch import Planner, nearest
from benchmarks.fleet.grounds import GROUNDS
from benchmarks.fleet.samples import Samples
from benchmarks.fleet.world import CollisionError

AGE_LIMIT_S: Final = 6 * 3600.0
MOST_HOURS: Final = 100.0
"""Of one run; then another begins with another seed."""
FAULTS: Final = Faults(dies=0.002, dies_at_a_post=0.001, closures_an_hour=0.05, switched_off_an_hour=0.05)
WANTED = [
    Wanted("all.stuck", at_most=0),
    Wanted("all.met", at_most=0),
    Wanted("all.too_old", at_most=0),
    Wanted("all.delivered", at_least=1),
]


@dataclass(frozen=True, slots=True)
class Case:
    """`planner`: the product's planner says who carries what, else the nearest order goes to a free robot."""

    ground: str
    robots: int
    bays: int
    following_s: float | None = None
    planner: bool = False


CASES: Final = (
    Case("tunnels", 4, 2),
    Case("tunnels", 6, 1),
    Case("tunnels", 8, 2, 60.0),
    Case("track", 3, 1),
    Case("loop", 4, 1),
    Case("loop", 4, 2, 60.0),
    Case("grid", 6, 1),
    Case("tree", 4, 1),
    Case("tree", 5, 2, 60.0),
    Case("tunnels", 4, 2, planner=True),
    Case("loop", 4, 2, planner=True),
    Case("tree", 4, 1, planner=True),
)


@dataclass(frozen=True, slots=True)
class Run:
    case: Case
    seed: int
    hours: float
    faults: Faults
    far: bool = False


@dataclass
class Seen:
    """`stuck`: robots that did not move for six hours; `met`: runs that ended with two robots where there is room for
    one; `too_old`: orders older than the age limit plus one round, the longest trip of the same run."""

    robot_hours: float = 0.0
    entries: int = 0
    let_in_ahead: int = 0
    delivered: int = 0
    died: int = 0
    died_at_posts: int = 0
    closed: int = 0
    switched_off: int = 0
    refused: int = 0
    stuck: int = 0
    met: int = 0
    too_old: int = 0
    oldest_h: float = 0.0
    longest_trip_h: float = 0.0

    def add(self, other: "Seen") -> None:
        for name in self.__dataclass_fields__:
            mine, theirs = getattr(self, name), getattr(other, name)
            setattr(self, name, max(mine, theirs) if name in {"oldest_h", "longest_trip_h"} else mine + theirs)

    def figures(self) -> dict[str, Any]:
        return {name: round(getattr(self, name), 2) for name in self.__dataclass_fields__}


def measure(samples: Samples) -> dict[str, Any]:
    runs, seen = list(_runs(samples)), {"all": Seen()}
    for number, (run, of_run) in enumerate(zip(runs, samples.each(look_at, runs), strict=True), 1):
        for name in ("all", run.case.ground):
            seen.setdefault(name, Seen()).add(of_run)
        if number % 50 == 0 or of_run.stuck or of_run.met or of_run.too_old:
            say(f"  {number} of {len(runs)}, {run.case}, seed {run.seed}: {of_run.figures()}")
    return {name: one.figures() for name, one in seen.items()}


def look_at(run: Run) -> Seen:
    case = run.case
    ground = GROUNDS[case.ground](case.bays, case.following_s, run.seed)
    dispatch = Planner(Random(run.seed)) if case.planner else nearest
    campus = Campus(ground, case.robots, run.seed, run.faults, age_limit_s=AGE_LIMIT_S, far=run.far, dispatch=dispatch)
    met = 0
    try:
        campus.run(run.hours * 3600)
    except CollisionError as error:
        say(f"  {run}: {error}")
        met = 1
    return _seen(campus, met)


def _runs(samples: Samples) -> Iterator[Run]:
    """Every case as often, each time with another seed, until there are so many robot-hours."""
    hours = min(MOST_HOURS, samples.robot_hours / sum(case.robots for case in CASES))
    for turn in range(ceil(samples.robot_hours / (hours * sum(case.robots for case in CASES)))):
        faults, far = FAULTS if turn % 2 == 0 else Faults(), turn % 4 < 2
        yield from (Run(case, samples.first_seed + turn, hours, faults, far) for case in CASES)


def _seen(campus: Campus, met: int) -> Seen:
    trips_s = [one.trip_s for one in campus.delivered] or [0.0]
    ages_s = [*(one.age_s for one in campus.delivered), *campus.ages_s()]
    bound_s = AGE_LIMIT_S + max(trips_s)
    return Seen(
        campus.now_s / 3600 * len(campus.robots),
        campus.entries,
        campus.ahead,
        len(campus.delivered),
        campus.deaths,
        campus.deaths_at_posts,
        campus.closures,
        campus.switched_off,
        campus.refused,
        campus.stuck,
        met,
        sum(age_s > bound_s for age_s in ages_s),
        max(ages_s) / 3600,
        max(trips_s) / 3600,
    )
