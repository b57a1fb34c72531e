"""Findings to mend before robots drive by this map: the check that `python -m maps check` runs."""

import math
from collections.abc import Iterator
from pathlib import Path

from maps.campus_map import CampusMap, build_map, corridor_name
from maps.carrying import places_problems
from maps.geometry import wrapped
from maps.map_file import MapFile, PostRow, load_map_file
from maps.marker_check import marker_problems
from maps.problem import Problem, error, warning
from maps.room import room_problems
from maps.structure import structure_problems

# A side is a quarter turn; the geometry may differ from it by half of one.
SIDE_TOLERANCE_RAD = math.pi / 4


def check_file(path: Path) -> tuple[Problem, ...]:
    """Every problem of a map file, errors first. Raises MapError when it cannot be read at all."""
    return check(load_map_file(path))


def check(file: MapFile) -> tuple[Problem, ...]:
    """Problems of structure hide all others: without posts and corridors there is nothing further to look at."""
    problems = (*structure_problems(file), *_sides_and_corridors(file))
    if not any(structure_problems(file)):
        problems += tuple(_of_map(file, build_map(file)))
    return tuple(sorted(problems, key=lambda problem: problem.severity != "error"))


def _of_map(file: MapFile, campus: CampusMap) -> Iterator[Problem]:
    yield from _unreachable(campus)
    yield from _docks(campus)
    yield from _silent_docks(campus)
    yield from _silent_corridors(campus)
    yield from places_problems(campus)
    yield from room_problems(campus)
    yield from marker_problems(campus)
    for row in file.post:
        yield from _sides_and_geometry(row, campus)


# One-way corridors


def _sides_and_corridors(file: MapFile) -> Iterator[Problem]:
    """A corridor runs both ways: a post that lists neighbours must list all of them, and be listed by them."""
    joined = {frozenset(corridor.ends) for corridor in file.corridor}
    listed = {post.name: set(post.sides.values()) for post in file.post if post.sides is not None}
    for post, neighbours in listed.items():
        for other in sorted(neighbours):
            if frozenset((post, other)) not in joined:
                said = f"{post} lists {other} as a neighbour, but no corridor joins them"
                yield error("no_corridor", corridor_name(post, other), said, "Add the corridor or correct the sides.")
    for corridor in file.corridor:
        for post, other in (corridor.ends, corridor.ends[::-1]):
            if other not in listed.get(post, {other}):
                said = f"the corridor leads from {post} to {other}, but {post} does not list {other} as a neighbour"
                yield error("one_way", corridor.name, said, f"Add {other} to the sides of {post}.")


# What can be reached


def _unreachable(campus: CampusMap) -> Iterator[Problem]:
    largest = max((_reached(campus, name) for name in campus.posts), key=len)
    for name in campus.posts:
        if name not in largest:
            said = f"no corridor leads to {name} from the other posts"
            yield error("unreachable", name, said, "Add the corridor that is missing.")


def _docks(campus: CampusMap) -> Iterator[Problem]:
    if not campus.docks():
        said = "there is no dock on this map, so no robot could ever charge"
        yield error("no_dock", campus.name, said, "Give at least one post a dock.")
        return
    charging = {name for post in campus.docks() for name in _reached(campus, post.name)}
    for name in campus.posts:
        if name not in charging:
            yield error("no_dock", name, f"no dock can be reached from {name}", "Add a dock or a corridor.")


def _silent_docks(campus: CampusMap) -> Iterator[Problem]:
    for post in campus.docks():
        if not post.network:
            said = f"there is no network at {post.name}, so a robot that rests in its dock hears of no order"
            yield warning("silent_dock", post.name, said, "Bring the network there, or move the dock.")


def _silent_corridors(campus: CampusMap) -> Iterator[Problem]:
    for corridor in campus.corridors:
        crossings = [post for post in (corridor.a, corridor.b) if campus.post(post).spurs]
        if crossings and not corridor.network:
            said = f"there is no network, so a robot that waits there before {crossings[0]} cannot ask for a way on"
            yield warning("silent_corridor", corridor.name, said, "Bring the network there.")


def _reached(campus: CampusMap, start: str) -> frozenset[str]:
    reached, waiting = {start}, [start]
    while waiting:
        new = {post.name for post, _ in campus.neighbours(waiting.pop())} - reached
        reached |= new
        waiting += new
    return frozenset(reached)


# Geometry


def _sides_and_geometry(row: PostRow, campus: CampusMap) -> Iterator[Problem]:
    """Sides count quarter turns clockwise. The first one listed fixes the post's own frame."""
    joined = {post.name: corridor for post, corridor in campus.neighbours(row.name)}
    sides = [(int(side), other) for side, other in (row.sides or {}).items() if other in joined]
    for side, other in sides[1:]:
        first_side, first = sides[0]
        listed_rad = -(side - first_side) * math.pi / 2
        drawn_rad = joined[other].heading_leaving(row.name) - joined[first].heading_leaving(row.name)
        if abs(wrapped(drawn_rad - listed_rad)) > SIDE_TOLERANCE_RAD:
            said = f"{other} is on side {side} and {first} on side {first_side}, but they are not drawn so"
            yield warning("side_and_geometry", row.name, said, "Correct the sides or the corners of the corridor.")
