"""Findings to mend before robots drive by this map: the check that `python -m maps check` runs."""

import math
from collections.abc import Iterator
from pathlib import Path

from maps.bays import Marker
from maps.campus_map import CampusMap, Corridor, Post, build_map, corridor_name
from maps.carrying import places_problems
from maps.geometry import Point, distance_to_path_m, seen_from, wrapped
from maps.map_file import MapFile, PostRow, load_map_file
from maps.problem import Problem, error, warning
from maps.structure import structure_problems

# Where the left-hand camera can make out a marker of 80 mm, for a robot that rolls towards a post, and for one
# who stands in a dock and sees only what is abreast. 0.8 m leave 2.5 pixels per module at 640 × 480 and 60°.
SEEN_ROLLING_M = (-1.0, 0.2)
SEEN_STANDING_M = (-0.2, 0.2)
SEEN_LEFT_M = (0.2, 0.8)
SEEN_TURNED_RAD = math.radians(45)
# The robot's radius (174 mm, Create 2) and a little for the sheet itself.
CLEAR_OF_LINE_M = 0.22
# A side is a quarter turn; the geometry may differ from it by half of one.
SIDE_TOLERANCE_RAD = math.pi / 4
# The bytes of a QR code of version 2 at error correction H (ISO/IEC 18004, table 7): 25 modules on 80 mm.
LONGEST_EASY_NAME = 14


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
    yield from places_problems(campus)
    for row in file.post:
        post = campus.post(row.name)
        yield from _sides_and_geometry(row, campus)
        yield from _approaches(post, campus)
        yield from _markers(post, campus)


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


def _reached(campus: CampusMap, start: str) -> frozenset[str]:
    reached, waiting = {start}, [start]
    while waiting:
        new = {post.name for post, _ in campus.neighbours(waiting.pop())} - reached
        reached |= new
        waiting += new
    return frozenset(reached)


# Geometry: sides, markers


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


def _approaches(post: Post, campus: CampusMap) -> Iterator[Problem]:
    for other, corridor in campus.neighbours(post.name):
        if not any(_seen_on_arrival(marker, post, corridor) for marker in post.markers):
            said = f"a robot that comes from {other.name} sees no marker of {post.name}: its camera looks to the left"
            yield error("unseen_approach", post.name, said, "Put a marker on the left of that approach.")
    if post.dock and not any(_seen_from_dock(marker, post) for marker in post.markers):
        said = f"a robot in the dock of {post.name} sees no marker, so it would wake up without knowing where"
        yield warning("unseen_dock", post.name, said, "Put a marker on the left of the docked robot.")


def _markers(post: Post, campus: CampusMap) -> Iterator[Problem]:
    arrivals = [corridor for _, corridor in campus.neighbours(post.name)]
    for number, marker in enumerate(post.markers, start=1):
        place = f"{post.name}, marker {number}"
        if not _seen_from_dock(marker, post) and not any(_seen_on_arrival(marker, post, c) for c in arrivals):
            yield error("unseen_marker", place, "no approach sees this marker", "Move or turn it, or take it away.")
        here = Point(marker.x_m, marker.y_m)
        for corridor in campus.corridors:
            if distance_to_path_m(here, corridor.tape) < CLEAR_OF_LINE_M:
                said = f"it stands where a robot drives on the corridor {corridor.name}"
                yield error("marker_in_the_way", place, said, f"Keep {CLEAR_OF_LINE_M} m from every line.")
    if len(post.name) > LONGEST_EASY_NAME:
        said = f"a name of {len(post.name)} characters makes a dense marker that is hard to read from a moving robot"
        yield warning("dense_marker", post.name, said, f"Use {LONGEST_EASY_NAME} characters at most.")


def _seen_on_arrival(marker: Marker, post: Post, corridor: Corridor) -> bool:
    return _seen(marker, post.point, corridor.heading_arriving(post.name), SEEN_ROLLING_M)


def _seen_from_dock(marker: Marker, post: Post) -> bool:
    dock = post.dock
    return dock is not None and _seen(marker, Point(dock.x_m, dock.y_m), dock.heading_rad, SEEN_STANDING_M)


def _seen(marker: Marker, at: Point, robot_heading_rad: float, reach_m: tuple[float, float]) -> bool:
    """Does the left-hand camera of a robot that is, or rolls, at this place see the printed face?"""
    ahead_m, left_m = seen_from(at, robot_heading_rad, Point(marker.x_m, marker.y_m))
    turned_rad = wrapped(marker.heading_rad - (robot_heading_rad - math.pi / 2))
    near = reach_m[0] <= ahead_m <= reach_m[1] and SEEN_LEFT_M[0] <= left_m <= SEEN_LEFT_M[1]
    return near and abs(turned_rad) <= SEEN_TURNED_RAD
