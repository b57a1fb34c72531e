"""Room for bodies: a robot that stands, waits or turns where the map has it do so must be clear of all others.

A robot that drives from a bay or a waiting point to the next one holds the crossing of the post, so it is alone there.
Everywhere else two robots may be beside each other at any time, and their circles must not touch.
"""

import math
from collections.abc import Iterator
from itertools import combinations, pairwise
from typing import Final

from maps.bays import WAITS_BEFORE_CROSSING_M
from maps.campus_map import CampusMap, Post
from maps.geometry import distance_between_paths_m, distance_m
from maps.lines import Line, lines_of
from maps.problem import Problem, error

BODY_M: Final = 0.348
"""Diameter of a robot's circle: the Create 2 with its bumper."""
MARGIN_M: Final = 0.030
"""For a body that stands beside the place that it reports."""
CLEAR_M: Final = BODY_M + MARGIN_M
"""From axle to axle."""
LEAST_ANGLE_DEG: Final = 55
"""After a turn a robot looks for its line 25° to both sides, and its outer diode meets tape 28° beside that (18 mm
beside the middle, 60 mm ahead, tape of 24 mm): another line must be farther off, with 2° for the turn itself. Where the
tape is gone it looks as far as 40°."""
SHORTEST_CORRIDOR_M: Final = 2 * WAITS_BEFORE_CROSSING_M + CLEAR_M
"""A robot that waits at one end, and one at the other end that waits too or has just left the crossing."""


def room_problems(campus: CampusMap) -> Iterator[Problem]:
    """Where bodies, spurs and corridors do not fit; nothing for a map without bays on the floor."""
    if campus.track is campus:
        return
    lines = lines_of(campus)
    for line in lines:
        yield from _too_short(campus, line)
        yield from _touches(line, lines)
    for one, other in combinations(lines, 2):
        yield from _too_near(one, other)
    for post in campus.posts.values():
        yield from _angles(post, [line for line in lines if post.name in line.posts])
        yield from _docks(post)


def _too_short(campus: CampusMap, line: Line) -> Iterator[Problem]:
    if line.bay:
        length_m = line.corridor.length_m
        if length_m < CLEAR_M:
            said = f"a robot that stands in it, {length_m:.2f} m from {line.bay.bay_of}, touches one that turns there"
            yield error("bay_too_short", line.place, said, f"Make the spur at least {CLEAR_M:.2f} m long.")
        return
    waiting = line.clear_of_crossings
    if not waiting or distance_m(waiting[0], waiting[-1]) < CLEAR_M:
        said = (
            f"a robot that waits {WAITS_BEFORE_CROSSING_M:.2f} m before one end touches one at the other end that "
            "waits too, or has just come in"
        )
        way_out = f"The two posts must be at least {SHORTEST_CORRIDOR_M:.2f} m apart."
        yield error("corridor_too_short", line.place, said, way_out)


def _touches(line: Line, lines: tuple[Line, ...]) -> Iterator[Problem]:
    """The other line of the same post that comes nearest to robots on this one, where that is too near."""
    own = line.clear_of_crossings
    if not own or (line.bay and line.corridor.length_m < CLEAR_M):
        return
    others = [other for other in lines if other is not line and other.posts & line.posts]
    gap_m, nearest = min(
        ((distance_between_paths_m(own, other.path), other) for other in others),
        key=lambda found: found[0],
        default=(math.inf, None),
    )
    if gap_m >= CLEAR_M:
        return
    is_at = f"within {gap_m:.2f} m of {nearest}; from axle to axle {CLEAR_M:.2f} m are needed"
    if line.bay:
        said = f"a robot that stands in it, or drives on into its dock, is {is_at}"
        yield error("bay_not_clear", line.place, said, "Turn one of the two away, or make the spur longer.")
    else:
        said = f"a robot that waits {WAITS_BEFORE_CROSSING_M:.2f} m before its post, or drives on, is {is_at}"
        yield error("waiting_not_clear", line.place, said, "Turn one of the two away.")


def _too_near(one: Line, other: Line) -> Iterator[Problem]:
    """Of two lines without a post in common no robot holds a crossing for both."""
    if one.posts & other.posts or one.is_far_from(other.box, CLEAR_M):
        return
    gap_m = distance_between_paths_m(one.path, other.path)
    if gap_m < CLEAR_M:
        where = "crosses" if gap_m == 0 else f"comes within {gap_m:.2f} m of"
        said = f"{other} {where} {one}, and they have no post in common at which robots would wait for each other"
        way_out = f"Keep them {CLEAR_M:.2f} m apart, or put a post there."
        yield error("lines_not_clear", other.place, said, way_out)


def _angles(post: Post, lines: list[Line]) -> Iterator[Problem]:
    if len(lines) < 2:
        return
    bearings = sorted(
        ((line.corridor.heading_leaving(post.name) % math.tau, line) for line in lines), key=lambda found: found[0]
    )
    first_rad, first = bearings[0]
    for (one_rad, one), (other_rad, other) in pairwise([*bearings, (first_rad + math.tau, first)]):
        apart_deg = math.degrees(other_rad - one_rad)
        if apart_deg < LEAST_ANGLE_DEG - 1e-6:
            said = (
                f"{one} and {other} are {apart_deg:.0f}° apart, so a robot that turns there may take one for the other"
            )
            yield error("narrow_angle", post.name, said, f"Put {LEAST_ANGLE_DEG}° between them.")


def _docks(post: Post) -> Iterator[Problem]:
    with_dock = [bay.name for bay in post.spurs if bay.dock]
    if len(with_dock) > 1:
        said = f"{' and '.join(with_dock)} have a dock, but a post can have one only"
        yield error("second_dock", post.name, said, "Make the other bays homes without a dock, or use another post.")
