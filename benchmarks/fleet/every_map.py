"""Exhaustively: on every small map, from every place from which robots can come home, they do, and can take on more."""

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, fields, replace
from functools import partial
from math import inf
from random import Random
from typing import Any

from benchmarks.body.report import Wanted, say
from benchmarks.fleet.samples import Samples
from benchmarks.fleet.small_maps import AT_HOME, Edges, Fleet, Places, connected_maps, network_on
from fleet.schedule.execution import may_enter
from fleet.schedule.journey import Goal, Journey, Start, Task, without_first
from fleet.schedule.network import Network
from fleet.schedule.planning import first_plan, insert
from fleet.schedule.validation import problems

MOST_ROBOTS = 4
HANDLING_S = 5.0
MOST_POSTS_WITH_EVERY_GOAL = 4
"""On larger maps each robot place is given one goal at random: every one of them would take hours."""
WANTED = [Wanted(figure, at_most=0) for figure in ("stuck", "invalid", "refused")] + [Wanted("places", at_least=1)]


@dataclass
class Seen:
    """`stuck`: places without a schedule, or from which carrying one out ends before everybody is home; `invalid`:
    schedules that the independent check refuses; `refused`: goals that could not be taken on."""

    maps: int = 0
    fleets: int = 0
    places: int = 0
    goals: int = 0
    entries: int = 0
    stuck: int = 0
    invalid: int = 0
    refused: int = 0

    def figures(self) -> dict[str, Any]:
        return asdict(self)

    def add(self, other: "Seen") -> None:
        for field in fields(self):
            setattr(self, field.name, getattr(self, field.name) + getattr(other, field.name))


def measure(samples: Samples) -> dict[str, Any]:
    """Every map up to so many posts, the figures of all of them and of each number of posts."""
    seen, by_posts = Seen(), {}
    for posts in range(2, samples.posts + 1):
        of_posts = Seen()
        look = partial(look_at_map, posts, every_goal=posts <= MOST_POSTS_WITH_EVERY_GOAL)
        for number, of_map in enumerate(samples.each(look, connected_maps(posts)), 1):
            of_posts.add(of_map)
            say(f"  {posts} posts, map {number}: {of_posts.places} places, {of_posts.stuck} of them stuck")
        by_posts[f"{posts}_posts"] = of_posts.figures()
        seen.add(of_posts)
    return {**seen.figures(), **by_posts}


def look_at(posts: int, *, every_goal: bool = True, crossing_s: float = 0.0) -> Seen:
    """Every connected map with so many posts."""
    seen = Seen()
    for edges in connected_maps(posts):
        seen.add(look_at_map(posts, edges, every_goal=every_goal, crossing_s=crossing_s))
    return seen


def look_at_map(posts: int, edges: Edges, *, every_goal: bool = True, crossing_s: float = 0.0) -> Seen:
    """One map with one bay at each post and with two, and one to four robots with a home place each: all at the same
    post, or spread. `every_goal`: each robot is given each goal, else one of them."""
    seen = Seen(maps=1)
    for bays in (1, 2):
        network = replace(network_on(posts, edges, (bays,) * posts), crossing_s=(crossing_s,) * posts)
        for homes in _homes(posts):
            seen.fleets += 1
            _look_at_fleet(Fleet(network, homes), seen, every_goal=every_goal)
    return seen


def _homes(posts: int) -> Iterator[tuple[int, ...]]:
    for robots in range(1, MOST_ROBOTS + 1):
        yield from ((post,) * robots for post in range(posts))
        if robots > 1:
            yield tuple(number % posts for number in range(robots))


def _look_at_fleet(fleet: Fleet, seen: Seen, *, every_goal: bool) -> None:
    rng = Random(1)
    for places in fleet.places_that_come_home():
        seen.places += 1
        tasks = _tasks(fleet, places)
        found = first_plan(fleet.network, tasks, rng)
        if found is None:
            seen.stuck += 1
            continue
        seen.invalid += bool(problems(fleet.network, tasks, found.journeys))
        goals = [(robot, post) for robot in tasks for post in range(len(fleet.network.posts))]
        for robot, post in goals if every_goal else [rng.choice(goals)]:
            _take_on(fleet.network, tasks, found.journeys, robot, Goal(post, HANDLING_S), seen)


def _tasks(fleet: Fleet, places: Places) -> dict[str, Task]:
    standing = (
        (home if place == AT_HOME else place, place == AT_HOME) for home, place in zip(fleet.homes, places, strict=True)
    )
    return {
        f"r{number}": Task(Start(post, at_home, 0.0, -1.0), (), fleet.homes[number])
        for number, (post, at_home) in enumerate(standing)
    }


def _take_on(
    network: Network, tasks: Mapping[str, Task], kept: Mapping[str, Journey], robot: str, goal: Goal, seen: Seen
) -> None:
    seen.goals += 1
    more = {**tasks, robot: replace(tasks[robot], goals=(goal,))}
    found = insert(network, more, kept, robot)
    if found is None:
        seen.refused += 1
        return
    seen.invalid += bool(problems(network, more, found.journeys))
    seen.stuck += not _comes_to_an_end(network, more, dict(found.journeys), seen)


def _comes_to_an_end(network: Network, tasks: Mapping[str, Task], journeys: dict[str, Journey], seen: Seen) -> bool:
    """Return whether robots that keep to the order, however late, all come to the end of their journeys: each that can
    enters, and one in a corridor arrives when none can enter."""
    starts = {robot: task.start for robot, task in tasks.items()}
    while True:
        able = [
            robot
            for robot, journey in journeys.items()
            if starts[robot].lane is None and may_enter(network, starts, journeys, robot, inf)
        ]
        moving = [robot for robot, start in starts.items() if start.lane is not None]
        if able:
            leg = journeys[able[0]].legs[1]
            starts[able[0]] = Start(leg.post, leg.at_home, 0.0, 0.0, leg.lane)
            journeys[able[0]] = without_first(journeys[able[0]])
            seen.entries += 1
        elif moving:
            starts[moving[0]] = replace(starts[moving[0]], lane=None)
        else:
            return all(len(journey.legs) == 1 for journey in journeys.values())
