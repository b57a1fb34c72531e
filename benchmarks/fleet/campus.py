"""The whole campus: everything that decides in the service, and every message between it and the robots, for weeks.

    python -m benchmarks.fleet campus

Robots are simulated, and so are people, packs, networks and faults; traffic, planner, charging, estimates and protocol
are the product's own. Robots fall silent in corridors until a person has looked, stand still for a while, lose their
network; corridors are closed. Ways have paces of their own, and take 20 % more or less each time.
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter
from typing import Any, Final

from benchmarks.body.report import Wanted, say
from benchmarks.fleet.campus_core import CustodyError
from benchmarks.fleet.campus_dispatch import AGE_LIMIT_S
from benchmarks.fleet.campus_ground import FAULTS
from benchmarks.fleet.campus_link import LostMessageError
from benchmarks.fleet.campus_run import CampusRun, Fleet
from benchmarks.fleet.samples import Samples
from benchmarks.fleet.world import CollisionError
from fleet.eta.calibration import Basis
from fleet.eta.intervals import quantile
from fleet.eta.score import Truth, score_of

DAYS_OF_ONE: Final = 4.0
"""So many times `days` each run lasts: estimates learn before they are judged."""
WARM_UP: Final = 30
CHARGE_S: Final = 3 * 3600.0
"""Of an empty pack: what is more than one charge has to wait for a full one, also when it goes before all else."""
FLEETS: Final = {
    "four_robots": Fleet(4, 1, 0.25),
    "two_items_each": Fleet(4, 2, 0.25),
    "long_lasting_packs": Fleet(4, 1, 0.8, lasts=4.0),
}
WANTED: Final = [
    wanted
    for name in FLEETS
    for wanted in (
        Wanted(f"{name}.stuck", at_most=0),
        Wanted(f"{name}.met", at_most=0),
        Wanted(f"{name}.lost", at_most=0),
        Wanted(f"{name}.too_old", at_most=0),
        Wanted(f"{name}.stranded", at_most=0),
        Wanted(f"{name}.unplanned_charge_share", at_most=0.02),
        *(
            wanted
            for basis in Basis
            for wanted in (
                Wanted(f"{name}.{basis}.inside", at_least=0.78, at_most=0.82),
                Wanted(f"{name}.{basis}.median_error", at_most=0.15),
                Wanted(f"{name}.{basis}.pinball_of_map", at_most=0.99),
            )
        ),
    )
]


@dataclass
class Seen:
    """`stuck`: robots that waited for a corridor for six hours; `met`, `lost`: runs that ended with a collision, or
    with mail or a message that got lost; `too_old`: orders older than the age limit plus one round, a whole charge
    and the longest trip of the same run."""

    robot_hours: float = 0.0
    orders: int = 0
    delivered: int = 0
    stuck: int = 0
    met: int = 0
    lost: int = 0
    too_old: int = 0
    stranded: int = 0
    critical: int = 0
    unplanned_charge: int = 0
    died: int = 0
    before_post: int = 0
    events: int = 0
    took_s: float = 0.0
    counts: Counter[str] = field(default_factory=Counter)
    messages: Counter[str] = field(default_factory=Counter)
    ages_s: list[float] = field(default_factory=list)
    placed: list[Truth] = field(default_factory=list)
    under_way: list[Truth] = field(default_factory=list)

    def add(self, other: "Seen") -> None:
        for name, theirs in vars(other).items():
            setattr(self, name, getattr(self, name) + theirs)


def measure(samples: Samples) -> dict[str, Any]:
    days = DAYS_OF_ONE * samples.days
    jobs = [(name, seed, days) for name in FLEETS for seed in samples.some_seeds()]
    seen = {name: Seen() for name in FLEETS}
    for (name, seed, _), of_run in zip(jobs, samples.each(look_at, jobs), strict=True):
        say(f"  {name}, seed {seed}: {of_run.delivered} of {of_run.orders} orders, {of_run.stranded} stranded")
        seen[name].add(of_run)
    draw(samples.plots, seen)
    return {name: figures(one) for name, one in seen.items()}


def look_at(job: tuple[str, int, float]) -> Seen:
    name, seed, days = job
    run, begun_s = CampusRun(seed, FLEETS[name], FAULTS), perf_counter()
    seen = Seen()
    try:
        run.run(days)
    except CollisionError as error:
        say(f"  {name}, seed {seed}: {error}")
        seen.met = 1
    except (CustodyError, LostMessageError) as error:
        say(f"  {name}, seed {seed}: {error}")
        seen.lost = 1
    seen.took_s = perf_counter() - begun_s
    seen.add(_seen(run))
    return seen


def _seen(run: CampusRun) -> Seen:
    core, now_s, robots = run.core, run.clock.now_s, run.robots.values()
    dispatch, orders = core.dispatch, core.dispatch.orders.values()
    ages_s = [(now_s if one.delivered_s is None else one.delivered_s) - one.placed_s for one in orders]
    trips_s = [one.delivered_s - one.taken_s for one in orders if one.delivered_s and one.taken_s]
    return Seen(
        robot_hours=len(run.robots) * now_s / 3600,
        orders=len(dispatch.orders),
        delivered=len(dispatch.orders) - len(dispatch.open),
        stuck=core.counts["stuck"],
        too_old=sum(age_s > AGE_LIMIT_S + CHARGE_S + max(trips_s, default=0.0) for age_s in ages_s),
        stranded=sum(robot.stranded for robot in robots),
        critical=sum(robot.critical for robot in robots),
        unplanned_charge=sum(one.unplanned_charge for one in orders),
        died=sum(robot.deaths for robot in robots),
        before_post=sum(robot.before_post for robot in robots),
        events=run.clock.events,
        counts=core.counts,
        messages=run.messages,
        ages_s=ages_s,
        placed=dispatch.told.promises.scored[Basis.PLACED][WARM_UP:],
        under_way=dispatch.told.promises.scored[Basis.UNDER_WAY][WARM_UP:],
    )


def figures(seen: Seen) -> dict[str, Any]:
    ages_s = sorted(seen.ages_s) or [0.0]
    plain = (
        "orders",
        "delivered",
        "stuck",
        "met",
        "lost",
        "too_old",
        "stranded",
        "critical",
        "died",
        "before_post",
        "events",
    )
    return {
        "robot_hours": round(seen.robot_hours),
        **{name: getattr(seen, name) for name in plain},
        "unplanned_charge_share": round(seen.unplanned_charge / max(1, seen.orders), 4),
        "median_order_min": round(quantile(ages_s, 0.5) / 60, 1),
        "p95_order_min": round(quantile(ages_s, 0.95) / 60, 1),
        "oldest_h": round(ages_s[-1] / 3600, 2),
        "placed": _score(seen.placed),
        "under_way": _score(seen.under_way),
        "counts": dict(sorted(seen.counts.items())),
        "messages": dict(sorted(seen.messages.items())),
        "messages_per_robot_hour": round(seen.messages.total() / max(1.0, seen.robot_hours), 1),
        "events_per_s": round(seen.events / max(1e-9, seen.took_s)),
        "robot_hours_per_s": round(seen.robot_hours / max(1e-9, seen.took_s), 1),
    }


def _score(truths: Sequence[Truth]) -> dict[str, Any]:
    if not truths:
        return {}
    score = score_of(truths)
    found = {"orders": score.count, "inside": score.inside, "median_error": score.median_error}
    found |= {
        "median_error_by_map": score.median_error_by_map,
        "pinball_of_map": score.pinball_s / score.pinball_by_map_s,
    }
    return {name: round(value, 4) for name, value in found.items()}


def draw(folder: Path, seen: Mapping[str, Seen]) -> None:
    """Draw how long orders take, what people were told of it, and what is said for that."""
    from benchmarks.fleet.plots import COLOURS, pyplot_for, save

    pyplot = pyplot_for(folder)
    figure, (times, truths, said) = pyplot.subplots(1, 3, figsize=(12.0, 3.4))
    for colour, (name, one) in zip(COLOURS[::2], seen.items(), strict=False):
        hours, label = [age_s / 3600 for age_s in sorted(one.ages_s)], name.replace("_", " ")
        times.plot(hours, [100 * (at + 1) / len(hours) for at in range(len(hours))], color=colour, label=label)
        p50_h, truth_h = [it.told.p50_s / 3600 for it in one.under_way], [it.seconds / 3600 for it in one.under_way]
        truths.scatter(p50_h, truth_h, s=5, color=colour, alpha=0.5, linewidth=0, label=label)
        names = sorted(one.messages, key=lambda key: one.messages[key])
        per_hour = {key: one.messages[key] / max(1.0, one.robot_hours) for key in names}
        if name == next(iter(seen)):
            said.barh(list(per_hour), list(per_hour.values()), color=colour)
    times.set(xlabel="hours from placed to delivered", ylabel="of all orders, %", xscale="log", ylim=(0, 100))
    times.legend(frameon=False, loc="lower right", fontsize=8)
    truths.set(xlabel="told under way (middle), h", ylabel="came, h", xscale="log", yscale="log")
    truths.axline((0.1, 0.1), (10, 10), color="#999999", linewidth=0.8)
    said.set(xlabel=f"messages per robot-hour, {next(iter(seen)).replace('_', ' ')}")
    save(figure, folder / "campus.svg")
